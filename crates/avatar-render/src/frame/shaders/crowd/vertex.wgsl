// Vertices of a crowd for passes that draw parts.

struct CrowdIn {
    @location(0) bind_position_u: vec4f,
    @location(1) bind_normal_v: vec4f,
    @location(4) curvature: f32,
    @builtin(vertex_index) vertex: u32,
    @builtin(instance_index) instance: u32,
}

fn of_one(in: CrowdIn) -> VertexIn {
    let posed = posed_vertex(in.vertex, in.instance);
    return VertexIn(in.bind_position_u, in.bind_normal_v, posed.position, posed.normal, in.curvature, posed.wrinkled);
}
