// Group 3: the looks of one part, shared by all avatars of a model.

struct Material {
    color: vec3f,
    opacity: f32,
    wrap: vec3f,
    reflectance: f32,
    roughness_matte: f32,
    roughness_glossy: f32,
    normal_strength: f32,
    // Which textures are there; the others are not sampled.
    textures: u32,
}

@group(3) @binding(0) var<uniform> material: Material;
@group(3) @binding(1) var color_texture: texture_2d<f32>;
@group(3) @binding(2) var occlusion_texture: texture_2d<f32>;
@group(3) @binding(3) var gloss_texture: texture_2d<f32>;
@group(3) @binding(4) var normal_texture: texture_2d<f32>;

// Everything about a visible point that light needs to know.
struct Surface {
    color: vec3f,
    opacity: f32,
    normal: vec3f,  // world, toward the viewer's side
    view: vec3f,    // world, toward the eye
    occlusion: f32,
    alpha: f32,     // squared roughness, the parameter of GGX
}

// Tangents from derivatives of position and uv: C. Schüler, "Followup: Normal Mapping Without Precomputed
// Tangents", 2013. The uv's v grows downward while the map's green points up, hence the sign.
fn mapped_normal(position: vec3f, uv: vec2f, normal: vec3f, texel: vec3f) -> vec3f {
    let position_dx = dpdx(position);
    let position_dy = dpdy(position);
    let uv_dx = dpdx(uv);
    let uv_dy = dpdy(uv);
    let across_x = cross(normal, position_dx);
    let across_y = cross(position_dy, normal);
    let tangent = across_y * uv_dx.x + across_x * uv_dy.x;
    let bitangent = -(across_y * uv_dx.y + across_x * uv_dy.y);
    let scale = inverseSqrt(max(max(dot(tangent, tangent), dot(bitangent, bitangent)), 1e-20));
    let tilt = (texel.xy * 2.0 - 1.0) * material.normal_strength;
    let height = max(texel.z * 2.0 - 1.0, 0.1);
    return normalize((tangent * tilt.x + bitangent * tilt.y) * scale + normal * height);
}

fn surface_at(in: VertexOut, is_front: bool) -> Surface {
    var surface: Surface;
    surface.view = normalize(frame.eye_world - in.position_world);
    // Parts are drawn from both sides where a back may show (the mouth, the rim of the neck).
    surface.normal = normalize(in.normal_world) * select(-1.0, 1.0, is_front);
    if (material.textures & NORMAL_TEXTURE) != 0u {
        let texel = textureSample(normal_texture, repeat_sampler, in.uv).xyz;
        surface.normal = mapped_normal(in.position_world, in.uv, surface.normal, texel);
    }
    surface.color = material.color;
    surface.opacity = material.opacity;
    if (material.textures & COLOR_TEXTURE) != 0u {
        let texel = textureSample(color_texture, repeat_sampler, in.uv);
        surface.color = mix(surface.color, texel.rgb, texel.a);
        surface.opacity = mix(surface.opacity, 1.0, texel.a);
    }
    surface.occlusion = 1.0;
    if (material.textures & OCCLUSION_TEXTURE) != 0u {
        surface.occlusion = textureSample(occlusion_texture, repeat_sampler, in.uv).r;
    }
    var gloss = 0.5;
    if (material.textures & GLOSS_TEXTURE) != 0u {
        gloss = textureSample(gloss_texture, repeat_sampler, in.uv).r;
    }
    let roughness = mix(material.roughness_matte, material.roughness_glossy, gloss);
    surface.alpha = roughness * roughness;
    return surface;
}
