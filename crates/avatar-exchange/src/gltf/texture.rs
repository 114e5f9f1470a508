//! Textures of materials: which picture, and by which texture coordinates.

use super::coordinates::{Looks, UvSource, UvTransform};
use super::document::{Document, in_range};
use super::json::{float, shortened};
use crate::scene::{Finding, ImportError, TextureRef, Wrap};
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
        let wrap = sampler.map_or([Wrap::Repeat; 2], |sampler| [&sampler.wrap_s, &sampler.wrap_t].map(wrap));
        for name in &used.unread {
            self.note(&place, Finding::Extension(name.clone()));
        }
        let Some(image) = image else { return Ok(None) };
        match looks.place_of(used.source) {
            Some(uvs) => Ok(Some(TextureRef { image, uvs, wrap })),
            None => {
                let text = "needs a third set of texture coordinates and is left out";
                self.note(&place, Finding::left_out(text));
                Ok(None)
            }
        }
    }

    /// As [`image_of`], with notes.
    fn image(&mut self, place: &str, texture: Index<Texture>) -> Result<Option<usize>, ImportError> {
        let images = self.images;
        let texture = in_range("textures", &self.root.textures, texture.value())?;
        let image = image_of(texture, images);
        let is_other =
            image.is_some() && OTHER_PICTURES.into_iter().any(|name| source(texture, name, images) == image);
        let mut findings = Vec::new();
        for (name, extension) in extensions_of(texture) {
            let is_picture = name == WEBP || OTHER_PICTURES.contains(&name.as_str());
            if is_picture && source(texture, name, images).is_none() {
                let found = extension.get("source").map_or_else(|| "none".to_owned(), shortened);
                let text = format!("{name}: expected an image below {images}, found {found}");
                findings.push(Finding::Missing(text));
            } else if is_picture && name != WEBP {
                findings.push(Finding::Converted(match is_other {
                    false => format!("its picture without {name} is taken"),
                    true => format!("its only picture is one of {name}"),
                }));
            } else if !is_picture {
                findings.push(Finding::Extension(name.clone()));
            }
        }
        findings.into_iter().for_each(|finding| self.note(place, finding));
        if image.is_none() {
            self.note(place, Finding::missing("has no image"));
        }
        Ok(image)
    }

    /// The use of a texture that a member of a material's extension says; `None` where it says none, or one
    /// that the file does not have, which whoever reads the extension tells.
    pub(super) fn further_use(
        &self,
        place: &str,
        extensions: Option<&Map<String, Value>>,
    ) -> Result<Option<Use>, ImportError> {
        let Some((extension, what)) = self.further else { return Ok(None) };
        let json = extensions.and_then(|all| all.get(extension)?.get(what));
        let index = json.and_then(|json| u32::try_from(json.get("index")?.as_u64()?).ok());
        let (Some(json), Some(index)) = (json, index.map(Index::new)) else { return Ok(None) };
        if index.value() >= self.root.textures.len() {
            return Ok(None);
        }
        let uv_set = json.get("texCoord").and_then(Value::as_f64).map_or(0, |set| set as u32);
        let extensions = json.get("extensions").and_then(Value::as_object);
        Use::with(place, what, index, uv_set, extensions).map(Some)
    }
}

/// Unknown modes are as none: repetition.
fn wrap(mode: &Checked<WrappingMode>) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
    }
}

/// The picture of a texture in a file with so many: WebP, which the extension wants preferred to the plain
/// one, then the plain one, then those of formats that fewer programs know. An extension that names none of
/// the file's pictures does not count.
pub(super) fn image_of(texture: &Texture, images: usize) -> Option<usize> {
    // The structures' word for no image.
    let plain = Some(texture.source.value()).filter(|source| *source != u32::MAX as usize);
    let other = || OTHER_PICTURES.into_iter().find_map(|name| source(texture, name, images));
    source(texture, WEBP, images).or(plain).or_else(other)
}

fn extensions_of(texture: &Texture) -> impl Iterator<Item = (&String, &Value)> {
    texture.extensions.iter().flat_map(|extensions| extensions.others.iter())
}

fn source(texture: &Texture, extension: &str, images: usize) -> Option<usize> {
    let (_, extension) = extensions_of(texture).find(|(name, _)| *name == extension)?;
    let source = usize::try_from(extension.get("source")?.as_u64()?).ok()?;
    (source < images).then_some(source)
}
