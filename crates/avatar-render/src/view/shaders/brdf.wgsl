// How surfaces reflect. Everything is multiplied by pi, because a lamp of radiance 1 lights a white matte
// surface to 1. The twins on the CPU are avatar_look::optics.

// Below this the peak of GGX is narrower than f32 resolves near its middle.
const MIN_ROUGHNESS: f32 = 0.045;

// GGX: B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, eq. 33.
fn ggx_distribution_pi(n_dot_h: f32, alpha: f32) -> f32 {
    let alpha2 = alpha * alpha;
    let f = (n_dot_h * alpha2 - n_dot_h) * n_dot_h + 1.0;
    return alpha2 / (f * f);
}

// Height-correlated Smith masking over 4 NoL NoV, with Hammon's approximation: E. Hammon, "PBR Diffuse
// Lighting for GGX+Smith Microsurfaces", 2017. The epsilon keeps the grazing silhouette finite.
fn smith_visibility(n_dot_v: f32, n_dot_l: f32, alpha: f32) -> f32 {
    return 0.5 / max(mix(2.0 * n_dot_l * n_dot_v, n_dot_l + n_dot_v, alpha), 1e-4);
}

// C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994.
fn schlick_fresnel(reflectance: f32, cosine: f32) -> f32 {
    let f = 1.0 - saturate(cosine);
    let f2 = f * f;
    return reflectance + (1.0 - reflectance) * f2 * f2 * f;
}

// The light of a lamp of radiance 1 that one lobe reflects.
fn specular_lobe(normal: vec3f, view: vec3f, direction: vec3f, reflectance: f32, alpha: f32) -> f32 {
    let n_dot_l = dot(normal, direction);
    if n_dot_l <= 0.0 {
        return 0.0;
    }
    let n_dot_v = clamp(dot(normal, view), 1e-3, 1.0);
    let half_way = normalize(direction + view);
    let fresnel = schlick_fresnel(reflectance, dot(view, half_way));
    return fresnel * ggx_distribution_pi(saturate(dot(normal, half_way)), alpha)
        * smith_visibility(n_dot_v, n_dot_l, alpha) * n_dot_l;
}

// Wrapped diffuse that reflects no more than it receives: S. McAuley, "Energy-Conserving Wrapped
// Diffuse". A wrap per channel gives skin its warm edge of shadow (S. Green, GPU Gems, chapter 16, 2004).
fn wrapped_diffuse(n_dot_l: f32, wrap: vec3f) -> vec3f {
    let reach = 1.0 + wrap;
    return max((vec3f(n_dot_l) + wrap) / (reach * reach), vec3f(0.0));
}

// Scale and bias of the reflectance over all directions of light, B. Karis, "Physically Based Shading on
// Mobile", 2014: a fit of the split sum.
fn split_sum_fit(roughness: f32, n_dot_v: f32) -> vec2f {
    let r = roughness * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let a004 = min(r.x * r.x, exp2(-9.28 * n_dot_v)) * r.x + r.y;
    return vec2f(-1.04, 1.04) * a004 + r.zw;
}
