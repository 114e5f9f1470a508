// The vertices of a crowd: an instance is an avatar, and its vertices are read from the buffer of all.

@group(3) @binding(0) var<storage, read> deformed: array<DeformedVertex>;
@group(3) @binding(1) var<uniform> chunk: CrowdChunk;
// From the chunk's first avatar on: those of the chunk that are drawn.
@group(3) @binding(2) var<storage, read> drawn: array<u32>;
// The rows of the bone matrices of all avatars.
@group(3) @binding(3) var<storage, read> crowd_bones: array<mat3x4<f32>>;

fn posed_vertex(vertex: u32, instance: u32) -> DeformedVertex {
    let avatar = drawn[chunk.first_avatar + instance];
    return deformed[(avatar - chunk.first_avatar) * chunk.vertex_count + vertex];
}
