//! Materials on their way to the GPU.

use crate::gpu::program::{Constant, Module, Value};
use crate::model::eye::{EyeShape, PROFILE_LEN};
use crate::model::geometry::Geometry;
use avatar_look::optics::diffusion_distance;
use avatar_look::{Iris, Material};

/// The albedo with which the mean free path of skin is converted to the width of its scattering profile. One
/// for all skin: the width must not change from freckle to freckle.
const SKIN_ALBEDO: f32 = 0.6;

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

/// WGSL of the material and textures of a part.
pub(crate) const LOOK: Module = Module { text: include_str!("shaders/look.wgsl"), constants };

fn constants() -> Vec<Constant> {
    vec![
        ("COLOR_TEXTURE", Value::Count(COLOR_TEXTURE)),
        ("OCCLUSION_TEXTURE", Value::Count(OCCLUSION_TEXTURE)),
        ("GLOSS_TEXTURE", Value::Count(GLOSS_TEXTURE)),
        ("NORMAL_TEXTURE", Value::Count(NORMAL_TEXTURE)),
        ("THICKNESS_TEXTURE", Value::Count(THICKNESS_TEXTURE)),
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
    pub(crate) pad: u32,
    pub(crate) iris: GpuIris,
}

impl GpuMaterial {
    /// `height` is that of the skin, the unit of lengths in materials.
    pub(crate) fn new(
        material: &Material,
        geometry: &Geometry,
        eye: Option<&EyeShape>,
        height: f32,
        textures: u32,
    ) -> Self {
        Self {
            color: material.color,
            opacity: material.opacity,
            wrap: material.wrap,
            reflectance: material.reflectance,
            scatter: material.scatter.map(|path| diffusion_distance(path * height, SKIN_ALBEDO)),
            roughness_matte: material.roughness_matte,
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
            textures,
            pad: 0,
            iris: eye.map_or_else(bytemuck::Zeroable::zeroed, |eye| GpuIris::new(&material.iris, eye)),
        }
    }
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
        }
    }
}
