// Light on a surface, split into what leaves it diffusely (before its colour) and specularly.

struct Lit {
    diffuse: vec3f,
    specular: vec3f,
}

// GGX: B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, eq. 33, times pi because
// lamps are measured by what a white surface reflects.
fn ggx_distribution_pi(n_dot_h: f32, alpha: f32) -> f32 {
    let alpha2 = alpha * alpha;
    let f = (n_dot_h * alpha2 - n_dot_h) * n_dot_h + 1.0;
    return alpha2 / (f * f);
}

// Height-correlated Smith masking over 4 NoL NoV, with Hammon's approximation: E. Hammon, "PBR Diffuse Lighting for
// GGX+Smith Microsurfaces", 2017. The epsilon keeps the grazing silhouette finite.
fn smith_visibility(n_dot_v: f32, n_dot_l: f32, alpha: f32) -> f32 {
    return 0.5 / max(mix(2.0 * n_dot_l * n_dot_v, n_dot_l + n_dot_v, alpha), 1e-4);
}

// C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994.
fn schlick_fresnel(reflectance: f32, cosine: f32) -> f32 {
    let f = 1.0 - saturate(cosine);
    let f2 = f * f;
    return reflectance + (1.0 - reflectance) * f2 * f2 * f;
}

// Wrapped diffuse that reflects no more than it receives: S. McAuley, "Extension to Energy-Conserving Wrapped
// Diffuse", 2011. A wrap per channel gives skin its warm edge of shadow (S. Green, GPU Gems, chapter 16, 2004).
fn wrapped_diffuse(n_dot_l: f32, wrap: vec3f) -> vec3f {
    let reach = 1.0 + wrap;
    return max((vec3f(n_dot_l) + wrap) / (reach * reach), vec3f(0.0));
}

// Ambient light from above and below: C. Lieberman et al., hemisphere lighting, DirectX SDK 2003.
fn hemisphere(direction: vec3f) -> vec3f {
    return mix(frame.ground, frame.sky, 0.5 + 0.5 * direction.y);
}

// Reflection of the ambient light: B. Karis, "Physically Based Shading on Mobile", 2014 (fit of the split sum).
fn ambient_reflectance(reflectance: f32, roughness: f32, n_dot_v: f32) -> f32 {
    let r = roughness * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let a004 = min(r.x * r.x, exp2(-9.28 * n_dot_v)) * r.x + r.y;
    let scale_bias = vec2f(-1.04, 1.04) * a004 + r.zw;
    return reflectance * scale_bias.x + scale_bias.y;
}

fn lamp_specular(surface: Surface, direction: vec3f, n_dot_l: f32, n_dot_v: f32) -> f32 {
    let half_way = normalize(direction + surface.view);
    let n_dot_h = saturate(dot(surface.normal, half_way));
    let fresnel = schlick_fresnel(material.reflectance, dot(surface.view, half_way));
    return fresnel * ggx_distribution_pi(n_dot_h, surface.alpha)
        * smith_visibility(n_dot_v, n_dot_l, surface.alpha) * n_dot_l;
}

// Where little ambient light arrives, lamps are hidden as well: D. Chan, "Material Advances in Call of Duty: WWII", 2018.
// Twice his aperture: baked occlusion tells of folds and hollows, not only of his pores, and would stain lit skin.
fn micro_shadow(occlusion: f32, n_dot_l: f32) -> f32 {
    return saturate(max(n_dot_l, 0.0) + 4.0 * occlusion * occlusion - 1.0);
}

fn lit_surface(surface: Surface) -> Lit {
    let n_dot_v = clamp(dot(surface.normal, surface.view), 1e-3, 1.0);
    var lit: Lit;
    lit.diffuse = hemisphere(surface.normal) * surface.occlusion;
    let reflected = hemisphere(reflect(-surface.view, surface.normal));
    lit.specular = reflected * surface.occlusion
        * ambient_reflectance(material.reflectance, sqrt(surface.alpha), n_dot_v);
    for (var i = 0u; i < LAMP_COUNT; i++) {
        let lamp = frame.lamps[i];
        let n_dot_l = dot(surface.normal, lamp.direction_world);
        let light = lamp.radiance * micro_shadow(surface.occlusion, n_dot_l);
        lit.diffuse += light * wrapped_diffuse(n_dot_l, material.wrap);
        if n_dot_l > 0.0 {
            lit.specular += light * lamp_specular(surface, lamp.direction_world, n_dot_l, n_dot_v);
        }
    }
    return lit;
}
