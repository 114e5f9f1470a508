// Writes the depth of strands that are dense enough to hide clear parts behind them: a fringe hides a cornea,
// lashes do not.

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
