// Lays the strands of all pixels over the picture, and notes the depth of those that hide what lies behind
// them.

// Group 1: where strands lie, see layers.wgsl; the share of each pixel that they leave clear; and the sum of
// their colours, each times its weight, with the sum of weights in alpha.
@group(1) @binding(0) var hair_layers: texture_2d<f32>;
@group(1) @binding(1) var hair_clear: texture_2d<f32>;
@group(1) @binding(2) var hair_sum: texture_2d<f32>;

@vertex
fn compose_vertex_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    // One triangle that covers the picture.
    return vec4f(f32(i32(i & 1u) * 4 - 1), f32(i32(i >> 1u) * 4 - 1), 0.0, 1.0);
}

@fragment
fn compose_main(@builtin(position) position_clip: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position_clip.xy);
    let coverage = 1.0 - textureLoad(hair_clear, pixel, 0).r;
    if coverage <= 0.0 {
        discard;
    }
    let sum = textureLoad(hair_sum, pixel, 0);
    return vec4f(sum.rgb / max(sum.a, 1e-6) * coverage, coverage);
}
