// The triangles of a part some of whose bones mirror: those of which they mirror most corners run the other
// way around, so that the front of every triangle stays its front.

@group(0) @binding(0) var<storage, read> deformed: array<DeformedVertex>;
// Three vertices each.
@group(0) @binding(1) var<storage, read> corners: array<u32>;
@group(0) @binding(2) var<storage, read_write> turned_corners: array<u32>;

@compute @workgroup_size(REVERSE_WORKGROUP_SIZE)
fn reverse_main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) within: u32,
) {
    let triangle = (group.y * groups.x + group.x) * REVERSE_WORKGROUP_SIZE + within;
    if triangle >= arrayLength(&corners) / 3u {
        return;
    }
    let a = corners[3u * triangle];
    let b = corners[3u * triangle + 1u];
    let c = corners[3u * triangle + 2u];
    let is_reversed = deformed[a].is_mirrored + deformed[b].is_mirrored + deformed[c].is_mirrored > 1u;
    turned_corners[3u * triangle] = a;
    turned_corners[3u * triangle + 1u] = select(b, c, is_reversed);
    turned_corners[3u * triangle + 2u] = select(c, b, is_reversed);
}
