// Deforms every vertex of a part into a buffer, once a frame: every later pass draws from it, and it can be read back.

struct DeformedVertex {
    position: vec3f,
    normal: vec3f,
}

@group(0) @binding(0) var<storage, read_write> deformed: array<DeformedVertex>;

@compute @workgroup_size(DEFORM_WORKGROUP_SIZE)
fn deform_main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= part.vertex_count {
        return;
    }
    let posed = deform_vertex(id.x);
    deformed[id.x] = DeformedVertex(posed.position_world, posed.normal_world);
}
