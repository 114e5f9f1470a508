// A visible point, as lighting needs it.

struct Surface {
    position: vec3f,
    color: vec3f,
    opacity: f32,
    normal: vec3f,  // world, toward the viewer's side
    smooth_normal: vec3f, // the same without the relief of textures
    view: vec3f,    // world, toward the eye
    occlusion: f32,
    alpha: f32,     // squared roughness, the parameter of GGX
    curvature: f32,
    thickness: f32, // through the part from behind, in the world; large where unknown
}

// The tangent frame from derivatives of position and uv: C. Schüler, "Followup: Normal Mapping Without
// Precomputed Tangents", 2013. The uv's v grows downward while the map's green points up, hence the sign.
// Rows of pixels go downward, too, which turns both vectors around: the tangent points to smaller u, the
// bitangent to larger v.
struct Tangents {
    tangent: vec3f,
    bitangent: vec3f,
}

fn tangents_at(position: vec3f, uv: vec2f, normal: vec3f) -> Tangents {
    let position_dx = dpdx(position);
    let position_dy = dpdy(position);
    let uv_dx = dpdx(uv);
    let uv_dy = dpdy(uv);
    let across_x = cross(normal, position_dx);
    let across_y = cross(position_dy, normal);
    let tangent = across_y * uv_dx.x + across_x * uv_dy.x;
    let bitangent = -(across_y * uv_dx.y + across_x * uv_dy.y);
    let scale = inverseSqrt(max(max(dot(tangent, tangent), dot(bitangent, bitangent)), 1e-20));
    return Tangents(tangent * scale, bitangent * scale);
}

fn tilted(tangents: Tangents, normal: vec3f, tilt: vec2f, height: f32) -> vec3f {
    return normalize(tangents.tangent * tilt.x + tangents.bitangent * tilt.y + normal * height);
}

// The relief of the pack's texture, and pores where the picture is near enough to show them: one repetition
// of the tile must cover some pixels, otherwise it would only flicker.
fn relief_normal(position: vec3f, uv: vec2f, normal: vec3f) -> vec3f {
    let has_map = (material.textures & NORMAL_TEXTURE) != 0u;
    let has_pores = PORES && material.pore_strength > 0.0;
    if !has_map && !has_pores {
        return normal;
    }
    let tangents = tangents_at(position, uv, normal);
    var tilt = vec2f(0.0);
    var height = 1.0;
    if has_map {
        let texel = textureSample(normal_texture, normal_sampler, uv).xyz;
        tilt = (texel.xy * 2.0 - 1.0) * material.normal_strength;
        // As the standard has it; the relief of packs is made for the tangents above.
        tilt *= select(1.0, -1.0, (material.textures & FROM_FILE) != 0u);
        height = max(texel.z * 2.0 - 1.0, 0.1);
    }
    if has_pores {
        let at = uv * material.pore_density;
        let footprint = max(length(dpdx(at)), length(dpdy(at))) * PORE_CELLS;
        let near = 1.0 - smoothstep(0.15, 0.5, footprint);
        // Where the texture is stretched far beyond its mean, pores would be as large as dents.
        let stretch = length(dpdx(at)) + length(dpdy(at));
        let here = (length(dpdx(position)) + length(dpdy(position))) * material.pores_per_length;
        let ratio = stretch / max(here, 1e-9);
        let even = smoothstep(0.25, 0.6, ratio) * (1.0 - smoothstep(1.7, 4.0, ratio));
        let texel = textureSample(pores, repeat_sampler, at).xy * 2.0 - 1.0;
        tilt += texel * material.pore_strength * near * even;
    }
    return tilted(tangents, normal, tilt, height);
}

// Colour and opacity of a part of a face: the texture of a pack lies over the material's own colour, that
// of an interchange file is multiplied by it.
fn part_color(uv: vec2f) -> vec4f {
    if (material.textures & COLOR_TEXTURE) == 0u {
        return bare_color();
    }
    return painted_color(uv, textureSample(color_texture, color_sampler, uv));
}

fn bare_color() -> vec4f {
    return vec4f(toned(material.color), material.opacity);
}

fn painted_color(uv: vec2f, texel: vec4f) -> vec4f {
    let below = vec4f(material.color, material.opacity);
    let is_from_file = (material.textures & FROM_FILE) != 0u;
    let color = select(mix(below, vec4f(texel.rgb, 1.0), texel.a), below * texel, is_from_file);
    return vec4f(iris_colored(toned(color.rgb), uv), color.a);
}

fn surface_at(in: VertexOut, uv: vec2f, is_front: bool) -> Surface {
    return surface_of(in, uv, part_color(uv), is_front);
}

fn surface_of(in: VertexOut, uv: vec2f, color: vec4f, is_front: bool) -> Surface {
    var surface: Surface;
    surface.position = in.position_world;
    surface.view = normalize(frame.eye_world - in.position_world);
    // Parts are drawn from both sides where a back may show (the mouth, the rim of the neck).
    surface.smooth_normal = normalize(in.normal_world) * select(-1.0, 1.0, is_front);
    let relief = relief_normal(in.position_world, uv, surface.smooth_normal);
    let groove = groove_at(in.position_world, uv, surface.smooth_normal, relief, in.wrinkled);
    surface.normal = groove.normal;
    surface.color = color.rgb * mix(vec3f(1.0), GROOVE_COLOR, groove.depth);
    surface.opacity = color.a;
    surface.occlusion = 1.0;
    if (material.textures & OCCLUSION_TEXTURE) != 0u {
        surface.occlusion = textureSample(occlusion_texture, occlusion_sampler, uv).r;
        if (material.textures & FROM_FILE) != 0u {
            surface.occlusion = mix(1.0, surface.occlusion, material.occlusion_strength);
        }
    }
    surface.occlusion *= 1.0 - GROOVE_SHADE * groove.depth;
    var gloss = 0.5;
    if (material.textures & GLOSS_TEXTURE) != 0u {
        gloss = textureSample(gloss_texture, gloss_sampler, uv).r;
    }
    let roughness = max(mix(material.roughness_matte, material.roughness_glossy, gloss), MIN_ROUGHNESS);
    surface.alpha = roughness * roughness;
    surface.curvature = in.curvature;
    surface.thickness = 0.0;
    if TRANSMISSION && (material.textures & THICKNESS_TEXTURE) != 0u {
        surface.thickness = material.thickness * textureSample(thickness_texture, thickness_sampler, uv).r;
    }
    return surface;
}
