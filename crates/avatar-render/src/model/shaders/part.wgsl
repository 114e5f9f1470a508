// The geometry of one part for the deform pass, shared by all avatars of a model.

struct Part {
    vertex_count: u32,
    // Words of 32 weights that the part's shapes follow: the first one, and how many.
    first_word: u32,
    word_count: u32,
    // The bone of a part that is rigid; not read where vertices have bones of their own.
    rigid_bone: u32,
    has_vertex_bones: u32,
    // Of each place of wrinkles the middle at bind pose, and 1 / its reach.
    wrinkles: array<vec4f, MOST_WRINKLES>,
}

struct Vertex {
    position: vec3f,
    u: f32,
    normal: vec3f,
    v: f32,
}

struct VertexBones {
    indices: vec4u,
    weights: vec4f,
}

// Scalars instead of vectors: 24 bytes without padding.
struct ShapeOffset {
    position_x: f32,
    position_y: f32,
    position_z: f32,
    normal_x: f32,
    normal_y: f32,
    normal_z: f32,
}

@group(2) @binding(0) var<uniform> part: Part;
@group(2) @binding(1) var<storage, read> vertices: array<Vertex>;
// BONE_SETS of them for each vertex, one after the other.
@group(2) @binding(2) var<storage, read> vertex_bones: array<VertexBones>;
// A row for each block of SHAPE_BLOCK vertices: a bit for each place of wrinkles that reaches it; then of
// each word a bit for each shape that moves something there, and where the first of them stands in
// `shape_offsets`, which has blocks of offsets for those alone. So shapes at rest are never read.
@group(2) @binding(3) var<storage, read> block_shapes: array<u32>;
@group(2) @binding(4) var<storage, read> shape_offsets: array<ShapeOffset>;
