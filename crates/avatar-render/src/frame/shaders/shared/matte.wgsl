// How parts that are not skin scatter light.

fn shadow_point(surface: Surface, lamp: u32) -> vec3f {
    return surface.position;
}

fn diffuse_of(surface: Surface, lamp: u32, visibility: f32) -> vec3f {
    let n_dot_l = dot(surface.normal, frame.lamps[lamp].direction_world);
    return visibility * wrapped_diffuse(n_dot_l, material.wrap);
}
