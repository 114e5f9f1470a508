// The eyeball: matte, for the wet highlight belongs to the cornea in front of it.

@fragment
fn eyeball_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    var surface = surface_at(in, in.uv, is_front);
    // Brow and lids keep the light from above off the ball, and its far sides lie deep in the socket; a guess
    // that stands in for shadows.
    let under_brow = smoothstep(-0.1, 0.75, surface.normal.y);
    let in_socket = smoothstep(0.15, 0.6, in.depth);
    surface.occlusion *= (1.0 - 0.45 * under_brow) * (1.0 - 0.6 * in_socket);
    let lit = lit_surface(surface);
    return target_color(surface.color * lit.diffuse + lit.specular, 1.0);
}
