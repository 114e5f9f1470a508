//! Materials, and which texture coordinates of a mesh their textures use.

use super::Reader;
use super::geometry::Primitive;
use super::xml::At;
use crate::build::path;
use crate::scene::{AlphaMode, Finding, Material, Resolve, TextureRef, UvSet, Wrap, quoted};
use percent_encoding::percent_decode_str;
use std::collections::HashMap;

/// A texture of a material.
type Slot = fn(&mut Material) -> &mut Option<TextureRef>;

/// What a material says beside what [`Material`] holds: by which names its textures ask for texture
/// coordinates.
#[derive(Debug, Default)]
pub(super) struct Names {
    of_slots: Vec<(Slot, String)>,
    /// Whether a part has this material, whose sets are the ones of its textures.
    is_settled: bool,
}

/// What materials have and surfaces here have no term for. It is told once, with the number of materials.
const LEFT_OUT: [&str; 6] =
    ["ambient", "specular", "reflective", "reflectivity", "index_of_refraction", "shininess"];

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
            self.texcoords.push(Names::default());
            let effect = at.child("instance_effect").map(|instance| instance.target("url"));
            match effect {
                Some(Ok(effect)) => self.effect(effect, &mut material, &mut images, resolve),
                Some(Err(error)) => self.note(at, Finding::Missing(error.to_string())),
                None => self.note(at, Finding::missing("a material without effect")),
            }
            self.scene.materials.push(material);
        }
        for (name, (count, at)) in std::mem::take(&mut self.terms) {
            let at = self.tree.at(at);
            let text = format!("<{name}> of {count} materials is left out: surfaces here have no such term");
            self.note(at, Finding::LeftOut(text));
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
        if let Some(emission) = model.child("emission") {
            match (color(emission), emission.child("texture")) {
                (Some([r, g, b, _]), _) => material.emissive = [r, g, b],
                (None, Some(texture)) => {
                    material.emissive_texture = self.texture(profile, texture, images, resolve);
                    material.emissive = [if material.emissive_texture.is_some() { 1.0 } else { 0.0 }; 3];
                    self.names(texture, |material| &mut material.emissive_texture);
                }
                (None, None) => {}
            }
        }
        // A constant surface has nothing but what it gives off.
        if let Some(diffuse) = model.child("diffuse") {
            match (color(diffuse), diffuse.child("texture")) {
                (Some(color), _) => material.base_color = color,
                (None, Some(texture)) => {
                    material.base_color_texture = self.texture(profile, texture, images, resolve);
                    self.names(texture, |material| &mut material.base_color_texture);
                }
                (None, None) => self.note(diffuse, Finding::missing("neither a colour nor a texture")),
            }
        }
        material.base_color[3] = opacity(model);
        if material.base_color[3] < 1.0 {
            material.alpha_mode = AlphaMode::Blend;
        }
        if let Some((transparent, texture)) = model.child("transparent").and_then(with_texture) {
            let before = self.scene.images.len();
            let image = self.texture(profile, texture, images, resolve).map(|texture| texture.image);
            let of_color = material.base_color_texture.map(|texture| texture.image);
            let mode = transparent.attribute("opaque").unwrap_or("A_ONE");
            // The opacity of the picture that is its colour as well is that picture's alpha.
            if image.is_some() && image == of_color && mode == "A_ONE" {
                material.alpha_mode = AlphaMode::Blend;
            } else if image.is_some() {
                self.note(transparent, Finding::left_out("its opacity texture is left out"));
                // Nothing else has shown it so far.
                self.scene.images.truncate(before);
                images.retain(|_, image| *image < before);
            }
        }
        self.bump([model, technique.unwrap_or(model), profile, at], profile, material, images, resolve);
        for term in model.children() {
            if let Some(name) = LEFT_OUT.iter().find(|name| **name == term.name() && !says_nothing(term)) {
                self.terms.entry(name).or_insert((0, term.number)).0 += 1;
            }
        }
    }

    /// The normal map, which the format has no element for: exporters for Max and Maya write `<bump>` in an
    /// `<extra>` of one of these elements. It is a map of normals where it says so, else one of heights.
    fn bump(
        &mut self,
        places: [At<'a>; 4],
        profile: At<'a>,
        material: &mut Material,
        images: &mut HashMap<usize, usize>,
        resolve: &mut Resolve<'_>,
    ) {
        let extras = places.into_iter().flat_map(|at| at.all("extra"));
        let Some(bump) =
            extras.flat_map(|extra| extra.all("technique")).find_map(|technique| technique.child("bump"))
        else {
            return;
        };
        let Some((_, texture)) = with_texture(bump) else { return };
        if bump.attribute("bumptype") == Some("NORMALMAP") {
            material.normal_texture = self.texture(profile, texture, images, resolve);
            self.names(texture, |material| &mut material.normal_texture);
        } else {
            self.note(bump, Finding::left_out("its map of heights is left out"));
        }
    }

    /// Keeps by which name a texture of the last material asks for texture coordinates.
    fn names(&mut self, texture: At<'a>, slot: Slot) {
        let name = texture.attribute("texcoord").unwrap_or("").to_owned();
        self.texcoords.last_mut().into_iter().for_each(|names| names.of_slots.push((slot, name.clone())));
    }

    /// Gives the textures of a material the sets that an `<instance_material>` binds them to. A material says
    /// it once for all of its parts: where they differ, the first part counts.
    pub(super) fn bind(&mut self, at: At<'a>, material: usize, primitive: &Primitive) {
        let Some(mut names) = self.texcoords.get_mut(material).map(std::mem::take) else { return };
        for (slot, name) in &names.of_slots {
            let mut inputs = at.all("bind_vertex_input");
            let bound = inputs.find(|input| input.attribute("semantic") == Some(name));
            // Without a binding, the first set.
            let set = bound.map(|input| input.attribute("input_set").map_or(Ok(0), str::parse).unwrap_or(0));
            let place = set.map_or(Some(0), |set| primitive.uv_sets.iter().position(|known| *known == set));
            let uvs = if place == Some(1) { UvSet::Second } else { UvSet::First };
            let Some(texture) = self.scene.materials.get_mut(material).and_then(|it| slot(it).as_mut())
            else {
                continue;
            };
            if !names.is_settled {
                texture.uvs = uvs;
            }
            let is_other = texture.uvs != uvs || (place.is_none() && !primitive.uv_sets.is_empty());
            if is_other {
                let taken = if texture.uvs == UvSet::First { "first" } else { "second" };
                let name = quoted(name);
                let text =
                    format!("texture coordinates {name} of its material are taken from the {taken} set");
                self.note(at, Finding::Converted(text));
            }
        }
        names.is_settled = true;
        self.texcoords.get_mut(material).into_iter().for_each(|place| *place = std::mem::take(&mut names));
    }

    /// The image of a `<texture>`: through a sampler and a surface in 1.4, a sampler in 1.5, or directly,
    /// which some exporters write.
    fn texture(
        &mut self,
        profile: At<'a>,
        at: At<'a>,
        images: &mut HashMap<usize, usize>,
        resolve: &mut Resolve<'_>,
    ) -> Option<TextureRef> {
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
        let wrap = ["wrap_s", "wrap_t"].map(|name| self.wrap(sampler, name));
        if let Some(known) = images.get(&image.number) {
            return Some(TextureRef { wrap, ..TextureRef::from(*known) });
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
        Some(TextureRef { wrap, ..TextureRef::from(self.scene.images.len() - 1) })
    }

    /// What a sampler shows beyond an edge: COLLADA 1.4.1, chapter 8, `wrap_s`; 1.5 adds MIRROR_ONCE. Where
    /// it says nothing, WRAP.
    fn wrap(&mut self, sampler: Option<At<'a>>, name: &str) -> Wrap {
        let Some(at) = sampler.and_then(|sampler| sampler.child(name)) else { return Wrap::Repeat };
        let (nearest, taken) = match at.text() {
            "WRAP" => return Wrap::Repeat,
            "MIRROR" => return Wrap::Mirror,
            "CLAMP" => return Wrap::Clamp,
            // A border has a colour of its own, NONE is black beyond the edge.
            "BORDER" | "NONE" | "MIRROR_ONCE" => (Wrap::Clamp, "CLAMP"),
            _ => (Wrap::Repeat, "WRAP"),
        };
        self.note(at, Finding::Converted(format!("{} is taken as {taken}", quoted(at.text()))));
        nearest
    }
}

/// An element and the texture in it.
fn with_texture(at: At<'_>) -> Option<(At<'_>, At<'_>)> {
    Some((at, at.child("texture")?))
}

/// Whether a term of a surface is as if it were not there: black, without reflection or without refraction.
fn says_nothing(at: At<'_>) -> bool {
    let number = at.child("float").and_then(|at| at.text().parse::<f32>().ok());
    match at.name() {
        "index_of_refraction" => number.is_none_or(|number| number == 1.0 || number == 0.0),
        "reflectivity" | "shininess" => number.is_none_or(|number| number == 0.0),
        _ => at.child("texture").is_none() && color(at).is_none_or(|[r, g, b, _]| [r, g, b] == [0.0; 3]),
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
