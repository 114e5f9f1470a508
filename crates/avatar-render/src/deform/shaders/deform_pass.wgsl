// Deforms every vertex of a part into a buffer, once a pose: every later pass draws from it, and it can be
// read back.

@group(0) @binding(0) var<storage, read_write> deformed: array<DeformedVertex>;

@compute @workgroup_size(DEFORM_WORKGROUP_SIZE)
fn deform_main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) within: u32) {
    let vertex = group.x * DEFORM_WORKGROUP_SIZE + within;
    if vertex >= part.vertex_count {
        return;
    }
    // A workgroup deforms one block.
    let posed = deform_vertex(group.x, within);
    deformed[vertex].position = posed.position_world;
    deformed[vertex].normal = posed.normal_world;
    deformed[vertex].wrinkled = wrinkled(group.x, vertices[vertex].position);
    if UNEVEN {
        deformed[vertex].is_mirrored = u32(posed.is_mirrored);
    }
}
