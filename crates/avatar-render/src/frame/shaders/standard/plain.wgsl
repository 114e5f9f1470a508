// Plain light on surfaces of interchange files.

fn ambient_from(direction: vec3f) -> vec3f {
    return hemisphere(direction);
}

fn lamp_seen(surface: Surface, lamp: u32) -> f32 {
    return 1.0;
}

fn reflected(surface: Surface, head_on: vec3f) -> vec3f {
    let n_dot_v = clamp(dot(surface.normal, surface.view), 1e-3, 1.0);
    let split_sum = split_sum_fit(sqrt(surface.alpha), n_dot_v);
    var diffuse = hemisphere(surface.normal) * surface.occlusion;
    var specular = hemisphere(reflect(-surface.view, surface.normal)) * surface.occlusion
        * (head_on * split_sum.x + split_sum.y);
    for (var i = 0u; i < LAMP_COUNT; i++) {
        let lamp = frame.lamps[i];
        let n_dot_l = dot(surface.normal, lamp.direction_world);
        let light = lamp.radiance * micro_shadow(surface.occlusion, n_dot_l);
        diffuse += light * saturate(n_dot_l);
        specular += light * colored_lobe(surface, head_on, lamp.direction_world);
    }
    return surface.color * diffuse + specular;
}
