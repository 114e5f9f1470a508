// What growing and drawing hair share.

struct HairRegion {
    root_color: vec3f,
    length: f32,
    tip_color: vec3f,
    length_variation: f32,
    root_radius: f32,
    tip_radius: f32,
    color_variation: f32,
    bend: f32,
    gravity: f32,
    curl_radius: f32,
    curl_turns: f32,
    clump: f32,
    noise: f32,
}

// Lengths are in the world's units.
struct Hair {
    regions: array<HairRegion, REGION_COUNT>,
    hull_center: vec3f,
    margin: f32,
    head_bone: u32,
    strand_count: u32,
    // Fewer strands are wider, so that they cover as much.
    width_factor: f32,
}

struct Root {
    corners: vec3u,
    region: u32,
    barycentric: vec3f,
    tuft: u32,
    random: vec4f,
    comb: vec3f,
}
