// What the deform pass leaves of a vertex.

struct DeformedVertex {
    position: vec3f,
    // 1 where bones mirror the vertex, else 0; not written where no bone of the part does.
    is_mirrored: u32,
    normal: vec3f,
    // How strongly the skin is wrinkled, 0 to 1.
    wrinkled: f32,
}
