// Flat bands of light, as drawn: A. Lake et al., "Stylized Rendering Techniques for Scalable Real-Time 3D Animation",
// 2000. Colours are those of the pack; lines come from the outline pass.

// A soft step, one pixel wide: bands without jagged edges.
fn band(value: f32, edge: f32) -> f32 {
    let width = max(fwidth(value), 1e-4);
    return smoothstep(edge - width, edge + width, value);
}

fn toon_color(surface: Surface) -> vec3f {
    let key = frame.lamps[KEY_LAMP];
    let n_dot_l = dot(surface.smooth_normal, key.direction_world);
    let lit = min(n_dot_l, lamp_visibility(KEY_LAMP, surface.position, surface.smooth_normal) * 2.0 - 1.0);
    let light = band(lit, 0.02) * 0.65 + band(n_dot_l, 0.55) * 0.35;
    let ambient = irradiance_at(vec3f(0.0, 0.0, 1.0)) * 0.5 + vec3f(0.12, 0.1, 0.16);
    let folds = 0.6 + 0.4 * band(surface.occlusion, 0.5);
    let half_way = normalize(key.direction_world + surface.view);
    let gloss = band(dot(surface.smooth_normal, half_way), mix(0.999, 0.96, sqrt(surface.alpha))) * light;
    let color = surface.color * (ambient + key.radiance * light * 0.9) * folds;
    // A rim of light where the surface turns away from the viewer, on the lit side.
    let turned = 1.0 - saturate(dot(surface.smooth_normal, surface.view));
    let rim = band(turned, 0.72) * band(dot(surface.smooth_normal, frame.lamps[RIM_LAMP].direction_world), 0.1);
    return color + frame.lamps[RIM_LAMP].radiance * rim * 0.6 + key.radiance * gloss * material.reflectance * 3.0;
}
