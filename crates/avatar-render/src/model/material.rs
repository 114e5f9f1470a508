//! Materials on their way to the GPU.

use crate::gpu::program::{Constant, Module, Value};
use crate::model::eye::{EyeShape, PROFILE_LEN};
use crate::model::finish::cutoffs;
use crate::model::geometry::Geometry;
use avatar_look::optics::diffusion_distance;
use avatar_look::{Cartoon, Iris, Lighting, Material, SecondUvs};
use avatar_mesh::PartKind;

/// The albedo with which the mean free path of skin is converted to the width of its scattering profile. One
/// for all skin: the width must not change from freckle to freckle.
const SKIN_ALBEDO: f32 = 0.6;

/// Colours that are divided by are at least this, the darkest that eight bits of sRGB tell from black.
const LEAST_COLOR: f32 = 3e-4;

/// Bit of `GpuMaterial::textures`.
pub(crate) const COLOR_TEXTURE: u32 = 1;
/// Bit of `GpuMaterial::textures`.
pub(crate) const OCCLUSION_TEXTURE: u32 = 2;
/// Bit of `GpuMaterial::textures`.
pub(crate) const GLOSS_TEXTURE: u32 = 4;
/// Bit of `GpuMaterial::textures`.
pub(crate) const NORMAL_TEXTURE: u32 = 8;
/// Bit of `GpuMaterial::textures`.
pub(crate) const THICKNESS_TEXTURE: u32 = 16;
/// Bit of `GpuMaterial::textures`: in the slot of gloss.
pub(crate) const METALLIC_ROUGHNESS_TEXTURE: u32 = 32;
/// Bit of `GpuMaterial::textures`: in the slot of thickness.
pub(crate) const EMISSIVE_TEXTURE: u32 = 64;
/// Bit of `GpuMaterial::textures`: in the slot of gloss.
pub(crate) const SHADE_TEXTURE: u32 = 128;
/// Bit of `GpuMaterial::textures`: an interchange file says how the part looks. The colour is then a
/// factor on its texture instead of lying below it, occlusion has a strength, and relief is that of glTF.
pub(crate) const FROM_FILE: u32 = 256;
/// Bit of `GpuMaterial::textures`: the base colour is seen as it is.
pub(crate) const UNLIT: u32 = 512;
/// Bit of `GpuMaterial::textures`: drawn as a cartoon.
pub(crate) const CARTOON: u32 = 1024;

/// Bit of `GpuMaterial::textures`.
pub(crate) const WRINKLE_TEXTURE: u32 = 2048;

/// WGSL of the material and textures of a part.
pub(crate) const LOOK: Module = Module { text: include_str!("shaders/look.wgsl"), constants };

fn constants() -> Vec<Constant> {
    vec![
        ("COLOR_TEXTURE", Value::Count(COLOR_TEXTURE)),
        ("OCCLUSION_TEXTURE", Value::Count(OCCLUSION_TEXTURE)),
        ("GLOSS_TEXTURE", Value::Count(GLOSS_TEXTURE)),
        ("NORMAL_TEXTURE", Value::Count(NORMAL_TEXTURE)),
        ("THICKNESS_TEXTURE", Value::Count(THICKNESS_TEXTURE)),
        ("METALLIC_ROUGHNESS_TEXTURE", Value::Count(METALLIC_ROUGHNESS_TEXTURE)),
        ("EMISSIVE_TEXTURE", Value::Count(EMISSIVE_TEXTURE)),
        ("SHADE_TEXTURE", Value::Count(SHADE_TEXTURE)),
        ("FROM_FILE", Value::Count(FROM_FILE)),
        ("UNLIT", Value::Count(UNLIT)),
        ("CARTOON", Value::Count(CARTOON)),
        ("WRINKLE_TEXTURE", Value::Count(WRINKLE_TEXTURE)),
        ("PROFILE_ROWS", Value::Count(PROFILE_LEN as u32 / 4)),
        ("PATH_PER_DISTANCE", Value::Float(1.0 / diffusion_distance(1.0, SKIN_ALBEDO))),
    ]
}

/// WGSL `Iris`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuIris {
    pub(crate) cornea_center: [f32; 3],
    pub(crate) cornea_radius: f32,
    pub(crate) uv_center: [f32; 2],
    pub(crate) uv_from_x: [f32; 2],
    pub(crate) uv_from_y: [f32; 2],
    pub(crate) profile_reach: f32,
    pub(crate) plane_z: f32,
    pub(crate) profile: [[f32; 4]; PROFILE_LEN / 4],
    pub(crate) radius: f32,
    pub(crate) refractive_index: f32,
    pub(crate) pupil: f32,
    pub(crate) painted_pupil: f32,
    pub(crate) limbal_width: f32,
    pub(crate) limbal_darkness: f32,
    pub(crate) pad: [f32; 2],
    pub(crate) color: [f32; 3],
    pub(crate) uv_radius: f32,
    pub(crate) painted_color: [f32; 3],
    pub(crate) end: f32,
}

/// WGSL `Material`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuMaterial {
    pub(crate) color: [f32; 3],
    pub(crate) opacity: f32,
    pub(crate) wrap: [f32; 3],
    pub(crate) reflectance: f32,
    pub(crate) scatter: [f32; 3],
    pub(crate) roughness_matte: f32,
    pub(crate) roughness_glossy: f32,
    pub(crate) normal_strength: f32,
    pub(crate) sharp_share: f32,
    pub(crate) sharp_roughness: f32,
    pub(crate) transmission: f32,
    pub(crate) thickness: f32,
    pub(crate) pore_strength: f32,
    pub(crate) pore_density: f32,
    pub(crate) pores_per_length: f32,
    pub(crate) wetness: f32,
    pub(crate) film_roughness: f32,
    pub(crate) back_light: f32,
    pub(crate) front_z: f32,
    pub(crate) per_depth: f32,
    pub(crate) textures: u32,
    pub(crate) second_uvs: u32,
    pub(crate) shade_color: [f32; 3],
    pub(crate) alpha_cutoff: f32,
    pub(crate) emissive: [f32; 3],
    pub(crate) metallic: f32,
    pub(crate) outline_color: [f32; 3],
    pub(crate) outline_width: f32,
    pub(crate) occlusion_strength: f32,
    pub(crate) shading_shift: f32,
    pub(crate) shading_toony: f32,
    pub(crate) shadow_cutoff: f32,
    pub(crate) tone: [f32; 3],
    pub(crate) bare_green: f32,
    pub(crate) wrinkle_depth: f32,
    pub(crate) pad: [f32; 3],
    pub(crate) iris: GpuIris,
}

impl GpuMaterial {
    /// `height` is that of the skin, the unit of lengths in materials.
    pub(crate) fn new(
        material: &Material,
        kind: PartKind,
        geometry: &Geometry,
        eye: Option<&EyeShape>,
        height: f32,
        textures: u32,
    ) -> Self {
        let standard = material.standard.unwrap_or_default();
        let ([r, g, b], opacity, roughness) = match material.standard {
            Some(standard) => {
                let [r, g, b, opacity] = standard.base_color;
                // Parts of a face keep the roughness of their kinds.
                let roughness = (kind == PartKind::Surface).then_some(standard.roughness);
                ([r, g, b], opacity, roughness)
            }
            None => (material.color, material.opacity, None),
        };
        let [alpha_cutoff, shadow_cutoff] = cutoffs(&standard);
        let cartoon = match standard.lighting {
            Lighting::Cartoon(cartoon) => cartoon,
            Lighting::Lit | Lighting::Unlit => Cartoon {
                shade_color: [0.0; 3],
                shading_shift: 0.0,
                shading_toony: 0.0,
                outline_width: 0.0,
                outline_color: [0.0; 3],
            },
        };
        let lighting = match standard.lighting {
            Lighting::Lit => 0,
            Lighting::Unlit => UNLIT,
            Lighting::Cartoon(_) => CARTOON,
        };
        let painted = material.tone.painted.map(|channel| channel.max(LEAST_COLOR));
        let tone = match kind {
            PartKind::Skin => std::array::from_fn(|k| material.tone.color[k].max(LEAST_COLOR) / painted[k]),
            PartKind::Surface | PartKind::Eyeball | PartKind::Cornea => [1.0; 3],
        };
        let bare_green = painted[1] / painted[0];
        let from_file = if material.standard.is_some() { FROM_FILE } else { 0 };
        Self {
            color: [r, g, b],
            opacity,
            wrap: material.wrap,
            reflectance: material.reflectance,
            scatter: material.scatter.map(|path| diffusion_distance(path * height, SKIN_ALBEDO)),
            roughness_matte: roughness.unwrap_or(material.roughness_matte),
            roughness_glossy: material.roughness_glossy,
            normal_strength: material.normal_strength,
            sharp_share: material.sharp_share,
            sharp_roughness: material.sharp_roughness,
            transmission: material.transmission,
            thickness: material.thickness * height,
            pore_strength: material.pore_strength,
            pore_density: material.pore_density * geometry.length_per_uv / height,
            pores_per_length: material.pore_density / height,
            wetness: material.wetness,
            film_roughness: material.film_roughness,
            back_light: material.back_light,
            front_z: geometry.front_z,
            per_depth: geometry.per_depth,
            textures: textures | lighting | from_file,
            second_uvs: second_uvs(standard.second_uvs),
            shade_color: cartoon.shade_color,
            alpha_cutoff,
            emissive: standard.emissive,
            metallic: standard.metallic,
            outline_color: cartoon.outline_color,
            outline_width: cartoon.outline_width,
            occlusion_strength: standard.occlusion_strength,
            shading_shift: cartoon.shading_shift,
            shading_toony: cartoon.shading_toony,
            shadow_cutoff,
            tone,
            bare_green,
            wrinkle_depth: material.wrinkle_depth * height,
            pad: [0.0; 3],
            iris: eye.map_or_else(bytemuck::Zeroable::zeroed, |eye| GpuIris::new(&material.iris, eye)),
        }
    }

    /// Whether skin or iris has another colour than it is painted in.
    pub(crate) fn is_recolored(&self) -> bool {
        self.tone != [1.0; 3] || self.iris.uv_radius > 0.0
    }
}

/// The bits of the textures that lie by the second texture coordinates.
fn second_uvs(second: SecondUvs) -> u32 {
    let bits = [
        (second.color, COLOR_TEXTURE),
        (second.occlusion, OCCLUSION_TEXTURE),
        (second.metallic_roughness, METALLIC_ROUGHNESS_TEXTURE),
        (second.normal, NORMAL_TEXTURE),
        (second.emissive, EMISSIVE_TEXTURE),
        (second.shade, SHADE_TEXTURE),
    ];
    bits.iter().filter(|(is_second, _)| *is_second).map(|(_, bit)| bit).sum()
}

impl GpuIris {
    fn new(iris: &Iris, eye: &EyeShape) -> Self {
        let (rows, _) = eye.profile.as_chunks::<4>();
        let mut profile = [[0.0; 4]; PROFILE_LEN / 4];
        profile.iter_mut().zip(rows).for_each(|(to, from)| *to = *from);
        Self {
            cornea_center: eye.center.to_array(),
            cornea_radius: eye.radius,
            uv_center: eye.uv_center.to_array(),
            uv_from_x: eye.uv_from_x.to_array(),
            uv_from_y: eye.uv_from_y.to_array(),
            profile_reach: eye.profile_reach,
            plane_z: eye.surface_z - iris.depth * eye.edge_radius,
            profile,
            radius: iris.radius * eye.edge_radius,
            refractive_index: iris.refractive_index.max(1.0),
            pupil: iris.pupil.clamp(0.02, 0.98),
            painted_pupil: iris.painted_pupil.clamp(0.02, 0.98),
            limbal_width: iris.limbal_width,
            limbal_darkness: iris.limbal_darkness,
            pad: [0.0; 2],
            color: iris.color,
            uv_radius: if iris.color == iris.painted_color {
                0.0
            } else {
                eye.painted(iris.radius * eye.edge_radius)
            },
            painted_color: iris.painted_color.map(|channel| channel.max(LEAST_COLOR)),
            end: 0.0,
        }
    }
}
