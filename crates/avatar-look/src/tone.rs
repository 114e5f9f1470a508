//! Tone mappers: from linear light of any brightness to linear light that a screen can show, 0 to 1. Rec. 709
//! primaries on both sides; encoding for the screen (sRGB) comes afterwards.

use crate::ToneMap;
use glam::{Mat3, Vec3};

impl ToneMap {
    /// Maps linear light, `[r, g, b]`. Negative light counts as none, but for [`ToneMap::Linear`], which
    /// changes nothing.
    pub fn apply(self, rgb: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Neutral => neutral(rgb),
            Self::AgX => agx(rgb),
            Self::Linear => rgb,
        }
    }
}

/// The light that a perfect dielectric of reflectance 4 % adds to a base colour, and that this takes off
/// again.
const FRESNEL: f32 = 0.04;
/// From here on light is compressed.
const COMPRESSION_START: f32 = 0.8 - FRESNEL;
/// How fast compressed light turns pale.
const DESATURATION: f32 = 0.15;

/// Khronos PBR Neutral: what is not bright keeps the colour of its texture.
///
/// Khronos Group, "PBR Neutral Tone Mapper Specification", 2024,
/// <https://github.com/KhronosGroup/ToneMapping>.
pub fn neutral(rgb: [f32; 3]) -> [f32; 3] {
    let light = Vec3::from(rgb).max(Vec3::ZERO);
    let least = light.min_element();
    // Where the darkest channel is below twice the Fresnel term, it is squeezed instead, so as not to become
    // negative.
    let offset = if least < 2.0 * FRESNEL { least - least * least / (4.0 * FRESNEL) } else { FRESNEL };
    let base = light - offset;
    let peak = base.max_element();
    if peak < COMPRESSION_START {
        return base.to_array();
    }
    let room = 1.0 - COMPRESSION_START;
    let new_peak = 1.0 - room * room / (peak + room - COMPRESSION_START);
    let paleness = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    (base * (new_peak / peak)).lerp(Vec3::splat(new_peak), paleness).to_array()
}

/// Stops below and above 1 between which AgX tells light apart: 10 below middle grey 0.18, 6.5 above it.
const MIN_EV: f32 = -12.473_931;
const MAX_EV: f32 = 4.026_069;
/// Where middle grey lies between both, 10/16.5. There the curve is 0.5 and its slope 2.
const PIVOT: f32 = 20.0 / 33.0;
const SLOPE: f32 = 2.0;
const TOE_POWER: f32 = 3.0;
const SHOULDER_POWER: f32 = 3.25;

/// Mixes the channels before the curve, so that bright colours turn pale; columns are what red, green and
/// blue become.
const INSET: Mat3 = Mat3::from_cols(
    Vec3::new(0.842_401_1, 0.042_401_07, 0.042_401_07),
    Vec3::new(0.078_436_5, 0.878_436_5, 0.078_436_5),
    Vec3::new(0.079_162_43, 0.079_162_43, 0.879_162_43),
);
/// Its inverse.
const OUTSET: Mat3 = Mat3::from_cols(
    Vec3::new(1.196_998_7, -0.053_001_34, -0.053_001_34),
    Vec3::new(-0.098_045_63, 1.151_954_4, -0.098_045_63),
    Vec3::new(-0.098_953_03, -0.098_953_03, 1.151_047),
);

/// AgX: filmic, bright colours turn pale.
///
/// T. Sobotka, "AgX", 2022, <https://github.com/sobotka/AgX>, with the closed form of its curve in place of
/// the table: bWFuanVzYWth, "AgX", 2023, <https://github.com/bWFuanVzYWth/AgX>. AgX yields colours for a
/// screen of gamma 2.2; this undoes the gamma.
pub fn agx(rgb: [f32; 3]) -> [f32; 3] {
    let light = INSET * Vec3::from(rgb).max(Vec3::ZERO);
    // No light has no logarithm; the least positive one is far below the range already.
    let stops = light.max(Vec3::splat(f32::MIN_POSITIVE)).to_array().map(f32::log2);
    let curved = stops.map(|ev| agx_curve(((ev - MIN_EV) / (MAX_EV - MIN_EV)).clamp(0.0, 1.0)));
    let encoded = (OUTSET * Vec3::from(curved)).clamp(Vec3::ZERO, Vec3::ONE);
    encoded.to_array().map(|value| value.powf(2.2))
}

/// AgX's sigmoid: from the share of its range of stops, 0 to 1, to a colour for a screen, 0 to 1.
///
/// On either side of the pivot a line that is bent toward the end, `slope · x / (1 + a·|x|^p)^(1/p)`; `a`
/// lets the sides end at 0 and 1.
pub fn agx_curve(x: f32) -> f32 {
    let (end, power) = if x < PIVOT { (PIVOT, TOE_POWER) } else { (1.0 - PIVOT, SHOULDER_POWER) };
    let a = (2.0 * SLOPE).powf(power) - end.powf(-power);
    let x = x - PIVOT;
    0.5 + SLOPE * x * (1.0 + a * x.abs().powf(power)).powf(-1.0 / power)
}
