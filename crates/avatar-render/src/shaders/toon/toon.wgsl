// Flat tones of light, as drawn: A. Lake et al., "Stylized Rendering Techniques for Scalable Real-Time 3D Animation",
// 2000. Colours are those of the pack; lines come from the outline pass.

// A soft step, one pixel wide: tones without jagged edges.
fn band(value: f32, edge: f32) -> f32 {
    let width = max(fwidth(value), 1e-4);
    return smoothstep(edge - width, edge + width, value);
}

// Shade, light, and a third tone where the surface turns away from the viewer on the side of the rim lamp.
fn toon_color(surface: Surface) -> vec3f {
    let key = frame.lamps[KEY_LAMP];
    let rim = frame.lamps[RIM_LAMP];
    let n_dot_l = dot(surface.smooth_normal, key.direction_world);
    // The edge of a cast shadow is soft in the map: cut in its middle. Where the lamp grazes, the map is coarse, and
    // the surface's own shade has begun already.
    let unhidden = smoothstep(0.4, 0.6, lamp_visibility(KEY_LAMP, surface.position, surface.smooth_normal));
    let light = band(n_dot_l, 0.12) * mix(1.0, unhidden, smoothstep(0.12, 0.3, n_dot_l));
    let ambient = irradiance_at(vec3f(0.0, 0.0, 1.0)) * 0.55 + vec3f(0.10, 0.08, 0.14);
    let folds = 0.7 + 0.3 * band(surface.occlusion, 0.45);
    let turned = 1.0 - saturate(dot(surface.smooth_normal, surface.view));
    let edge = band(turned, 0.7) * band(dot(surface.smooth_normal, rim.direction_world), 0.1);
    return surface.color * (ambient + key.radiance * light * 0.85) * folds + rim.radiance * edge * 0.5;
}
