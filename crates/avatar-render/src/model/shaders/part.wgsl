// The geometry of one part for the deform pass, shared by all avatars of a model.

struct Part {
    vertex_count: u32,
    // The number of the weight that the first shape follows.
    first_weight: u32,
    // Rows of the table; later shapes move nothing of this part.
    shape_count: u32,
    // The bone of a part that is rigid; not read where vertices have bones of their own.
    rigid_bone: u32,
    has_vertex_bones: u32,
    has_wrinkles: u32,
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
// A table with a row for each shape, so that shapes at rest are never read. A row has one entry per block of
// SHAPE_BLOCK vertices: the number of a block in `shape_offsets`, or RESTING_BLOCK if the shape moves nothing
// there.
@group(2) @binding(3) var<storage, read> shape_blocks: array<u32>;
@group(2) @binding(4) var<storage, read> shape_offsets: array<ShapeOffset>;
