// What growing and drawing hair share. Lengths are in the world's units.

struct HairRegion {
    root_color: vec3f,
    root_radius: f32,
    tip_color: vec3f,
    tip_radius: f32,
    color_variation: f32,
    bend: f32,
    gravity: f32,
    curl_radius: f32,
    // Cosine and sine of a curl's turn from point to point.
    curl_turn: vec2f,
    clump: f32,
    noise: f32,
    volume: f32,
    hold: f32,
}

struct Hair {
    regions: array<HairRegion, REGION_COUNT>,
    field_origin: vec3f,
    field_cell: f32,
    field_size: vec3u,
    margin: f32,
    combed_reach: f32,
    lock_reach: f32,
    // Bones beside the head's that move the skin.
    other_bones: vec2u,
    head_bone: u32,
    strand_count: u32,
    // Fewer strands are wider, so that they cover as much.
    width_factor: f32,
    // The largest distance of the field.
    field_range: f32,
}

struct Root {
    corners: vec3u,
    region: u32,
    barycentric: vec3f,
    // Number of the strand that it follows, or NO_GUIDE; IS_GUIDE if others follow it.
    guide: u32,
    comb: vec3f,
    length: f32,
    random: vec3f,
    // Where its curl begins, in radians.
    phase: f32,
}
