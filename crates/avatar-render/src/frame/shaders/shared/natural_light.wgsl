// Light on a surface: the environment, and three lamps with shadows. Each kind of part defines `diffuse_of`,
// which says how it scatters, and `shadow_point`, the point from which a lamp must be seen.

struct Lit {
    diffuse: vec3f,
    specular: vec3f,
}

// One or two lobes. Two follow measurements of skin: T. Weyrich et al., "Analysis of Human Faces Using a
// Measurement- Based Skin Reflectance Model", 2006.
fn lamp_specular(surface: Surface, direction: vec3f) -> f32 {
    let broad =
        specular_lobe(surface.normal, surface.view, direction, material.reflectance, surface.alpha);
    if SHARP_LOBE && material.sharp_share > 0.0 {
        let sharp_roughness = max(sqrt(surface.alpha) * material.sharp_roughness, MIN_ROUGHNESS);
        let alpha = sharp_roughness * sharp_roughness;
        let sharp = specular_lobe(surface.normal, surface.view, direction, material.reflectance, alpha);
        return mix(broad, sharp, material.sharp_share);
    }
    return broad;
}

// The share of light from all directions that the lobes reflect.
fn lobes_albedo(roughness: f32, n_dot_v: f32) -> f32 {
    let broad = directional_albedo(material.reflectance, roughness, n_dot_v);
    if SHARP_LOBE && material.sharp_share > 0.0 {
        let sharp =
            directional_albedo(material.reflectance, roughness * material.sharp_roughness, n_dot_v);
        return mix(broad, sharp, material.sharp_share);
    }
    return broad;
}

fn environment_specular(surface: Surface, n_dot_v: f32) -> vec3f {
    let roughness = sqrt(surface.alpha);
    let direction = reflect(-surface.view, surface.normal);
    let seen = specular_occlusion(n_dot_v, surface.occlusion, roughness);
    var light = reflection_at(direction, roughness)
        * directional_albedo(material.reflectance, roughness, n_dot_v);
    if SHARP_LOBE && REFLECTIONS && material.sharp_share > 0.0 {
        let sharp = roughness * material.sharp_roughness;
        let narrow = reflection_at(direction, sharp)
            * directional_albedo(material.reflectance, sharp, n_dot_v);
        light = mix(light, narrow, material.sharp_share);
    }
    return light * seen;
}

// What arrives below the surface and what its lobes reflect.
fn arriving_light(surface: Surface) -> Lit {
    let n_dot_v = clamp(dot(surface.normal, surface.view), 1e-3, 1.0);
    var lit: Lit;
    lit.diffuse = irradiance_at(surface.normal) * colored_occlusion(surface.occlusion, surface.color);
    lit.specular = environment_specular(surface, n_dot_v);
    for (var i = 0u; i < LAMP_COUNT; i++) {
        let lamp = frame.lamps[i];
        let visibility = lamp_visibility(i, shadow_point(surface, i), surface.smooth_normal);
        lit.diffuse += lamp.radiance * diffuse_of(surface, i, visibility);
        lit.specular += lamp.radiance * visibility * lamp_specular(surface, lamp.direction_world);
    }
    return lit;
}

// The share of light that gets below the lobes.
fn below_lobes(surface: Surface) -> f32 {
    let n_dot_v = clamp(dot(surface.normal, surface.view), 1e-3, 1.0);
    return 1.0 - lobes_albedo(sqrt(surface.alpha), n_dot_v);
}

// Everything that leaves the surface, the diffuse share before its colour.
fn lit_surface(surface: Surface) -> Lit {
    let arriving = arriving_light(surface);
    return Lit(arriving.diffuse * below_lobes(surface), arriving.specular);
}

// Water: refractive index 1.33.
const FILM_REFLECTANCE: f32 = 0.02;

// A clear, wet film on top: sharp reflections, and what they take is missing below.
fn under_film(surface: Surface, lit: Lit, film: f32) -> Lit {
    if film <= 0.0 {
        return lit;
    }
    let n_dot_v = clamp(dot(surface.smooth_normal, surface.view), 1e-3, 1.0);
    let direction = reflect(-surface.view, surface.smooth_normal);
    let roughness = max(material.film_roughness, MIN_ROUGHNESS);
    let albedo = directional_albedo(FILM_REFLECTANCE, roughness, n_dot_v);
    let seen = specular_occlusion(n_dot_v, surface.occlusion, roughness);
    var wet = reflection_at(direction, roughness) * albedo * seen;
    for (var i = 0u; i < LAMP_COUNT; i++) {
        let lamp = frame.lamps[i];
        let lobe = specular_lobe(
            surface.smooth_normal, surface.view, lamp.direction_world, FILM_REFLECTANCE,
            roughness * roughness);
        if lobe > 0.0 {
            wet += lamp.radiance * lobe
                * lamp_visibility(i, surface.position, surface.smooth_normal);
        }
    }
    return Lit(lit.diffuse * (1.0 - film * albedo), lit.specular * (1.0 - film) + film * wet);
}
