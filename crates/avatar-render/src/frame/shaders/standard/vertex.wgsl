// Surfaces of interchange files: what their vertices bring to a pixel, and the base colour there.

// Beside the position and normal that the deform pass wrote.
struct ExtraIn {
    @location(8) uv_1: vec2f,
    @location(9) color: vec4f,
}

const NO_EXTRA: ExtraIn = ExtraIn(vec2f(0.0), vec4f(1.0));

struct StandardOut {
    // Several passes compare depths of the same vertex.
    @invariant @builtin(position) position_clip: vec4f,
    @location(0) position_world: vec3f,
    @location(1) normal_world: vec3f,
    @location(2) uv: vec2f,
    @location(3) uv_1: vec2f,
    @location(4) color: vec4f,
}

fn standard_out(in: VertexIn, extra: ExtraIn) -> StandardOut {
    let out = vertex_out(in);
    return StandardOut(
        out.position_clip, out.position_world, out.normal_world, out.uv, extra.uv_1, extra.color);
}

@vertex
fn standard_main(in: VertexIn) -> StandardOut {
    return standard_out(in, NO_EXTRA);
}

@vertex
fn standard_extra_main(in: VertexIn, extra: ExtraIn) -> StandardOut {
    return standard_out(in, extra);
}

// The texture coordinates of a texture, by its bit.
fn uv_of(in: StandardOut, bit: u32) -> vec2f {
    return select(in.uv, in.uv_1, (material.second_uvs & bit) != 0u);
}

// Factor times texture times colour of the vertex: glTF 2.0, section 3.9.2.
fn base_color(in: StandardOut) -> vec4f {
    let color = vec4f(material.color, material.opacity) * in.color;
    if (material.textures & COLOR_TEXTURE) != 0u {
        return color * textureSample(color_texture, color_sampler, uv_of(in, COLOR_TEXTURE));
    }
    return color;
}

fn opacity_at(in: StandardOut, uv: vec2f) -> f32 {
    let opacity = material.opacity * in.color.a;
    if (material.textures & COLOR_TEXTURE) != 0u {
        return opacity * textureSample(color_texture, color_sampler, uv).a;
    }
    return opacity;
}

// Where four samples lie in a pixel: the standard places of Vulkan and Direct3D.
const SAMPLES = array<vec2f, 4>(
    vec2f(-0.125, -0.375), vec2f(0.375, -0.125), vec2f(-0.375, 0.125), vec2f(0.125, 0.375));

// The samples of a pixel at which a surface with holes is not below its cutoff.
fn covered_samples(in: StandardOut) -> u32 {
    let uv = uv_of(in, COLOR_TEXTURE);
    if !COVERAGE_MASK || !SAMPLED {
        return select(0u, 1u, opacity_at(in, uv) >= material.alpha_cutoff);
    }
    let across = dpdx(uv);
    let down = dpdy(uv);
    var places = SAMPLES;
    var covered = 0u;
    for (var i = 0u; i < 4u; i++) {
        let at = uv + across * places[i].x + down * places[i].y;
        covered |= select(0u, 1u << i, opacity_at(in, at) >= material.alpha_cutoff);
    }
    return covered;
}
