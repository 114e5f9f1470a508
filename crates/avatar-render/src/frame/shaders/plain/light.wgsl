// Plain light: three lamps without shadows, wrapped diffuse, one lobe, ambient light from above and below.
// The baseline that everything else is measured against.

struct Lit {
    diffuse: vec3f,
    specular: vec3f,
}

// Ambient light from above and below: C. Lieberman et al., hemisphere lighting, DirectX SDK 2003.
fn hemisphere(direction: vec3f) -> vec3f {
    return mix(frame.ground, frame.sky, 0.5 + 0.5 * direction.y);
}

// Where little ambient light arrives, lamps are hidden as well: D. Chan, "Material Advances in Call of Duty:
// WWII", 2018. The aperture is twice that of the paper: baked occlusion holds folds and hollows, not only
// pores, and would stain lit skin.
fn micro_shadow(occlusion: f32, n_dot_l: f32) -> f32 {
    return saturate(max(n_dot_l, 0.0) + 4.0 * occlusion * occlusion - 1.0);
}

fn lit_surface(surface: Surface) -> Lit {
    let n_dot_v = clamp(dot(surface.normal, surface.view), 1e-3, 1.0);
    var lit: Lit;
    lit.diffuse = hemisphere(surface.normal) * surface.occlusion;
    let reflected = hemisphere(reflect(-surface.view, surface.normal));
    let split_sum = split_sum_fit(sqrt(surface.alpha), n_dot_v);
    lit.specular = reflected * surface.occlusion * (material.reflectance * split_sum.x + split_sum.y);
    for (var i = 0u; i < LAMP_COUNT; i++) {
        let lamp = frame.lamps[i];
        let n_dot_l = dot(surface.normal, lamp.direction_world);
        let light = lamp.radiance * micro_shadow(surface.occlusion, n_dot_l);
        lit.diffuse += light * wrapped_diffuse(n_dot_l, material.wrap);
        lit.specular += light * specular_lobe(
            surface.normal, surface.view, lamp.direction_world, material.reflectance, surface.alpha);
    }
    return lit;
}
