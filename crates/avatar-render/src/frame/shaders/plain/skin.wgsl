// Skin: matte with a soft warm terminator, under a thin oily reflection.

@fragment
fn skin_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let surface = surface_at(in, in.uv, is_front);
    let lit = lit_surface(surface);
    return target_color(surface.color * lit.diffuse + lit.specular, 1.0);
}
