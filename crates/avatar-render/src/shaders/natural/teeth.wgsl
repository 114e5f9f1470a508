// Teeth, gums and tongue: translucent, wet, and darker toward the back of the mouth.

@fragment
fn teeth_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    var surface = surface_at(in, in.uv, is_front);
    // Lips and cheeks let less and less light through to the back, of the lamps as well.
    let left = mix(1.0, material.back_light, smoothstep(0.02, 0.6, in.depth));
    surface.occlusion *= left * view_occlusion(in.position_clip);
    var lit = lit_surface(surface);
    lit = under_film(surface, lit, material.wetness);
    return target_color((surface.color * lit.diffuse + lit.specular) * left, 1.0);
}
