// Teeth, gums and tongue: translucent, wet, and darker toward the back of the mouth.

// Ambient light in the mouth as a share of that before it: lips, gums and tongue reflect it, red most (the
// light between walls of a colour, J. Jimenez et al., 2016, as in colored_occlusion; teeth themselves are too
// pale to tell).
const MOUTH_LIGHT: vec3f = vec3f(1.0, 0.45, 0.28);
// The largest share of a tooth's surroundings that is open to the front; above and below it are lips.
const OPEN: f32 = 0.5;

@fragment
fn teeth_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    var surface = surface_at(in, in.uv, is_front);
    surface.occlusion *= view_occlusion(in.position_clip);
    var lit = lit_surface(surface);
    // Lips and cheeks let less and less light through to the back, of the lamps as well.
    let left = mix(1.0, material.back_light, smoothstep(0.02, 0.6, in.depth));
    let ambient = irradiance_at(surface.normal) * colored_occlusion(surface.occlusion, surface.color)
        * below_lobes(surface);
    // Where the back of the mouth is as bright as its front, there is no mouth around.
    let closed = (1.0 - material.back_light) * (1.0 - OPEN * left * surface.occlusion);
    lit.diffuse -= ambient * (1.0 - MOUTH_LIGHT) * closed;
    lit = under_film(surface, lit, material.wetness);
    return target_color((surface.color * lit.diffuse + lit.specular * left) * left, 1.0);
}
