// Surfaces of interchange files, drawn.

fn ambient_from(direction: vec3f) -> vec3f {
    return irradiance_at(direction);
}

fn lamp_seen(surface: Surface, lamp: u32) -> f32 {
    return lamp_visibility(lamp, surface.position, surface.smooth_normal);
}

// Flat tones have no highlights: metals are drawn in their colour as well.
fn reflected(surface: Surface, head_on: vec3f) -> vec3f {
    var drawn = surface;
    drawn.color = max(surface.color, head_on - DIELECTRIC);
    return toon_color(drawn);
}
