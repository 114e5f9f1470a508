use super::Reader;
use super::xml::At;
use crate::build::path;
use crate::scene::{AlphaMode, Finding, Material, Resolve, TextureRef};
use percent_encoding::percent_decode_str;
use std::collections::HashMap;

impl<'a> Reader<'a> {
    /// Reads the materials of the library. Returns their numbers by element. What is odd about a material is
    /// noted, since a picture without it is better than none.
    pub(super) fn read_materials(&mut self, resolve: &mut Resolve<'_>) -> HashMap<usize, usize> {
        let mut numbers = HashMap::new();
        let mut images = HashMap::new();
        for at in self.tree.root().all("library_materials").flat_map(|library| library.all("material")) {
            numbers.insert(at.number, self.scene.materials.len());
            let mut material = Material {
                name: at.label().to_owned(),
                metallic: 0.0,
                double_sided: true,
                ..Material::default()
            };
            let effect = at.child("instance_effect").map(|instance| instance.target("url"));
            match effect {
                Some(Ok(effect)) => self.effect(effect, &mut material, &mut images, resolve),
                Some(Err(error)) => self.note(at, Finding::Missing(error.to_string())),
                None => self.note(at, Finding::missing("a material without effect")),
            }
            self.scene.materials.push(material);
        }
        numbers
    }

    fn effect(
        &mut self,
        at: At<'a>,
        material: &mut Material,
        images: &mut HashMap<usize, usize>,
        resolve: &mut Resolve<'_>,
    ) {
        let Some(profile) = at.child("profile_COMMON") else {
            return self.note(at, Finding::left_out("only profile_COMMON is read"));
        };
        let models = ["phong", "lambert", "blinn", "constant"];
        let technique = profile.child("technique");
        let model =
            technique.and_then(|technique| technique.children().find(|at| models.contains(&at.name())));
        let Some(model) = model else {
            let text = "a technique without phong, lambert, blinn or constant";
            return self.note(profile, Finding::left_out(text));
        };
        if let Some(emission) = model.child("emission").and_then(color) {
            material.emissive = [emission[0], emission[1], emission[2]];
        }
        // A constant surface has nothing but what it gives off.
        if let Some(diffuse) = model.child("diffuse") {
            match (color(diffuse), diffuse.child("texture")) {
                (Some(color), _) => material.base_color = color,
                (None, Some(texture)) => {
                    let image = self.texture(profile, texture, images, resolve);
                    material.base_color_texture = image.map(TextureRef::from);
                }
                (None, None) => self.note(diffuse, Finding::missing("neither a colour nor a texture")),
            }
        }
        material.base_color[3] = opacity(model);
        if material.base_color[3] < 1.0 {
            material.alpha_mode = AlphaMode::Blend;
        }
    }

    /// The image of a `<texture>`: through a sampler and a surface in 1.4, a sampler in 1.5, or directly,
    /// which some exporters write.
    fn texture(
        &mut self,
        profile: At<'a>,
        at: At<'a>,
        images: &mut HashMap<usize, usize>,
        resolve: &mut Resolve<'_>,
    ) -> Option<usize> {
        let name = at.attribute("texture").unwrap_or("");
        let parameter = |sid: &str| profile.all("newparam").find(|at| at.attribute("sid") == Some(sid));
        let sampler = parameter(name).and_then(|at| at.child("sampler2D"));
        let surface = sampler.and_then(|sampler| parameter(sampler.child("source")?.text()));
        let of_surface = surface.and_then(|at| at.path(&["surface", "init_from"])).map(|at| at.text());
        let of_sampler =
            sampler.and_then(|at| at.child("instance_image")?.target("url").ok()?.attribute("id"));
        let image = self.tree.by_id(of_surface.or(of_sampler).unwrap_or(name));
        let Some(image) = image.filter(|image| image.name() == "image") else {
            self.note(at, Finding::Missing(format!("the texture '{name}' leads to no image")));
            return None;
        };
        if let Some(known) = images.get(&image.number) {
            return Some(*known);
        }
        let address =
            image.path(&["init_from", "ref"]).or(image.child("init_from")).map_or("", |at| at.text());
        // A % that is not followed by two hexadecimal digits stays as it is.
        let (read, problem) = path::image(&percent_decode_str(address).decode_utf8_lossy(), resolve);
        self.scene.images.push(read);
        if let Some(problem) = problem {
            self.note(image, Finding::Missing(problem));
        }
        images.insert(image.number, self.scene.images.len() - 1);
        Some(self.scene.images.len() - 1)
    }
}

fn color(at: At<'_>) -> Option<[f32; 4]> {
    let numbers: Vec<f32> = at.child("color")?.numbers().ok()?;
    let &[r, g, b, ref rest @ ..] = &numbers[..] else { return None };
    let color = [r, g, b, rest.first().copied().unwrap_or(1.0)];
    color.iter().all(|x| x.is_finite()).then_some(color)
}

/// By `transparent` and `transparency`, COLLADA 1.4.1, chapter 7. A result of 0 is taken for 1: exporters
/// that mixed up the two directions are common, invisible surfaces are not.
fn opacity(model: At<'_>) -> f32 {
    let transparency =
        model.path(&["transparency", "float"]).and_then(|at| at.text().parse().ok()).unwrap_or(1.0);
    let transparent = model.child("transparent");
    let [r, g, b, a] = transparent.and_then(color).unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let luminance = 0.212_671 * r + 0.715_16 * g + 0.072_169 * b;
    let opacity: f32 = match transparent.and_then(|at| at.attribute("opaque")) {
        Some("RGB_ZERO") => 1.0 - luminance * transparency,
        Some("RGB_ONE") => luminance * transparency,
        Some("A_ZERO") => 1.0 - a * transparency,
        _ => a * transparency,
    };
    if opacity > 0.0 && opacity < 1.0 { opacity } else { 1.0 }
}
