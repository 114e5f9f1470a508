// Teeth, gums and tongue: wet, and darker toward the back of the mouth.

@fragment
fn teeth_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let surface = surface_at(in, is_front);
    let lit = lit_surface(surface);
    return target_color(surface.color * lit.diffuse + lit.specular, 1.0);
}
