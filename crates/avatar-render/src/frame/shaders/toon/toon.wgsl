// Flat tones of light, as drawn: A. Lake et al., "Stylized Rendering Techniques for Scalable Real-Time 3D
// Animation", 2000. Colours are those of the pack; lines come from the outline pass.

// A soft step, one pixel wide: tones without jagged edges.
fn band(value: f32, edge: f32) -> f32 {
    let width = max(fwidth(value), 1e-4);
    return smoothstep(edge - width, edge + width, value);
}

// The share of a tone that a lamp's cast shadow leaves. Shadows in the map have soft edges, which are cut in
// the middle. Where the lamp grazes the surface, below the cosine `begin`, the map is coarse, and the surface
// is in its own shade already.
fn unhidden(lamp: u32, surface: Surface, n_dot_l: f32, begin: f32) -> f32 {
    let seen = lamp_visibility(lamp, surface.position, surface.smooth_normal);
    return mix(1.0, smoothstep(0.4, 0.6, seen), smoothstep(begin, begin + 0.18, n_dot_l));
}

// Shade, light, and a third tone where the surface turns away from the viewer on the side of the rim lamp.
fn toon_color(surface: Surface) -> vec3f {
    let key = frame.lamps[KEY_LAMP];
    let rim = frame.lamps[RIM_LAMP];
    let n_dot_l = dot(surface.smooth_normal, key.direction_world);
    let light = band(n_dot_l, 0.12) * unhidden(KEY_LAMP, surface, n_dot_l, 0.12);
    let ambient = irradiance_at(vec3f(0.0, 0.0, 1.0)) * 0.55 + vec3f(0.10, 0.08, 0.14);
    let folds = 0.7 + 0.3 * band(surface.occlusion, 0.45);
    let turned = 1.0 - saturate(dot(surface.smooth_normal, surface.view));
    let n_dot_rim = dot(surface.smooth_normal, rim.direction_world);
    var edge = band(turned, 0.7) * band(n_dot_rim, 0.1);
    if edge > 0.0 {
        edge *= unhidden(RIM_LAMP, surface, n_dot_rim, 0.1);
    }
    return surface.color * (ambient + key.radiance * light * 0.85) * folds + rim.radiance * edge * 0.5;
}
