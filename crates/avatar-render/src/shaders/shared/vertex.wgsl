// The vertex stage of every kind of part.

struct VertexOut {
    @builtin(position) position_clip: vec4f,
    @location(0) position_world: vec3f,
    @location(1) normal_world: vec3f,
    @location(2) uv: vec2f,
    // Where the vertex lies in its part at bind pose: 0 at the front of the face, 1 at the back.
    @location(3) depth: f32,
}

@vertex
fn vertex_main(@builtin(vertex_index) vertex: u32) -> VertexOut {
    let posed = deform_vertex(vertex);
    var out: VertexOut;
    out.position_clip = frame.clip_from_world * vec4f(posed.position_world, 1.0);
    out.position_world = posed.position_world;
    out.normal_world = posed.normal_world;
    out.uv = vec2f(vertices[vertex].u, vertices[vertex].v);
    out.depth = (part.front_z - vertices[vertex].position.z) * part.per_depth;
    return out;
}
