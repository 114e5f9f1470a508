// The vertex stage of passes that draw parts; vertices are deformed already.

struct VertexIn {
    @location(0) bind_position_u: vec4f,
    @location(1) bind_normal_v: vec4f,
    @location(2) position_world: vec3f,
    @location(3) normal_world: vec3f,
    // 1 / radius of the surface at bind pose.
    @location(4) curvature: f32,
    @location(10) wrinkled: f32,
}

struct VertexOut {
    // Several passes compare depths of the same vertex.
    @invariant @builtin(position) position_clip: vec4f,
    @location(0) position_world: vec3f,
    @location(1) normal_world: vec3f,
    @location(2) uv: vec2f,
    // Where the vertex lies in its part at bind pose: 0 at the front of the face, 1 at the back.
    @location(3) depth: f32,
    @location(4) curvature: f32,
    // How strongly the skin is wrinkled, 0 to 1.
    @location(5) wrinkled: f32,
}

fn vertex_out(in: VertexIn) -> VertexOut {
    var out: VertexOut;
    out.position_clip = frame.clip_from_world * vec4f(in.position_world, 1.0);
    out.position_world = in.position_world;
    // A mesh may have normals of length 0, which must not become holes.
    let has_normal = dot(in.normal_world, in.normal_world) > 0.0;
    out.normal_world = select(vec3f(0.0, 1.0, 0.0), in.normal_world, has_normal);
    out.uv = vec2f(in.bind_position_u.w, in.bind_normal_v.w);
    out.depth = (material.front_z - in.bind_position_u.z) * material.per_depth;
    out.curvature = in.curvature;
    out.wrinkled = in.wrinkled;
    return out;
}

@vertex
fn vertex_main(in: VertexIn) -> VertexOut {
    return vertex_out(in);
}
