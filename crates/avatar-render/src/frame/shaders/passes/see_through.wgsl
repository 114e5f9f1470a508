// A picture with a transparent background, as the compositor of a desktop takes it. Pictures are blended in
// linear light, desktops in encoded values: what covers half of a pixel would shine at its rim.

// Nothing of the frame is used here, so that its places are free.
@group(0) @binding(0) var picture: texture_2d<f32>;

@vertex
fn see_through_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    // One triangle that covers the target.
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4f(2.0 * corner - 1.0, 0.0, 1.0);
}

fn linear_from_srgb(encoded: vec3f) -> vec3f {
    let c = saturate(encoded);
    return select(pow((c + 0.055) / 1.055, vec3f(2.4)), c / 12.92, c <= vec3f(0.04045));
}

@fragment
fn see_through_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let color = textureLoad(picture, vec2i(at.xy), 0);
    if color.a <= 0.0 {
        return vec4f(0.0);
    }
    // Both are weighted by the coverage.
    var light = color.rgb;
    if ENCODE_SRGB {
        light = linear_from_srgb(light);
    }
    var encoded = srgb_from_linear(light / color.a);
    if IS_PREMULTIPLIED {
        encoded *= color.a;
    }
    if TARGET_ENCODES {
        encoded = linear_from_srgb(encoded);
    }
    return vec4f(encoded, color.a);
}
