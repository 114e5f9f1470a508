//! Textures of materials: which picture, and by which texture coordinates.

use super::coordinates::{Looks, UvSource, UvTransform};
use super::document::{Document, in_range};
use super::json::{float, shortened};
use crate::scene::{Finding, ImportError, TextureRef};
use glam::Vec2;
use gltf::json::texture::{Info, Texture, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Index, Value};
use serde_json::Map;

const TRANSFORM: &str = "KHR_texture_transform";
const WEBP: &str = "EXT_texture_webp";
/// Other formats of pictures, which are taken where a texture has no picture that more programs know.
const OTHER_PICTURES: [&str; 3] = ["KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"];

/// A use of a texture in a material.
#[derive(Clone, Debug)]
pub(super) struct Use {
    what: &'static str,
    texture: Index<Texture>,
    pub(super) source: UvSource,
    /// Extensions of this use that are not read.
    unread: Vec<String>,
}

impl Use {
    pub(super) fn of(place: &str, what: &'static str, info: &Info) -> Result<Self, ImportError> {
        let extensions = info.extensions.as_ref().map(|extensions| &extensions.others);
        Self::with(place, what, info.index, info.tex_coord, extensions)
    }

    pub(super) fn with(
        place: &str,
        what: &'static str,
        texture: Index<Texture>,
        uv_set: u32,
        extensions: Option<&Map<String, Value>>,
    ) -> Result<Self, ImportError> {
        let mut source = UvSource::plain(uv_set);
        if let Some(json) = extensions.and_then(|all| all.get(TRANSFORM)) {
            let place = format!("{place}, {what}, {TRANSFORM}");
            let pair = |key: &str, otherwise: Vec2| match json.get(key) {
                None => Ok(otherwise),
                Some(value) => pair(value).ok_or_else(|| {
                    ImportError::new(format!("{place}, {key}"), "two finite numbers", shortened(value))
                }),
            };
            let rotation_rad = match json.get("rotation") {
                None => 0.0,
                Some(value) => float(value).ok_or_else(|| {
                    ImportError::new(format!("{place}, rotation"), "a finite number", shortened(value))
                })?,
            };
            let (offset, scale) = (pair("offset", Vec2::ZERO)?, pair("scale", Vec2::ONE)?);
            let transform = UvTransform { offset, rotation_rad, scale };
            source.transform = (transform != UvTransform::NONE).then_some(transform);
            let set = json.get("texCoord").and_then(Value::as_u64).and_then(|set| u32::try_from(set).ok());
            source.set = set.unwrap_or(uv_set);
        }
        let unread = extensions.into_iter().flat_map(Map::keys).filter(|name| *name != TRANSFORM);
        Ok(Self { what, texture, source, unread: unread.cloned().collect() })
    }
}

fn pair(value: &Value) -> Option<Vec2> {
    match value.as_array()?.as_slice() {
        [x, y] => Some(Vec2::new(float(x)?, float(y)?)),
        _ => None,
    }
}

impl Document<'_> {
    /// The picture of a texture and its coordinates. What is not represented gets a note.
    pub(super) fn texture(
        &mut self,
        place: &str,
        looks: &Looks,
        used: Option<&Use>,
    ) -> Result<Option<TextureRef>, ImportError> {
        let Some(used) = used else { return Ok(None) };
        let place = format!("{place}, {}", used.what);
        let image = self.image(&place, used.texture)?;
        let texture = in_range("textures", &self.root.textures, used.texture.value())?;
        let sampler = match texture.sampler {
            Some(sampler) => Some(in_range("samplers", &self.root.samplers, sampler.value())?),
            None => None,
        };
        let repeats = |mode: &Checked<WrappingMode>| *mode == Checked::Valid(WrappingMode::Repeat);
        let wraps_otherwise =
            sampler.is_some_and(|sampler| !(repeats(&sampler.wrap_s) && repeats(&sampler.wrap_t)));
        if wraps_otherwise {
            self.note(&place, Finding::converted("is repeated, not clamped or mirrored"));
        }
        for name in &used.unread {
            self.note(&place, Finding::Extension(name.clone()));
        }
        let Some(image) = image else { return Ok(None) };
        match looks.place_of(used.source) {
            Some(uvs) => Ok(Some(TextureRef { image, uvs })),
            None => {
                let text = "needs a third set of texture coordinates and is left out";
                self.note(&place, Finding::left_out(text));
                Ok(None)
            }
        }
    }

    /// As [`image_of`], with notes.
    fn image(&mut self, place: &str, texture: Index<Texture>) -> Result<Option<usize>, ImportError> {
        let texture = in_range("textures", &self.root.textures, texture.value())?;
        let image = image_of(texture);
        let unread: Vec<String> = extensions_of(texture).map(|(name, _)| name.clone()).collect();
        let is_other =
            image.is_some() && OTHER_PICTURES.into_iter().any(|name| source(texture, name) == image);
        for name in unread.into_iter().filter(|name| name != WEBP) {
            let finding = match (OTHER_PICTURES.contains(&name.as_str()), is_other) {
                (true, false) => Finding::Converted(format!("its picture without {name} is taken")),
                (true, true) => Finding::Converted(format!("its only picture is one of {name}")),
                (false, _) => Finding::Extension(name),
            };
            self.note(place, finding);
        }
        if image.is_none() {
            self.note(place, Finding::missing("has no image"));
        }
        Ok(image)
    }
}

/// The picture of a texture: WebP, which the extension wants preferred to the plain one, then the plain one,
/// then those of formats that fewer programs know.
pub(super) fn image_of(texture: &Texture) -> Option<usize> {
    // The structures' word for no image.
    let plain = Some(texture.source.value()).filter(|source| *source != u32::MAX as usize);
    let other = || OTHER_PICTURES.into_iter().find_map(|name| source(texture, name));
    source(texture, WEBP).or(plain).or_else(other)
}

fn extensions_of(texture: &Texture) -> impl Iterator<Item = (&String, &Value)> {
    texture.extensions.iter().flat_map(|extensions| extensions.others.iter())
}

fn source(texture: &Texture, extension: &str) -> Option<usize> {
    let (_, extension) = extensions_of(texture).find(|(name, _)| *name == extension)?;
    usize::try_from(extension.get("source")?.as_u64()?).ok()
}
