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
    tuck: f32,
}

struct Hair {
    regions: array<HairRegion, REGION_COUNT>,
    field_origin: vec3f,
    field_cell: f32,
    field_size: vec3u,
    margin: f32,
    // 1 / (the height above the skin up to which hair is combed) and 1 / (the distance up to which strands
    // are drawn to their guide).
    per_combed_reach: f32,
    per_lock_reach: f32,
    strand_count: u32,
    // Fewer strands are wider, so that they cover as much.
    width_factor: f32,
    // The largest distance of the field.
    field_range: f32,
    // Cells per unit.
    field_cells: f32,
}

// A root is four texels of a texture, as all lists are that are read strand by strand: software adapters read
// textures several times faster than buffers.
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

// The texel of an element of a list.
fn texel_of(index: u32) -> vec2u {
    return vec2u(index % VEC4S_PER_ROW, index / VEC4S_PER_ROW);
}
