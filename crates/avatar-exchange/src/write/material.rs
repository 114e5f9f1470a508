use super::buffer::Buffer;
use crate::scene::{AlphaMode, Material, Scene, SceneImage, TextureRef, UvSet, Wrap};
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet};

const UNLIT: &str = "KHR_materials_unlit";
const EMISSIVE_STRENGTH: &str = "KHR_materials_emissive_strength";

/// The images that the file has, those with bytes, and the ways in which textures wrap.
#[derive(Debug)]
pub(super) struct Images {
    /// Per image of the scene its position in the file.
    places: Vec<Option<usize>>,
    /// Pairs that samplers say; repetition needs none.
    wraps: Vec<[Wrap; 2]>,
    /// Positions of images in the file and of their samplers, which textures have that come after those that
    /// repeat, with the positions of these textures.
    wrapped: BTreeMap<(usize, usize), usize>,
}

impl Images {
    pub(super) fn of(scene: &Scene) -> Self {
        let mut count = 0;
        let place = |image: &SceneImage| {
            let has_bytes = !image.bytes.is_empty();
            count += usize::from(has_bytes);
            has_bytes.then(|| count - 1)
        };
        let places: Vec<Option<usize>> = scene.images.iter().map(place).collect();
        let (mut wraps, mut wrapped) = (Vec::new(), BTreeMap::new());
        for texture in scene.materials.iter().flat_map(Material::textures) {
            let place = places.get(texture.image).copied().flatten();
            let Some(place) = place.filter(|_| texture.wrap != [Wrap::Repeat; 2]) else { continue };
            let sampler = wraps.iter().position(|wrap| *wrap == texture.wrap).unwrap_or_else(|| {
                wraps.push(texture.wrap);
                wraps.len() - 1
            });
            let next = count + wrapped.len();
            wrapped.entry((place, sampler)).or_insert(next);
        }
        Self { places, wraps, wrapped }
    }

    pub(super) fn samplers(&self) -> Vec<Value> {
        let code = |wrap: Wrap| match wrap {
            Wrap::Repeat => 10497,
            Wrap::Clamp => 33071,
            Wrap::Mirror => 33648,
        };
        self.wraps.iter().map(|[s, t]| json!({ "wrapS": code(*s), "wrapT": code(*t) })).collect()
    }

    /// One texture for each image, which repeats, then those that do not. Other pictures than PNG and JPEG
    /// are those of an extension.
    pub(super) fn textures(&self, scene: &Scene) -> Vec<Value> {
        let with_bytes = scene.images.iter().filter(|image| !image.bytes.is_empty()).enumerate();
        let mut textures: Vec<Value> = with_bytes
            .map(|(place, image)| match extension_of(image) {
                Some(name) => json!({ "extensions": { name: { "source": place } } }),
                None => json!({ "source": place }),
            })
            .collect();
        let mut wrapped: Vec<_> = self.wrapped.iter().collect();
        wrapped.sort_by_key(|(_, position)| **position);
        for ((place, sampler), _) in wrapped {
            let mut texture = textures.get(*place).cloned().unwrap_or_default();
            texture["sampler"] = json!(sampler);
            textures.push(texture);
        }
        textures
    }

    /// Adds the extensions that textures need: a program that does not know them has no picture.
    pub(super) fn extensions(&self, scene: &Scene, required: &mut BTreeSet<&'static str>) {
        let with_bytes = scene.images.iter().filter(|image| !image.bytes.is_empty());
        required.extend(with_bytes.filter_map(extension_of));
    }

    pub(super) fn images(&self, scene: &Scene, buffer: &mut Buffer) -> Vec<Value> {
        let with_bytes = scene.images.iter().filter(|image| !image.bytes.is_empty());
        with_bytes
            .map(|image| {
                let mut json = super::named(&image.name);
                json.insert("mimeType".to_owned(), json!(media_type(image)));
                let view = buffer.view(image.bytes.iter().copied(), None);
                json.insert("bufferView".to_owned(), json!(view));
                Value::Object(json)
            })
            .collect()
    }

    fn texture(&self, texture: Option<TextureRef>) -> Option<Map<String, Value>> {
        let texture = texture?;
        let place = self.places.get(texture.image).copied().flatten()?;
        let sampler = self.wraps.iter().position(|wrap| *wrap == texture.wrap);
        let wrapped = sampler.and_then(|sampler| self.wrapped.get(&(place, sampler)).copied());
        let mut json = Map::from_iter([("index".to_owned(), json!(wrapped.unwrap_or(place)))]);
        if texture.uvs == UvSet::Second {
            json.insert("texCoord".to_owned(), json!(1));
        }
        Some(json)
    }
}

/// The extension that gives textures pictures of this kind.
fn extension_of(image: &SceneImage) -> Option<&'static str> {
    match media_type(image) {
        "image/webp" => Some("EXT_texture_webp"),
        "image/ktx2" => Some("KHR_texture_basisu"),
        "image/avif" => Some("EXT_texture_avif"),
        _ => None,
    }
}

/// Adds the extensions that materials use; programs that do not know them show something similar.
pub(super) fn extensions(scene: &Scene, used: &mut BTreeSet<&'static str>) {
    let any = |what: fn(&Material) -> bool| scene.materials.iter().any(what);
    used.extend(any(|material| material.is_unlit).then_some(UNLIT));
    used.extend(any(|material| strength(material) > 1.0).then_some(EMISSIVE_STRENGTH));
}

/// The largest factor of a material's own light, 1 at least.
fn strength(material: &Material) -> f32 {
    material.emissive.into_iter().filter(|factor| factor.is_finite()).fold(1.0, f32::max)
}

/// By the first bytes, or else as stated.
fn media_type(image: &SceneImage) -> &str {
    let begins = |start: &[u8]| image.bytes.starts_with(start);
    if begins(b"\x89PNG\r\n\x1a\n") {
        "image/png"
    } else if begins(b"\xff\xd8\xff") {
        "image/jpeg"
    } else if begins(b"RIFF") && image.bytes.get(8..12) == Some(b"WEBP") {
        "image/webp"
    } else if begins(b"\xabKTX 20\xbb") {
        "image/ktx2"
    } else if image.mime.is_empty() {
        "application/octet-stream"
    } else {
        &image.mime
    }
}

pub(super) fn materials(scene: &Scene, images: &Images) -> Vec<Value> {
    scene.materials.iter().map(|material| one(material, images)).collect()
}

/// A number clamped to a range; NaN becomes the default.
fn within(value: f32, least: f32, most: f32, default: f32) -> f32 {
    if value.is_nan() { default } else { value.clamp(least, most) }
}

fn one(material: &Material, images: &Images) -> Value {
    let default = Material::default();
    let factor = |value: f32| Value::from(f64::from(within(value, 0.0, 1.0, 1.0)));
    let is = |a: f32, b: f32| a.to_bits() == b.to_bits();
    let mut pbr = Map::new();
    if material.base_color.iter().any(|x| !is(*x, 1.0)) {
        pbr.insert("baseColorFactor".to_owned(), material.base_color.iter().map(|x| factor(*x)).collect());
    }
    if let Some(texture) = images.texture(material.base_color_texture) {
        pbr.insert("baseColorTexture".to_owned(), texture.into());
    }
    if !is(material.metallic, 1.0) {
        pbr.insert("metallicFactor".to_owned(), factor(material.metallic));
    }
    if !is(material.roughness, 1.0) {
        pbr.insert("roughnessFactor".to_owned(), factor(material.roughness));
    }
    if let Some(texture) = images.texture(material.metallic_roughness_texture) {
        pbr.insert("metallicRoughnessTexture".to_owned(), texture.into());
    }
    let mut json = super::named(&material.name);
    if !pbr.is_empty() {
        json.insert("pbrMetallicRoughness".to_owned(), pbr.into());
    }
    if let Some(mut texture) = images.texture(material.normal_texture) {
        if !is(material.normal_scale, 1.0) {
            let scale = if material.normal_scale.is_finite() { material.normal_scale } else { 1.0 };
            texture.insert("scale".to_owned(), Value::from(f64::from(scale)));
        }
        json.insert("normalTexture".to_owned(), texture.into());
    }
    if let Some(mut texture) = images.texture(material.occlusion_texture) {
        if !is(material.occlusion_strength, 1.0) {
            texture.insert("strength".to_owned(), factor(material.occlusion_strength));
        }
        json.insert("occlusionTexture".to_owned(), texture.into());
    }
    if let Some(texture) = images.texture(material.emissive_texture) {
        json.insert("emissiveTexture".to_owned(), texture.into());
    }
    if material.emissive.iter().any(|x| !is(*x, 0.0)) {
        let strength = strength(material);
        let emissive = material.emissive.iter().map(|x| f64::from(within(*x / strength, 0.0, 1.0, 0.0)));
        json.insert("emissiveFactor".to_owned(), emissive.map(Value::from).collect());
    }
    let has_cutoff = !is(material.alpha_cutoff, default.alpha_cutoff);
    let mode = match material.alpha_mode {
        AlphaMode::Opaque => "OPAQUE",
        AlphaMode::Mask => "MASK",
        AlphaMode::Blend => "BLEND",
    };
    if has_cutoff || material.alpha_mode != AlphaMode::Opaque {
        json.insert("alphaMode".to_owned(), json!(mode));
    }
    if has_cutoff {
        let cutoff = within(material.alpha_cutoff, 0.0, f32::MAX, default.alpha_cutoff);
        json.insert("alphaCutoff".to_owned(), Value::from(f64::from(cutoff)));
    }
    if material.double_sided {
        json.insert("doubleSided".to_owned(), json!(true));
    }
    let mut extensions = Map::new();
    if material.is_unlit {
        extensions.insert(UNLIT.to_owned(), json!({}));
    }
    if strength(material) > 1.0 {
        let strength = json!({ "emissiveStrength": f64::from(strength(material)) });
        extensions.insert(EMISSIVE_STRENGTH.to_owned(), strength);
    }
    if !extensions.is_empty() {
        json.insert("extensions".to_owned(), extensions.into());
    }
    Value::Object(json)
}
