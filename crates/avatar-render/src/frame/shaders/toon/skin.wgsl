// Skin, drawn.

@fragment
fn skin_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    return target_color(toon_color(surface_at(in, in.uv, is_front)), 1.0);
}
