//! What a part's material says, as the renderer takes it, and the pictures for it.

use super::ImportReport;
use crate::Textures;
use crate::pictures::Pictures;
use crate::textures::OwnImages;
use avatar_exchange::{AlphaMode, Scene, ScenePart, TextureRef, UvSet};
use avatar_look::{Alpha, Cartoon, Lighting, Material, SOLID, SecondUvs, Standard, Wrap, Wraps};
use avatar_mesh::PartKind;

/// The pictures of a scene, and which of them each part is drawn with.
pub(super) struct Looks {
    pictures: Pictures,
    own: OwnImages,
    fallback: avatar_exchange::Material,
}

impl Looks {
    /// Decodes what the parts of the scene use, each picture once.
    pub(super) fn of(scene: &Scene) -> Self {
        let materials = scene.parts.iter().filter_map(|part| scene.materials.get(part.material?));
        let pictures = Pictures::decoded(scene, materials.flat_map(|material| material.textures()));
        // Not white, on which bright light would show no relief.
        let fallback = avatar_exchange::Material {
            metallic: 0.0,
            base_color: [0.6, 0.6, 0.6, 1.0],
            double_sided: true,
            ..Default::default()
        };
        Self { pictures, own: OwnImages::default(), fallback }
    }

    /// How a part is drawn, and its looks; notes its pictures.
    pub(super) fn take(
        &mut self,
        scene: &Scene,
        part: &ScenePart,
        name: &str,
        report: &mut ImportReport,
    ) -> (PartKind, Material) {
        let from = part.material.and_then(|material| scene.materials.get(material)).unwrap_or(&self.fallback);
        let alpha = self.alpha(from, part);
        let kind = kind_of(from, part, name, alpha);
        let is_cartoon = from.toon.is_some();
        let shade = from.toon.as_ref().and_then(|toon| toon.shade_texture);
        let is_surface = kind == PartKind::Surface;
        // What an eye shows through its cornea is painted on the ball.
        self.own.color.push(self.pictures.used(from.base_color_texture));
        self.own.normal.push(self.pictures.used(from.normal_texture));
        self.own.occlusion.push(self.pictures.used(from.occlusion_texture));
        let of_surface =
            |texture: Option<TextureRef>, is_read: bool| texture.filter(|_| is_surface && is_read);
        let rough = of_surface(from.metallic_roughness_texture, !is_cartoon);
        self.own.metallic_roughness.push(self.pictures.used(rough));
        self.own.emissive.push(self.pictures.used(of_surface(from.emissive_texture, true)));
        self.own.shade.push(self.pictures.used(of_surface(shade, true)));
        self.own.wraps.push(wraps(from));
        if !is_surface && from.metallic_roughness_texture.is_some() {
            report
                .notes
                .push(format!("part {name:?}: it is drawn with the roughness of skin, not with its own"));
        }
        (kind, material(from, kind, alpha))
    }

    /// The pictures, and what is wrong with them.
    pub(super) fn into_textures(self) -> Textures {
        let (images, warnings) = self.pictures.into_parts();
        Textures::of_own(OwnImages { images, ..self.own }, warnings)
    }

    /// What the opacity means here: where a surface is opaque all over, its holes and its blending show
    /// nothing, and it need not be sorted.
    fn alpha(&self, from: &avatar_exchange::Material, part: &ScenePart) -> Alpha {
        let of_vertices = part.mesh.colors.iter().map(|color| color.w).fold(1.0, f32::min);
        let of_texture = self.pictures.least_alpha(from.base_color_texture);
        let least = from.base_color[3] * of_vertices * of_texture;
        match from.alpha_mode {
            AlphaMode::Opaque => Alpha::Opaque,
            AlphaMode::Mask if least >= from.alpha_cutoff => Alpha::Opaque,
            AlphaMode::Mask => Alpha::Mask(from.alpha_cutoff),
            AlphaMode::Blend if least >= SOLID => Alpha::Opaque,
            AlphaMode::Blend => Alpha::Blend,
        }
    }
}

/// How a part is drawn, guessed from the names of part, node and material.
fn kind_of(from: &avatar_exchange::Material, part: &ScenePart, name: &str, alpha: Alpha) -> PartKind {
    let texts = [name, &from.name].map(str::to_lowercase);
    let says = |words: &[&str]| texts.iter().any(|text| words.iter().any(|word| text.contains(word)));
    let is_drawn = from.toon.is_some() || from.is_unlit;
    if says(&["cornea", "eyewet", "eye_wet", "eyetransp"]) && from.alpha_mode == AlphaMode::Blend && !is_drawn
    {
        return PartKind::Cornea;
    }
    let other =
        ["hair", "lash", "brow", "tear", "occlusion", "cloth", "eye", "teeth", "tooth", "tongue", "gum"];
    let is_metal = from.metallic > 0.5 && from.metallic_roughness_texture.is_none();
    // What the skin of faces has no words for.
    let is_more = is_drawn
        || alpha != Alpha::Opaque
        || from.emissive != [0.0; 3]
        || !part.mesh.colors.is_empty()
        || from.textures().any(|texture| texture.uvs == UvSet::Second);
    match says(&["skin", "face", "head", "body"]) && !says(&other) && !is_metal && !is_more {
        true => PartKind::Skin,
        // Also for all that is no part of a face.
        false => PartKind::Surface,
    }
}

/// What the textures show beyond their edges.
fn wraps(from: &avatar_exchange::Material) -> Wraps {
    let of = |texture: Option<TextureRef>| {
        texture.map_or([Wrap::Repeat; 2], |texture| {
            texture.wrap.map(|wrap| match wrap {
                avatar_exchange::Wrap::Repeat => Wrap::Repeat,
                avatar_exchange::Wrap::Clamp => Wrap::Clamp,
                avatar_exchange::Wrap::Mirror => Wrap::Mirror,
            })
        })
    };
    Wraps {
        color: of(from.base_color_texture),
        occlusion: of(from.occlusion_texture),
        metallic_roughness: of(from.metallic_roughness_texture),
        normal: of(from.normal_texture),
        emissive: of(from.emissive_texture),
        shade: of(from.toon.as_ref().and_then(|toon| toon.shade_texture)),
    }
}

fn material(from: &avatar_exchange::Material, kind: PartKind, alpha: Alpha) -> Material {
    let [r, g, b, _] = from.base_color;
    let is_second = |texture: Option<TextureRef>| texture.is_some_and(|texture| texture.uvs == UvSet::Second);
    let standard = Standard {
        base_color: from.base_color,
        alpha,
        metallic: from.metallic,
        roughness: from.roughness,
        occlusion_strength: from.occlusion_strength,
        emissive: from.emissive,
        is_double_sided: from.double_sided,
        lighting: match &from.toon {
            Some(toon) => Lighting::Cartoon(Cartoon {
                shade_color: toon.shade_color,
                shading_shift: toon.shading_shift,
                shading_toony: toon.shading_toony,
                outline_width: toon.outline_width,
                outline_color: toon.outline_color,
            }),
            None if from.is_unlit => Lighting::Unlit,
            None => Lighting::Lit,
        },
        second_uvs: SecondUvs {
            color: is_second(from.base_color_texture),
            occlusion: is_second(from.occlusion_texture),
            metallic_roughness: is_second(from.metallic_roughness_texture),
            normal: is_second(from.normal_texture),
            emissive: is_second(from.emissive_texture),
            shade: is_second(from.toon.as_ref().and_then(|toon| toon.shade_texture)),
        },
    };
    let of_kind = Material::of(kind);
    let rough = from.roughness.clamp(0.08, 1.0);
    match kind {
        PartKind::Skin => Material { color: [r, g, b], standard: Some(standard), ..of_kind },
        // A cornea without a picture is as clear as any; files say so in many ways.
        PartKind::Cornea if from.base_color_texture.is_none() => of_kind,
        PartKind::Cornea => Material { standard: Some(standard), ..of_kind },
        PartKind::Surface | PartKind::Eyeball => Material {
            color: [r, g, b],
            roughness_matte: rough,
            roughness_glossy: rough,
            normal_strength: from.normal_scale,
            wrap: [0.0; 3],
            wetness: 0.0,
            back_light: 1.0,
            standard: Some(standard),
            ..of_kind
        },
    }
}

/// The way back, for export.
pub(crate) fn wrap_of(wrap: Wrap) -> avatar_exchange::Wrap {
    match wrap {
        Wrap::Repeat => avatar_exchange::Wrap::Repeat,
        Wrap::Clamp => avatar_exchange::Wrap::Clamp,
        Wrap::Mirror => avatar_exchange::Wrap::Mirror,
    }
}
