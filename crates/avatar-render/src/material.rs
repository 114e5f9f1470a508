use avatar_mesh::PartKind;

/// The looks of a part: plain data, with defaults per kind. Colours are linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Colour where no texture covers it.
    pub color: [f32; 3],
    /// 1 hides what lies behind; read for corneas only.
    pub opacity: f32,
    /// How far diffuse light reaches around the terminator, per channel, 0 (not at all) to 1.
    pub wrap: [f32; 3],
    /// Share of light reflected at normal incidence.
    pub reflectance: f32,
    /// Perceptual roughness where the gloss texture is black; without a texture the mean of both counts.
    pub roughness_matte: f32,
    /// Perceptual roughness where the gloss texture is white.
    pub roughness_glossy: f32,
    /// Factor on the tilt of the normal texture.
    pub normal_strength: f32,
}

impl Material {
    /// The default of a kind, visible without any texture.
    pub fn of(kind: PartKind) -> Self {
        let matte = Self {
            color: [0.8; 3],
            opacity: 1.0,
            wrap: [0.0; 3],
            reflectance: 0.04,
            roughness_matte: 0.7,
            roughness_glossy: 0.3,
            normal_strength: 1.0,
        };
        match kind {
            // Reflectance: E. d'Eon and D. Luebke, "Advanced Techniques for Realistic Real-Time Skin Rendering", 2007.
            PartKind::Skin => Self {
                color: [0.60, 0.36, 0.26],
                wrap: [0.28, 0.14, 0.09],
                reflectance: 0.028,
                roughness_matte: 0.65,
                roughness_glossy: 0.35,
                ..matte
            },
            PartKind::Teeth => Self {
                color: [0.78, 0.70, 0.56],
                wrap: [0.2, 0.18, 0.15],
                roughness_matte: 0.4,
                roughness_glossy: 0.15,
                ..matte
            },
            PartKind::Eyeball => Self {
                color: [0.82, 0.80, 0.77],
                wrap: [0.25, 0.2, 0.2],
                reflectance: 0.02,
                roughness_matte: 0.6,
                roughness_glossy: 0.4,
                ..matte
            },
            // Reflectance of water, refractive index 1.33.
            PartKind::Cornea => Self {
                color: [0.8, 0.85, 0.9],
                opacity: 0.03,
                reflectance: 0.02,
                roughness_matte: 0.3,
                roughness_glossy: 0.2,
                ..matte
            },
        }
    }
}

/// Bit of `GpuMaterial::textures`.
pub(crate) const COLOR_TEXTURE: u32 = 1;
/// Bit of `GpuMaterial::textures`.
pub(crate) const OCCLUSION_TEXTURE: u32 = 2;
/// Bit of `GpuMaterial::textures`.
pub(crate) const GLOSS_TEXTURE: u32 = 4;
/// Bit of `GpuMaterial::textures`.
pub(crate) const NORMAL_TEXTURE: u32 = 8;

/// WGSL `Material`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct GpuMaterial {
    pub(crate) color: [f32; 3],
    pub(crate) opacity: f32,
    pub(crate) wrap: [f32; 3],
    pub(crate) reflectance: f32,
    pub(crate) roughness_matte: f32,
    pub(crate) roughness_glossy: f32,
    pub(crate) normal_strength: f32,
    pub(crate) textures: u32,
}

impl GpuMaterial {
    pub(crate) fn new(material: &Material, textures: u32) -> Self {
        Self {
            color: material.color,
            opacity: material.opacity,
            wrap: material.wrap,
            reflectance: material.reflectance,
            roughness_matte: material.roughness_matte,
            roughness_glossy: material.roughness_glossy,
            normal_strength: material.normal_strength,
            textures,
        }
    }
}
