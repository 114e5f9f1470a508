// Teeth, gums and tongue: wet, and darker toward the back of the mouth.

@fragment
fn teeth_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    var surface = surface_at(in, in.uv, is_front);
    // Lips and cheeks let less light through to the back; a guess that stands in for shadows.
    surface.occlusion *= mix(1.0, 0.45, smoothstep(0.05, 0.8, in.depth));
    let lit = lit_surface(surface);
    return target_color(surface.color * lit.diffuse + lit.specular, 1.0);
}
