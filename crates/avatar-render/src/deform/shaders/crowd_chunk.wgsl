// Some neighbours in a crowd, and the vertices of one part of theirs, which lie in one buffer.
struct CrowdChunk {
    first_avatar: u32,
    vertex_count: u32,
    bone_count: u32,
    // Elements of `avatar_weights` that each avatar has.
    weight_stride: u32,
    // The bone of a part that is rigid.
    rigid_bone: u32,
}
