struct CrowdShadowIn {
    @location(0) bind_position_u: vec4f,
    @location(1) bind_normal_v: vec4f,
    @builtin(vertex_index) vertex: u32,
    @builtin(instance_index) instance: u32,
}

fn shadow_of_one(in: CrowdShadowIn) -> ShadowIn {
    return ShadowIn(in.bind_position_u, in.bind_normal_v, posed_vertex(in.vertex, in.instance).position);
}

@vertex
fn crowd_cut_shadow_main(in: CrowdShadowIn) -> ShadowOut {
    return shadow_out(shadow_of_one(in), vec2f(0.0), 1.0);
}

@vertex
fn crowd_cut_shadow_extra_main(
    in: CrowdShadowIn, @location(8) uv_1: vec2f, @location(9) color: vec4f) -> ShadowOut {
    return shadow_out(shadow_of_one(in), uv_1, color.a);
}
