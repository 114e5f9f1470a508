// Lays the strands of all pixels over the picture, and notes the depth of those that hide what lies behind them.
// The view holds where they lie, what they leave clear, and their weighted sum.

@vertex
fn compose_vertex_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    // One triangle that covers the picture.
    return vec4f(f32(i32(i & 1u) * 4 - 1), f32(i32(i >> 1u) * 4 - 1), 0.0, 1.0);
}

@fragment
fn compose_main(@builtin(position) position_clip: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position_clip.xy);
    let coverage = 1.0 - textureLoad(occlusion_view, pixel, 0).r;
    if coverage <= 0.0 {
        discard;
    }
    let sum = textureLoad(skin_light, pixel, 0);
    return vec4f(sum.rgb / max(sum.a, 1e-6) * coverage, coverage);
}
