use super::coordinates::Looks;
use super::document::Document;
use super::extensions::{Support, support_of};
use super::json::float;
use super::texture::Use;
use crate::scene::{AlphaMode, Finding, ImportError, Material, RawScene, SceneImage};
use gltf::json::Value;
use gltf::json::material::AlphaMode as Mode;
use gltf::json::texture::Info;
use gltf::json::validation::Checked;
use serde_json::Map;

const SPECULAR_GLOSSINESS: &str = "KHR_materials_pbrSpecularGlossiness";
/// What glTF reflects of light that falls straight on a surface that is no metal.
const DIELECTRIC: f32 = 0.04;

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
            let extensions = material.extensions.as_ref().map(|extensions| &extensions.others);
            let names = extensions.into_iter().flat_map(Map::keys);
            for name in names.filter(|name| support_of(name) != Some(Support::Read)) {
                self.note(&place, Finding::Extension(name.clone()));
            }
            let extension = |name: &str| extensions.and_then(|all| all.get(name));
            let pbr = &material.pbr_metallic_roughness;
            let info = |what, info: Option<&Info>| info.map(|info| Use::of(&place, what, info)).transpose();
            let mut base = Base {
                color: pbr.base_color_factor.0,
                texture: info("baseColorTexture", pbr.base_color_texture.as_ref())?,
                metallic: pbr.metallic_factor.0,
                roughness: pbr.roughness_factor.0,
                metallic_roughness: info(
                    "metallicRoughnessTexture",
                    pbr.metallic_roughness_texture.as_ref(),
                )?,
            };
            if let Some(json) = extension(SPECULAR_GLOSSINESS) {
                base = self.specular_glossiness(&place, base, json)?;
            }
            let emissive = info("emissiveTexture", material.emissive_texture.as_ref())?;
            let strength =
                extension("KHR_materials_emissive_strength").and_then(|own| own.get("emissiveStrength"));
            let strength = strength.map_or(Some(1.0), float).unwrap_or(1.0).max(0.0);
            let (normal, occlusion) = (&material.normal_texture, &material.occlusion_texture);
            let normal_use = normal.as_ref().map(|used| {
                let extensions = used.extensions.as_ref().map(|extensions| &extensions.others);
                Use::with(&place, "normalTexture", used.index, used.tex_coord, extensions)
            });
            let occlusion_use = occlusion.as_ref().map(|used| {
                let extensions = used.extensions.as_ref().map(|extensions| &extensions.others);
                Use::with(&place, "occlusionTexture", used.index, used.tex_coord, extensions)
            });
            let (normal_use, occlusion_use) = (normal_use.transpose()?, occlusion_use.transpose()?);
            // The first two that differ get coordinates, so the most visible ones come first.
            let further = self.further_use(&place, extensions)?;
            let uses =
                [&base.texture, &further, &normal_use, &base.metallic_roughness, &emissive, &occlusion_use];
            let looks = Looks::of(uses.into_iter().flatten().map(|used| used.source));
            self.looks.push(looks);
            let further = self.texture(&place, &looks, further.as_ref())?;
            self.further_textures.push(further);
            let mut texture = |used: &Option<Use>| self.texture(&place, &looks, used.as_ref());
            scene.materials.push(Material {
                base_color: base.color,
                base_color_texture: texture(&base.texture)?,
                metallic: base.metallic,
                roughness: base.roughness,
                metallic_roughness_texture: texture(&base.metallic_roughness)?,
                normal_texture: texture(&normal_use)?,
                normal_scale: normal.as_ref().map_or(1.0, |normal| normal.scale),
                occlusion_texture: texture(&occlusion_use)?,
                occlusion_strength: occlusion.as_ref().map_or(1.0, |occlusion| occlusion.strength.0),
                emissive: material.emissive_factor.0.map(|factor| factor * strength),
                emissive_texture: texture(&emissive)?,
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
                is_unlit: extension("KHR_materials_unlit").is_some(),
                toon: None,
                name: material.name.unwrap_or_default(),
            });
        }
        Ok(())
    }

    /// A material of colours for diffuse and specular light as one of metal and roughness. Where the file
    /// says both, it says the latter for programs as this one.
    fn specular_glossiness(&mut self, place: &str, base: Base, json: &Value) -> Result<Base, ImportError> {
        if base.is_given() {
            let text = format!("the plain material is taken, not that of {SPECULAR_GLOSSINESS}");
            self.note(place, Finding::Converted(text));
            return Ok(base);
        }
        let numbers = |key: &str, otherwise: &[f32]| -> Vec<f32> {
            let list = json.get(key).and_then(Value::as_array);
            let list: Option<Vec<f32>> = list.and_then(|list| list.iter().map(float).collect());
            list.filter(|list| list.len() == otherwise.len()).unwrap_or_else(|| otherwise.to_vec())
        };
        let texture = |key: &str| {
            let info: Option<Info> = json.get(key).and_then(|info| serde_json::from_value(info.clone()).ok());
            info
        };
        let diffuse = numbers("diffuseFactor", &[1.0; 4]);
        let diffuse = [diffuse[0], diffuse[1], diffuse[2], diffuse[3]];
        let specular = numbers("specularFactor", &[1.0; 3]);
        let glossiness = json.get("glossinessFactor").and_then(float).unwrap_or(1.0);
        let diffuse_texture =
            texture("diffuseTexture").map(|info| Use::of(place, "diffuseTexture", &info)).transpose()?;
        let text = format!("{SPECULAR_GLOSSINESS} is taken for metal and roughness that look alike");
        self.note(place, Finding::Converted(text));
        let base = Base { color: diffuse, texture: diffuse_texture, metallic: 0.0, ..base };
        if texture("specularGlossinessTexture").is_some() {
            // The texture says what is metal and what is smooth; its factors say little without it.
            let text = "specularGlossinessTexture is left out";
            self.note(place, Finding::left_out(text));
            return Ok(Base { roughness: 1.0 - 0.5 * glossiness, ..base });
        }
        let (color, metallic) = metal(diffuse, [specular[0], specular[1], specular[2]]);
        Ok(Base { color, metallic, roughness: 1.0 - glossiness, ..base })
    }
}

/// The base of a material: colour and reflection.
struct Base {
    color: [f32; 4],
    texture: Option<Use>,
    metallic: f32,
    roughness: f32,
    metallic_roughness: Option<Use>,
}

impl Base {
    /// Whether a file says anything of it.
    fn is_given(&self) -> bool {
        let is_plain =
            self.color.iter().chain([&self.metallic, &self.roughness]).all(|factor| *factor == 1.0);
        !is_plain || self.texture.is_some() || self.metallic_roughness.is_some()
    }
}

/// Base colour and metalness that reflect what these colours reflect, by the equations in the appendix of
/// `KHR_materials_pbrSpecularGlossiness`.
fn metal(diffuse: [f32; 4], specular: [f32; 3]) -> ([f32; 4], f32) {
    let strongest = specular.into_iter().fold(0.0, f32::max);
    let left = 1.0 - strongest;
    let bright = |[r, g, b]: [f32; 3]| (0.299 * r * r + 0.587 * g * g + 0.114 * b * b).sqrt();
    let [r, g, b, alpha] = diffuse;
    let (diffuse, bright_specular) = ([r, g, b], bright(specular));
    let metallic = if bright_specular < DIELECTRIC {
        0.0
    } else {
        let linear = bright(diffuse) * left / (1.0 - DIELECTRIC) + bright_specular - 2.0 * DIELECTRIC;
        let constant = DIELECTRIC - bright_specular;
        let root = (linear * linear - 4.0 * DIELECTRIC * constant).max(0.0).sqrt();
        ((root - linear) / (2.0 * DIELECTRIC)).clamp(0.0, 1.0)
    };
    let color = [0, 1, 2].map(|i| {
        let of_diffuse = diffuse[i] * left / (1.0 - DIELECTRIC) / (1.0 - metallic).max(1e-6);
        let of_specular = (specular[i] - DIELECTRIC * (1.0 - metallic)) / metallic.max(1e-6);
        let share = metallic * metallic;
        (of_diffuse + (of_specular - of_diffuse) * share).clamp(0.0, 1.0)
    });
    ([color[0], color[1], color[2], alpha], metallic)
}
