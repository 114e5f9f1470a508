use super::document::{Document, in_range};
use crate::scene::{AlphaMode, Finding, ImportError, Material, RawScene, SceneImage, TextureRef};
use gltf::json::material::AlphaMode as Mode;
use gltf::json::texture::{Info, Texture, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Index, Value};
use serde_json::Map;

/// Where a texture is used, and what its use says beside the texture itself.
struct Use<'u> {
    what: &'static str,
    texture: Index<Texture>,
    uv_set: u32,
    extensions: Option<&'u Map<String, Value>>,
}

impl<'u> Use<'u> {
    fn of(what: &'static str, info: &'u Info) -> Self {
        let extensions = info.extensions.as_ref().map(|extensions| &extensions.others);
        Self { what, texture: info.index, uv_set: info.tex_coord, extensions }
    }
}

impl Document<'_> {
    /// Encoded pictures. One that is not found is empty, with a note: a face without a texture is still a
    /// face.
    pub(super) fn read_images(&mut self, scene: &mut RawScene) -> Result<(), ImportError> {
        for (number, image) in std::mem::take(&mut self.root.images).into_iter().enumerate() {
            let place = format!("image {number}");
            let mut mime = image.mime_type.map(|mime| mime.0).unwrap_or_default();
            let bytes = match (&image.uri, image.buffer_view) {
                (Some(uri), _) => match self.file(&place, uri) {
                    Ok((bytes, data_mime)) => {
                        mime = if mime.is_empty() { data_mime } else { mime };
                        bytes
                    }
                    Err(error) => {
                        let text = format!("expected {}, found {}", error.expected, error.found);
                        self.note(&place, Finding::Missing(text));
                        Vec::new()
                    }
                },
                (None, Some(view)) => {
                    let length = self.view(view)?.bytes.len();
                    self.budget.take(length, 1).map_err(|exceeded| exceeded.at(&place))?;
                    self.view(view)?.bytes.to_vec()
                }
                (None, None) => {
                    self.note(&place, Finding::missing("has neither an address nor a bufferView"));
                    Vec::new()
                }
            };
            let uri = image.uri.filter(|uri| !uri.get(..5).is_some_and(|s| s.eq_ignore_ascii_case("data:")));
            let name = image.name.or(uri).unwrap_or_default();
            scene.images.push(SceneImage { name, mime, bytes });
        }
        Ok(())
    }

    pub(super) fn read_materials(&mut self, scene: &mut RawScene) -> Result<(), ImportError> {
        for (number, material) in std::mem::take(&mut self.root.materials).into_iter().enumerate() {
            let place = format!("material {number}");
            for name in material.extensions.iter().flat_map(|extensions| extensions.others.keys()) {
                self.note(&place, Finding::Extension(name.clone()));
            }
            let pbr = &material.pbr_metallic_roughness;
            let (normal, occlusion) = (&material.normal_texture, &material.occlusion_texture);
            let mut texture = |used: Option<Use<'_>>| self.texture(&place, used);
            scene.materials.push(Material {
                base_color: pbr.base_color_factor.0,
                base_color_texture: texture(
                    pbr.base_color_texture.as_ref().map(|used| Use::of("baseColorTexture", used)),
                )?,
                metallic: pbr.metallic_factor.0,
                roughness: pbr.roughness_factor.0,
                metallic_roughness_texture: texture(
                    pbr.metallic_roughness_texture
                        .as_ref()
                        .map(|used| Use::of("metallicRoughnessTexture", used)),
                )?,
                normal_texture: texture(normal.as_ref().map(|used| {
                    let extensions = used.extensions.as_ref().map(|extensions| &extensions.others);
                    Use { what: "normalTexture", texture: used.index, uv_set: used.tex_coord, extensions }
                }))?,
                normal_scale: normal.as_ref().map_or(1.0, |normal| normal.scale),
                occlusion_texture: texture(occlusion.as_ref().map(|used| {
                    let extensions = used.extensions.as_ref().map(|extensions| &extensions.others);
                    Use { what: "occlusionTexture", texture: used.index, uv_set: used.tex_coord, extensions }
                }))?,
                occlusion_strength: occlusion.as_ref().map_or(1.0, |occlusion| occlusion.strength.0),
                emissive: material.emissive_factor.0,
                emissive_texture: texture(
                    material.emissive_texture.as_ref().map(|used| Use::of("emissiveTexture", used)),
                )?,
                alpha_mode: match material.alpha_mode {
                    Checked::Valid(Mode::Opaque) => AlphaMode::Opaque,
                    Checked::Valid(Mode::Mask) => AlphaMode::Mask,
                    Checked::Valid(Mode::Blend) => AlphaMode::Blend,
                    Checked::Invalid => {
                        return Err(ImportError::new(
                            place,
                            "alphaMode OPAQUE, MASK or BLEND",
                            "another one",
                        ));
                    }
                },
                alpha_cutoff: material.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0),
                double_sided: material.double_sided,
                is_unlit: false,
                toon: None,
                name: material.name.unwrap_or_default(),
            });
        }
        Ok(())
    }

    /// The image of a texture. Wrapping modes, further texture coordinates and extensions get a note.
    fn texture(&mut self, place: &str, used: Option<Use<'_>>) -> Result<Option<TextureRef>, ImportError> {
        let Some(used) = used else { return Ok(None) };
        let place = format!("{place}, {}", used.what);
        let texture = in_range("textures", &self.root.textures, used.texture.value())?;
        let image = image_of(texture);
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
        if used.uv_set != 0 {
            let text = format!("TEXCOORD_{} is not represented", used.uv_set);
            self.note(&place, Finding::LeftOut(text));
        }
        for name in used.extensions.into_iter().flat_map(Map::keys) {
            self.note(&place, Finding::Extension(name.clone()));
        }
        if image.is_none() {
            self.note(&place, Finding::missing("has no image"));
        }
        Ok(image.map(TextureRef::from))
    }
}

/// The image of a texture.
pub(super) fn image_of(texture: &Texture) -> Option<usize> {
    // The structures' word for no image.
    Some(texture.source.value()).filter(|source| *source != u32::MAX as usize)
}
