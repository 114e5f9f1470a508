// Depth of strands that hide what is clear and lies behind them: lashes leave the cornea seen, a fringe does not.

@fragment
fn compose_depth_main(@builtin(position) position_clip: vec4f) -> @builtin(frag_depth) f32 {
    let pixel = vec2i(position_clip.xy);
    if textureLoad(hair_clear, pixel, 0).r > 0.5 {
        discard;
    }
    let near = textureLoad(hair_layers, pixel, 0).a;
    let distance = frame.hair_far - near / max(frame.hair_per_depth, 1e-12);
    return saturate(frame.near / max(distance, frame.near));
}
