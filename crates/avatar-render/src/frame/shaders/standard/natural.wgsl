// Natural light on surfaces of interchange files.

fn ambient_from(direction: vec3f) -> vec3f {
    return irradiance_at(direction);
}

fn lamp_seen(surface: Surface, lamp: u32) -> f32 {
    return lamp_visibility(lamp, surface.position, surface.smooth_normal);
}

fn reflected(surface: Surface, head_on: vec3f) -> vec3f {
    let n_dot_v = clamp(dot(surface.normal, surface.view), 1e-3, 1.0);
    let roughness = sqrt(surface.alpha);
    // What a lobe reflects of all light is linear in what it reflects head on.
    let least = directional_albedo(0.0, roughness, n_dot_v);
    let most = directional_albedo(1.0, roughness, n_dot_v);
    var diffuse = irradiance_at(surface.normal) * colored_occlusion(surface.occlusion, surface.color);
    let around = reflection_at(reflect(-surface.view, surface.normal), roughness);
    var specular = around * mix(vec3f(least), vec3f(most), head_on)
        * specular_occlusion(n_dot_v, surface.occlusion, roughness);
    for (var i = 0u; i < LAMP_COUNT; i++) {
        let lamp = frame.lamps[i];
        let light = lamp.radiance * lamp_seen(surface, i);
        diffuse += light * saturate(dot(surface.normal, lamp.direction_world));
        specular += light * colored_lobe(surface, head_on, lamp.direction_world);
    }
    return surface.color * diffuse * (1.0 - mix(least, most, DIELECTRIC)) + specular;
}
