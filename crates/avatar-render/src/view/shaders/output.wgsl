// From light to the values of the target. The twins on the CPU are avatar_look::ToneMap and its functions.

// Khronos PBR Neutral, 2024: colours below 0.8 stay what the textures say, brighter ones are compressed and
// lose their saturation instead of clipping.
fn neutral(light: vec3f) -> vec3f {
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

// AgX: T. Sobotka, 2022; the curve in closed form. Light is mixed a little between channels, measured in
// stops, bent into an S, and mixed back, so that bright colours turn pale instead of changing their hue.
fn agx_curve(v: vec3f) -> vec3f {
    let pivot = vec3f(0.6060606060606061);
    let above = v > pivot;
    let scale = select(vec3f(59.507875), vec3f(69.86278913545539), above);
    let power = select(vec3f(3.0), vec3f(3.25), above);
    let root = select(vec3f(-1.0 / 3.0), vec3f(-4.0 / 13.0), above);
    return 0.5 + 2.0 * (v - pivot) * pow(1.0 + scale * pow(abs(v - pivot), power), root);
}

fn agx(light: vec3f) -> vec3f {
    let inset = mat3x3f(
        0.8424010709504686, 0.04240107095046854, 0.04240107095046854,
        0.07843650156180276, 0.8784365015618028, 0.07843650156180276,
        0.0791624274877287, 0.0791624274877287, 0.8791624274877287);
    let outset = mat3x3f(
        1.1969986613119143, -0.053001338688085674, -0.053001338688085674,
        -0.09804562695225345, 1.1519543730477466, -0.09804562695225345,
        -0.09895303435966087, -0.09895303435966087, 1.151046965640339);
    let fewest_stops = -12.473931188332413;
    let most_stops = 4.026068811667588;
    let stops = log2(max(inset * light, vec3f(1e-10)));
    let share = saturate((stops - fewest_stops) / (most_stops - fewest_stops));
    // The curve is made for displays with a gamma of 2.2; the target takes light.
    return pow(saturate(outset * agx_curve(share)), vec3f(2.2));
}

fn tone_mapped(light: vec3f) -> vec3f {
    if frame.tone_map == TONE_NEUTRAL {
        return neutral(light);
    }
    if AGX && frame.tone_map == TONE_AGX {
        return agx(light);
    }
    return light;
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
