// Diffuse light that arrives at the skin, before its colour, one sample a pixel; alpha tells where skin is.

@fragment
fn skin_light_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    var surface = surface_at(in, in.uv, is_front);
    surface.occlusion = min(surface.occlusion, view_occlusion(in.position_clip));
    // The lobes take their share where light leaves: a bright middle must not spread what the rim has reflected.
    return vec4f(arriving_light(surface).diffuse, 1.0);
}
