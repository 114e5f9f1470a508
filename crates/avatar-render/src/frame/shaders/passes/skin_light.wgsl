// Diffuse light that arrives at the skin, before its colour, one sample per pixel; alpha tells where skin is.
// The target holds f16, so that light is multiplied by the pre-exposure.

const LARGEST_HALF: f32 = 65504.0;

@fragment
fn skin_light_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    var surface = surface_at(in, in.uv, is_front);
    surface.occlusion = min(surface.occlusion, view_occlusion(in.position_clip));
    // What the lobes reflect is taken away where light leaves the skin, after it has spread.
    let light = arriving_light(surface).diffuse * frame.pre_exposure;
    return vec4f(min(light, vec3f(LARGEST_HALF)), 1.0);
}
