// Light from the environment.

// Diffuse light from spherical harmonics: R. Ramamoorthi and P. Hanrahan, "An Efficient Representation for
// Irradiance Environment Maps", 2001. The constants of the basis are folded into the coefficients.
fn irradiance_at(n: vec3f) -> vec3f {
    let c = frame.irradiance;
    return max(
        c[0] + c[1] * n.y + c[2] * n.z + c[3] * n.x
            + c[4] * (n.x * n.y) + c[5] * (n.y * n.z) + c[6] * (3.0 * n.z * n.z - 1.0)
            + c[7] * (n.x * n.z) + c[8] * (n.x * n.x - n.y * n.y),
        vec3f(0.0));
}

// The reflection of the environment by a surface of this roughness. Without REFLECTIONS, the diffuse light
// from that direction takes its place, which is what the roughest reflection shows.
fn reflection_at(direction: vec3f, roughness: f32) -> vec3f {
    if REFLECTIONS {
        return textureSampleLevel(reflections, clamp_sampler, direction, roughness * frame.reflection_levels).rgb;
    }
    return irradiance_at(direction);
}

// The share of light from all directions that is reflected: B. Karis, "Real Shading in Unreal Engine 4",
// 2013.
fn directional_albedo(reflectance: f32, roughness: f32, n_dot_v: f32) -> f32 {
    if REFLECTIONS {
        let split_sum = textureSampleLevel(split_sum_table, clamp_sampler, vec2f(n_dot_v, roughness), 0.0).xy;
        return reflectance * split_sum.x + split_sum.y;
    }
    let split_sum = split_sum_fit(roughness, n_dot_v);
    return saturate(reflectance * split_sum.x + split_sum.y);
}

// The share of reflections that is left where ambient light is occluded: S. Lagarde and C. de Rousiers,
// "Moving Frostbite to Physically Based Rendering", 2014.
fn specular_occlusion(n_dot_v: f32, occlusion: f32, roughness: f32) -> f32 {
    return saturate(pow(n_dot_v + occlusion, exp2(-16.0 * roughness - 1.0)) - 1.0 + occlusion);
}

// Light that bounces in a hollow takes on its colour: J. Jimenez et al., "Practical Real-Time Strategies for
// Accurate Indirect Occlusion", 2016.
fn colored_occlusion(occlusion: f32, albedo: vec3f) -> vec3f {
    let a = 2.0404 * albedo - 0.3324;
    let b = -4.7951 * albedo + 0.6417;
    let c = 2.7552 * albedo + 0.6903;
    return max(vec3f(occlusion), ((occlusion * a + b) * occlusion + c) * occlusion);
}
