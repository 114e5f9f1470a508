use super::coordinates::Coordinates;
use super::note;
use crate::build::path::{beside, image, mime_of};
use crate::scene::{
    AlphaMode, Finding, Material, RawScene, Resolve, SceneImage, TextureRef, UvSet, Wrap, quoted,
};
use std::collections::HashMap;

/// Reads all materials in the file's order, with the images that they use.
pub(super) fn read(
    fbx: &ufbx::Scene,
    coordinates: &Coordinates,
    resolve: &mut Resolve<'_>,
    scene: &mut RawScene,
) {
    let mut images = Images { resolve, coordinates, of_texture: HashMap::new() };
    for material in &fbx.materials {
        let pbr = &material.pbr;
        let number = |map: &ufbx::MaterialMap, default: f32| match map.has_value {
            true => (map.value_vec4.x as f32).clamp(0.0, 1.0),
            false => default,
        };
        let color = |color: &ufbx::MaterialMap, factor: f32, default: f32| match color.has_value {
            true => [color.value_vec4.x, color.value_vec4.y, color.value_vec4.z]
                .map(|x| finite(x as f32) * factor),
            false => [default; 3],
        };
        let base_color_texture = images.of(material, &pbr.base_color, scene);
        // A texture replaces the colour of FBX, it is not multiplied.
        let [r, g, b] = match base_color_texture {
            Some(_) => [1.0; 3],
            None => color(&pbr.base_color, number(&pbr.base_factor, 1.0), 1.0),
        };
        let emissive_texture = images.of(material, &pbr.emission_color, scene);
        let emission_factor = number(&pbr.emission_factor, 1.0);
        let emissive = match emissive_texture {
            Some(_) => [emission_factor; 3],
            None => color(&pbr.emission_color, emission_factor, 0.0),
        };
        let opacity = number(&pbr.opacity, 1.0);
        // The opacity of the picture that is its colour as well is that picture's alpha.
        let opacity_file = file_of(&pbr.opacity);
        let is_alpha = opacity_file.is_some() && opacity_file == file_of(&pbr.base_color);
        if opacity_file.is_some() && !is_alpha {
            let place = format!("material {:?}", material.element.name.to_string());
            note(&mut scene.notes, place, Finding::left_out("its opacity texture is left out"));
        }
        let read = Material {
            name: material.element.name.to_string(),
            base_color: [r, g, b, opacity],
            base_color_texture,
            metallic: number(&pbr.metalness, 0.0),
            roughness: number(&pbr.roughness, 1.0),
            normal_texture: images.of(material, &pbr.normal_map, scene),
            emissive,
            emissive_texture,
            alpha_mode: if opacity < 1.0 || is_alpha { AlphaMode::Blend } else { AlphaMode::Opaque },
            // Most materials of FBX do not say it, and are seen from both sides.
            double_sided: material.features.double_sided.enabled
                || !material.features.double_sided.is_explicit,
            ..Material::default()
        };
        scene.materials.push(read);
    }
}

/// The file of a map's texture, or of the first one of a layered or computed texture.
fn file_of(map: &ufbx::MaterialMap) -> Option<String> {
    let texture = map.texture.as_ref().filter(|_| map.texture_enabled)?;
    let texture = texture.file_textures.first().unwrap_or(texture);
    Some(texture.filename.to_string())
}

fn finite(x: f32) -> f32 {
    if x.is_finite() { x } else { 0.0 }
}

/// Images read so far, by the number of their texture.
struct Images<'a, 'b> {
    resolve: &'a mut Resolve<'b>,
    coordinates: &'a Coordinates,
    of_texture: HashMap<u32, Option<usize>>,
}

impl Images<'_, '_> {
    fn of(
        &mut self,
        material: &ufbx::Material,
        map: &ufbx::MaterialMap,
        scene: &mut RawScene,
    ) -> Option<TextureRef> {
        let texture = map.texture.as_ref().filter(|_| map.texture_enabled)?;
        if let Some(name) = self.coordinates.unread(material, texture) {
            let place = format!("material {:?}", material.element.name.to_string());
            let text = format!("its texture uses the first texture coordinates, not {}", quoted(name));
            note(&mut scene.notes, place, Finding::Converted(text));
        }
        let is_second = self.coordinates.is_second(material, texture);
        let uvs = if is_second { UvSet::Second } else { UvSet::First };
        // Of a layered or computed texture, the first picture.
        let texture = texture.file_textures.first().unwrap_or(texture);
        let key = texture.element.typed_id;
        let image = match self.of_texture.get(&key) {
            Some(known) => *known,
            None => {
                let image = self.read(texture, scene);
                self.of_texture.insert(key, image);
                image
            }
        };
        let wrap = [texture.wrap_u, texture.wrap_v].map(|mode| match mode {
            ufbx::WrapMode::Repeat => Wrap::Repeat,
            ufbx::WrapMode::Clamp => Wrap::Clamp,
        });
        Some(TextureRef { image: image?, uvs, wrap })
    }

    fn read(&mut self, texture: &ufbx::Texture, scene: &mut RawScene) -> Option<usize> {
        let place = format!("texture '{}'", &*texture.element.name);
        if texture.has_uv_transform {
            let text = "its shift, turn and scale of texture coordinates are left out";
            note(&mut scene.notes, place.as_str(), Finding::left_out(text));
        }
        let names = [&texture.relative_filename, &texture.filename, &texture.absolute_filename];
        let name = names.into_iter().find(|name| !name.is_empty()).map_or("", |name| &**name);
        let video = texture.video.as_ref().map_or(&[][..], |video| &video.content);
        let content = if texture.content.is_empty() { video } else { &texture.content };
        if !content.is_empty() {
            let name = beside(name).unwrap_or_default();
            let mime = mime_of(&name).to_owned();
            scene.images.push(SceneImage { name, mime, bytes: content.to_vec() });
        } else if name.is_empty() {
            let text = "it has neither a picture nor a name, it is left out";
            note(&mut scene.notes, place, Finding::missing(text));
            return None;
        } else {
            let (image, problem) = image(name, self.resolve);
            scene.images.push(image);
            if let Some(problem) = problem {
                note(&mut scene.notes, place, Finding::Missing(problem));
            }
        }
        Some(scene.images.len() - 1)
    }
}
