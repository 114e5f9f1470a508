// Surfaces of interchange files: what their vertices bring to a pixel, and the base colour there.

// Beside the position and normal that the deform pass wrote.
struct ExtraIn {
    @location(8) uv_1: vec2f,
    @location(9) color: vec4f,
}

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
    return standard_out(in, ExtraIn(vec2f(0.0), vec4f(1.0)));
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
        return color * textureSample(color_texture, repeat_sampler, uv_of(in, COLOR_TEXTURE));
    }
    return color;
}

// The samples that a surface with holes covers: one at most where a pixel has one sample. Where it has four,
// the edge of a hole is as wide as a pixel: B. Golus, "Anti-aliased Alpha Test", 2017. A cutoff of nearly 1
// asks for what is wholly opaque, and nothing beside it.
fn covered_samples(alpha: f32) -> u32 {
    let all = select(1u, 15u, COVERAGE_MASK && SAMPLED);
    let change = fwidth(alpha);
    let is_inside = alpha >= material.alpha_cutoff;
    if !COVERAGE_MASK || !SAMPLED || change < 1e-4 || material.alpha_cutoff > 0.997 {
        return select(0u, all, is_inside);
    }
    let count = u32(saturate((alpha - material.alpha_cutoff) / change + 0.5) * 4.0 + 0.5);
    // Samples that lie opposite to each other first.
    return (0xfd910u >> (4u * count)) & 15u;
}
