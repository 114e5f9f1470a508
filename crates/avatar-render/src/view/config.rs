//! The configuration of a renderer, and the constants that programs get from it.

use crate::gpu::program::{Constant, Value};
use crate::view::shading::{Scattering, Shading};

/// Whether strands cover some of a pixel's samples instead of being blended.
pub(crate) const COVERAGE_MASK: &str = "COVERAGE_MASK";

/// What a renderer draws into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RendererConfig {
    /// Format of the target. sRGB and float formats get linear values, other normalised formats get encoded
    /// ones; prefer an sRGB format (or an sRGB view), where the corneas are blended in linear light.
    pub color_format: wgpu::TextureFormat,
    /// Samples per pixel: 1 or 4.
    pub samples: u32,
    /// How parts are shaded; see [`Quality::shading`](crate::Quality::shading).
    pub shading: Shading,
}

impl RendererConfig {
    /// Whether the shaders encode their colours because the target does not.
    pub(crate) fn encodes_in_shader(self) -> bool {
        encodes_in_shader(self.color_format)
    }

    /// The constants of all programs of the renderer.
    pub(crate) fn choices(self) -> Vec<Constant> {
        let terms = self.shading.terms();
        let flag = |name, on| (name, Value::Flag(on));
        let count = |name, count| (name, Value::Count(count));
        vec![
            count("SHADOW_COUNT_USED", terms.shadows.lamps()),
            ("SHADOW_REACH", Value::Signed(terms.shadows.reach().map_or(-1, |reach| reach as i32))),
            ("SHADOW_SIZE", Value::Float(terms.shadows.map_size() as f32)),
            ("HAIR_MAP_SIZE", Value::Float(terms.shadows.hair_map_size() as f32)),
            count("WRAPPED", Scattering::Wrapped as u32),
            count("PRE_INTEGRATED", Scattering::PreIntegrated as u32),
            count("SEPARABLE", Scattering::Separable as u32),
            count("SCATTERING", terms.scattering as u32),
            flag("OCCLUSION_VIEW", terms.occlusion),
            flag("REFLECTIONS", terms.reflections),
            flag("SHARP_LOBE", terms.sharp_lobe),
            flag("PORES", terms.pores),
            flag("TRANSMISSION", terms.transmission),
            flag("EYE_OPTICS", terms.eye_optics),
            flag("ENCODE_SRGB", self.encodes_in_shader()),
            // Thin strands cover some of a pixel's samples instead of being blended.
            flag(COVERAGE_MASK, self.samples > 1),
            flag("TOON", self.shading == Shading::Toon),
        ]
    }
}

/// Whether shaders encode the colours of a target of this format because it does not.
pub(crate) fn encodes_in_shader(color_format: wgpu::TextureFormat) -> bool {
    use wgpu::TextureFormat as F;
    matches!(
        color_format,
        F::R8Unorm
            | F::Rg8Unorm
            | F::Rgba8Unorm
            | F::Bgra8Unorm
            | F::Rgb10a2Unorm
            | F::R16Unorm
            | F::Rg16Unorm
            | F::Rgba16Unorm
            | F::R8Snorm
            | F::Rg8Snorm
            | F::Rgba8Snorm
            | F::R16Snorm
            | F::Rg16Snorm
            | F::Rgba16Snorm
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_normalised_format_without_srgb_gets_encoded_colours_and_no_other() {
        use wgpu::TextureFormat as F;
        for color_format in [
            F::R8Unorm,
            F::R8Snorm,
            F::R16Unorm,
            F::R16Snorm,
            F::R16Float,
            F::Rg8Unorm,
            F::Rg8Snorm,
            F::R32Float,
            F::Rg16Unorm,
            F::Rg16Snorm,
            F::Rg16Float,
            F::Rgba8Unorm,
            F::Rgba8UnormSrgb,
            F::Rgba8Snorm,
            F::Bgra8Unorm,
            F::Bgra8UnormSrgb,
            F::Rgb10a2Unorm,
            F::Rg11b10Ufloat,
            F::Rgba16Unorm,
            F::Rgba16Snorm,
            F::Rgba16Float,
            F::Rgba32Float,
        ] {
            let config = RendererConfig { color_format, samples: 1, shading: Shading::Plain };
            let is_normalised = format!("{color_format:?}").ends_with("norm");
            assert_eq!(config.encodes_in_shader(), is_normalised, "{color_format:?}");
        }
    }
}
