// Draws how much of the key's light strands block; hair_shadow.wgsl reads it.

struct ShadowStrandOut {
    @builtin(position) position_clip: vec4f,
    // The share of a texel that the strand covers; 0 where something else shades the strand, so that hair
    // behind the head does not count for what lies in front of it.
    @location(0) cover: f32,
}

@vertex
fn hair_shadow_main(
    @builtin(vertex_index) corner: u32,
    @builtin(instance_index) strand: u32,
) -> ShadowStrandOut {
    let point = strand_point(strand, corner, kind_of(strand));
    // Strands thinner than two texels are drawn that wide and cover less: otherwise the map would have steps.
    let texels = 2.0 * point.radius / hair_map_texel();
    let drawn = max(texels, 2.0);
    let side = strand_side(point.tangent, frame.lamps[KEY_LAMP].direction_world) * corner_sign(corner);
    let position = point.position + side * (0.5 * drawn * hair_map_texel());
    let lifted = point.position + point.normal * hair.margin * 3.0;
    var out: ShadowStrandOut;
    out.position_clip = vec4f(hair_map_place(position), 1.0);
    out.cover = texels / drawn * strand_visibility(KEY_LAMP, lifted, point.normal);
    return out;
}

@fragment
fn hair_shadow_fragment_main(in: ShadowStrandOut) -> @location(0) vec4f {
    let depth = in.position_clip.z;
    // Blending keeps the largest alpha.
    return vec4f(in.cover, in.cover * depth, 0.0, select(0.0, 1.0 - depth, in.cover > 0.0));
}
