// Deforms a part of those avatars of a crowd that moved: a row of workgroups for each.

@group(0) @binding(0) var<storage, read_write> deformed: array<DeformedVertex>;
@group(0) @binding(1) var<uniform> chunk: CrowdChunk;
// From the chunk's first avatar on: those of the chunk that moved.
@group(0) @binding(2) var<storage, read> moved: array<u32>;

@compute @workgroup_size(DEFORM_WORKGROUP_SIZE)
fn deform_crowd_main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) within: u32) {
    let vertex = group.x * DEFORM_WORKGROUP_SIZE + within;
    if vertex >= part.vertex_count {
        return;
    }
    let avatar = moved[chunk.first_avatar + group.y];
    first_bone = avatar * chunk.bone_count;
    first_weight = avatar * chunk.weight_stride;
    let posed = deform_vertex(group.x, within);
    let place = (avatar - chunk.first_avatar) * part.vertex_count + vertex;
    deformed[place].position = posed.position_world;
    deformed[place].normal = posed.normal_world;
    deformed[place].wrinkled = wrinkled(group.x, vertices[vertex].position);
}
