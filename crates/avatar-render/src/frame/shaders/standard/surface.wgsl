// Surfaces of interchange files: from the base colour to the colour of the target, in any style. The style
// defines `reflected`, which lights a surface of one lobe; `ambient_from`, the ambient light from around a
// direction; and `lamp_seen`, the share of a lamp's light that arrives.

// The picture in the slot of gloss: roughness in green, metalness in blue; of a cartoon its colour in the
// shade. The picture in the slot of thickness: light that the surface gives off.
fn standard_surface(in: StandardOut, base: vec3f, is_front: bool) -> Surface {
    var surface: Surface;
    surface.position = in.position_world;
    surface.view = normalize(frame.eye_world - in.position_world);
    surface.smooth_normal = normalize(in.normal_world) * select(-1.0, 1.0, is_front);
    surface.normal = surface.smooth_normal;
    if (material.textures & NORMAL_TEXTURE) != 0u {
        let uv = uv_of(in, NORMAL_TEXTURE);
        let tangents = tangents_at(in.position_world, uv, surface.smooth_normal);
        let texel = textureSample(normal_texture, normal_sampler, uv).xyz * 2.0 - 1.0;
        let tilt = -texel.xy * material.normal_strength;
        surface.normal = tilted(tangents, surface.smooth_normal, tilt, max(texel.z, 0.1));
    }
    surface.color = base;
    surface.opacity = 1.0;
    surface.occlusion = 1.0;
    if (material.textures & OCCLUSION_TEXTURE) != 0u {
        let texel = textureSample(occlusion_texture, occlusion_sampler, uv_of(in, OCCLUSION_TEXTURE)).r;
        surface.occlusion = mix(1.0, texel, material.occlusion_strength);
    }
    return surface;
}

// Dielectrics reflect 4 % head on, metals their colour, and nothing below it: glTF 2.0, section 3.9.2.
const DIELECTRIC: f32 = 0.04;

fn lit_color(in: StandardOut, base: vec3f, is_front: bool, seen: f32) -> vec3f {
    var surface = standard_surface(in, base, is_front);
    surface.occlusion *= seen;
    var roughness = material.roughness_matte;
    var metallic = material.metallic;
    if (material.textures & METALLIC_ROUGHNESS_TEXTURE) != 0u {
        let uv = uv_of(in, METALLIC_ROUGHNESS_TEXTURE);
        let texel = textureSample(gloss_texture, gloss_sampler, uv);
        roughness *= texel.g;
        metallic *= texel.b;
    }
    roughness = max(roughness, MIN_ROUGHNESS);
    surface.alpha = roughness * roughness;
    surface.color = base * (1.0 - metallic);
    return reflected(surface, mix(vec3f(DIELECTRIC), base, metallic));
}

// The light of one lobe that reflects `head_on` of what comes from the front.
fn colored_lobe(surface: Surface, head_on: vec3f, direction: vec3f) -> vec3f {
    let white = specular_lobe(surface.normal, surface.view, direction, 1.0, surface.alpha);
    let half_way = normalize(direction + surface.view);
    return white * mix(head_on, vec3f(1.0), schlick_fresnel(0.0, dot(surface.view, half_way)));
}

// The share of the lit colour for a cosine between normal and lamp: VRMC_materials_mtoon 1.0, "Lighting".
fn cartoon_share(cosine: f32) -> f32 {
    let half_width = 1.0 - material.shading_toony;
    return saturate((cosine + material.shading_shift + half_width) / max(2.0 * half_width, 1e-4));
}

// What a drawn colour shows of lamps and of ambient light, as in the style toon.
const CARTOON_LAMPS: f32 = 0.85;
const CARTOON_AMBIENT: f32 = 0.55;

fn cartoon_color(in: StandardOut, base: vec3f, is_front: bool) -> vec3f {
    let surface = standard_surface(in, base, is_front);
    var shade = material.shade_color;
    if (material.textures & SHADE_TEXTURE) != 0u {
        shade *= textureSample(gloss_texture, gloss_sampler, uv_of(in, SHADE_TEXTURE)).rgb;
    }
    // Flat: from above and below alike, whichever way the surface faces.
    let around = ambient_from(vec3f(0.0, 1.0, 0.0)) + ambient_from(vec3f(0.0, -1.0, 0.0));
    var color = base * around * (0.5 * CARTOON_AMBIENT);
    for (var i = 0u; i < LAMP_COUNT; i++) {
        let lamp = frame.lamps[i];
        let share = cartoon_share(dot(surface.normal, lamp.direction_world));
        // Soft shadows are cut in the middle.
        let lit = share * smoothstep(0.4, 0.6, lamp_seen(surface, i));
        // Only the key has a shade: the others would lighten it.
        let drawn = mix(select(vec3f(0.0), shade, i == KEY_LAMP), base, lit);
        color += lamp.radiance * drawn * CARTOON_LAMPS;
    }
    return color;
}

// The colour of the target, as if opaque. `seen` is the share of ambient light that other parts leave.
fn standard_color(in: StandardOut, base: vec3f, is_front: bool, seen: f32) -> vec3f {
    if (material.textures & UNLIT) != 0u {
        // As it is: neither exposure nor tone mapping.
        if ENCODE_SRGB {
            return srgb_from_linear(base);
        }
        return base;
    }
    var light: vec3f;
    if (material.textures & CARTOON) != 0u {
        light = cartoon_color(in, base, is_front);
    } else {
        light = lit_color(in, base, is_front, seen);
    }
    var emitted = material.emissive;
    if (material.textures & EMISSIVE_TEXTURE) != 0u {
        emitted *= textureSample(thickness_texture, thickness_sampler, uv_of(in, EMISSIVE_TEXTURE)).rgb;
    }
    return target_color(light + emitted, 1.0).rgb;
}
