//! How a surface answers light, as plain functions over cosines: what the shaders compute, to be read beside
//! them and to be integrated in tests.
//!
//! The specular functions are true BRDF factors in 1/sr. A lamp of radiance 1 lights a white matte surface to
//! 1, so what is seen of a lamp is `π · f · n_dot_l · radiance`; [`wrapped_diffuse`] has that π in it
//! already.
//!
//! `alpha` is the parameter of GGX, the square of the perceptual roughness (B. Burley, "Physically-Based
//! Shading at Disney", 2012).

use glam::Vec3;
use std::f32::consts::PI;

/// The cosines between the normal, the direction to the eye, that to the light, and the one half-way between
/// both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cosines {
    /// Normal and light; not clamped, negative behind the surface.
    pub n_dot_l: f32,
    /// Normal and eye, at least 0.001: interpolated normals may turn away from the eye.
    pub n_dot_v: f32,
    /// Normal and half-way direction, 0 to 1.
    pub n_dot_h: f32,
    /// Eye and half-way direction, 0 to 1.
    pub v_dot_h: f32,
}

impl Cosines {
    /// From unit vectors. An eye exactly opposite to the light has no half-way direction; its cosines are 0.
    pub fn between(normal: Vec3, to_eye: Vec3, to_light: Vec3) -> Self {
        let half_way = (to_eye + to_light).normalize_or_zero();
        Self {
            n_dot_l: normal.dot(to_light),
            n_dot_v: normal.dot(to_eye).clamp(1e-3, 1.0),
            n_dot_h: normal.dot(half_way).clamp(0.0, 1.0),
            v_dot_h: to_eye.dot(half_way).clamp(0.0, 1.0),
        }
    }
}

/// Distribution of the normals of microfacets, in 1/sr: its integral over the hemisphere, times the cosine,
/// is 1.
///
/// GGX: B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, eq. 33. Below an
/// `alpha` of about 0.001 single precision no longer resolves the peak.
pub fn ggx_distribution(n_dot_h: f32, alpha: f32) -> f32 {
    let alpha2 = alpha * alpha;
    let f = (n_dot_h * alpha2 - n_dot_h) * n_dot_h + 1.0;
    alpha2 / (PI * f * f)
}

/// Height-correlated Smith masking and shadowing over 4 NoL NoV, as approximated by E. Hammon, "PBR Diffuse
/// Lighting for GGX+Smith Microsurfaces", 2017. Nowhere above the exact term of E. Heitz, "Understanding the
/// Masking-Shadowing Function in Microfacet-Based BRDFs", 2014, so it never makes energy; the epsilon keeps
/// grazing silhouettes finite.
pub fn smith_visibility(n_dot_v: f32, n_dot_l: f32, alpha: f32) -> f32 {
    0.5 / mix(2.0 * n_dot_l * n_dot_v, n_dot_l + n_dot_v, alpha).max(1e-4)
}

/// Share of light that a microfacet reflects: `reflectance` head on, all of it at grazing angles.
///
/// C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994.
pub fn schlick_fresnel(reflectance: f32, cosine: f32) -> f32 {
    let f = 1.0 - cosine.clamp(0.0, 1.0);
    let f2 = f * f;
    reflectance + (1.0 - reflectance) * f2 * f2 * f
}

/// What a white matte surface makes of a lamp of radiance 1 if light reaches around the terminator by `wrap`,
/// 0 (not at all) to 1 (to the far pole).
///
/// Over all directions it reflects what an unwrapped surface does: S. McAuley, "Energy-Conserving Wrapped
/// Diffuse". A wrap per channel gives skin its warm edge of shadow (S. Green, GPU Gems, chapter 16, 2004).
pub fn wrapped_diffuse(n_dot_l: f32, wrap: f32) -> f32 {
    let reach = 1.0 + wrap;
    ((n_dot_l + wrap) / (reach * reach)).max(0.0)
}

/// The BRDF of one GGX lobe, in 1/sr; 0 where the light is behind the surface.
///
/// R. Cook and K. Torrance, "A Reflectance Model for Computer Graphics", 1982, with the terms above.
pub fn specular(cosines: Cosines, reflectance: f32, alpha: f32) -> f32 {
    if cosines.n_dot_l <= 0.0 {
        return 0.0;
    }
    schlick_fresnel(reflectance, cosines.v_dot_h)
        * ggx_distribution(cosines.n_dot_h, alpha)
        * smith_visibility(cosines.n_dot_v, cosines.n_dot_l, alpha)
}

/// Two lobes of one film: the fields of these names of [`crate::Material`], and the roughness at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobes {
    /// Perceptual roughness of the first lobe.
    pub roughness: f32,
    /// Share of the second lobe, 0 to 1.
    pub sharp_share: f32,
    /// Roughness of the second lobe as a factor on that of the first.
    pub sharp_roughness: f32,
}

/// The BRDF of two mixed GGX lobes, in 1/sr; 0 where the light is behind the surface. As a mixture it
/// reflects no more than the stronger of both.
///
/// Skin has a broad lobe of its cells and a sharper one of its oil: E. d'Eon and D. Luebke, GPU Gems 3,
/// chapter 14, 2007; two measured lobes: A. Ghosh et al., "Practical Modeling and Acquisition of Layered
/// Facial Reflectance", 2008.
pub fn two_lobe_specular(cosines: Cosines, reflectance: f32, lobes: Lobes) -> f32 {
    let sharp = lobes.roughness * lobes.sharp_roughness;
    mix(
        specular(cosines, reflectance, lobes.roughness * lobes.roughness),
        specular(cosines, reflectance, sharp * sharp),
        lobes.sharp_share,
    )
}

/// The parameter `d` of [`crate::scatter_table`], in the unit of `mean_free_path`, from the diffuse mean free
/// path and the albedo of the surface, 0 to 1; from 2/7 of the path for dark surfaces to 1/24 for white ones.
///
/// P. Christensen and B. Burley, "Approximate Reflectance Profiles for Efficient Subsurface Scattering",
/// 2015, eq. 8.
pub fn diffusion_distance(mean_free_path: f32, albedo: f32) -> f32 {
    let off = albedo - 0.33;
    mean_free_path / (3.5 + 100.0 * off * off * off * off)
}

fn mix(a: f32, b: f32, share: f32) -> f32 {
    a + (b - a) * share
}
