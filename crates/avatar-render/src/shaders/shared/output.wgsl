// From light to the values of the target.

// 1 where the target is 8-bit without hardware encoding.
override ENCODE_SRGB: bool = false;

// Khronos PBR Neutral, 2024: colours below 0.8 stay what the textures say, brighter ones are compressed and
// lose their saturation instead of clipping.
fn tone_mapped(light: vec3f) -> vec3f {
    let compression_start = 0.8 - 0.04;
    let desaturation = 0.15;
    let lowest = min(light.r, min(light.g, light.b));
    let offset = select(0.04, lowest - 6.25 * lowest * lowest, lowest < 0.08);
    let color = light - offset;
    let peak = max(color.r, max(color.g, color.b));
    if peak < compression_start {
        return color;
    }
    let d = 1.0 - compression_start;
    let new_peak = 1.0 - d * d / (peak + d - compression_start);
    let compressed = color * (new_peak / peak);
    let g = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(compressed, vec3f(new_peak), g);
}

// IEC 61966-2-1.
fn srgb_from_linear(linear: vec3f) -> vec3f {
    let c = saturate(linear);
    return select(1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3f(0.0031308));
}

// Premultiplied colour of the target from light that is already weighted by its coverage.
fn target_color(light: vec3f, coverage: f32) -> vec4f {
    let linear = tone_mapped(light * frame.exposure);
    if ENCODE_SRGB {
        return vec4f(srgb_from_linear(linear), coverage);
    }
    return vec4f(linear, coverage);
}
