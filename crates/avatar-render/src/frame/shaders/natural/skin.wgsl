// Skin: light that scatters below the surface, under two lobes of reflection.

@fragment
fn skin_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    var surface = surface_at(in, in.uv, is_front);
    surface.occlusion = min(surface.occlusion, view_occlusion(in.position_clip));
    if SCATTERING == SEPARABLE {
        // Earlier passes have lit the skin and spread the light sideways; what is left is to spread it
        // upward.
        let arrived = scattered_along(vec2i(0, 1), in.position_clip) / frame.pre_exposure;
        let diffuse = arrived * below_lobes(surface);
        return target_color(surface.color * diffuse + reflected_light(surface), 1.0);
    }
    let lit = lit_surface(surface);
    return target_color(surface.color * lit.diffuse + lit.specular, 1.0);
}

fn reflected_light(surface: Surface) -> vec3f {
    let n_dot_v = clamp(dot(surface.normal, surface.view), 1e-3, 1.0);
    var light = environment_specular(surface, n_dot_v);
    for (var i = 0u; i < LAMP_COUNT; i++) {
        let lamp = frame.lamps[i];
        let lobe = lamp_specular(surface, lamp.direction_world);
        if lobe > 0.0 {
            light += lamp.radiance * lobe
                * lamp_visibility(i, surface.position, surface.smooth_normal);
        }
    }
    return light;
}
