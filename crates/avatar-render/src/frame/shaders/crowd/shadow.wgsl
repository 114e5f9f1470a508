@vertex
fn crowd_shadow_main(
    @builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> @builtin(position) vec4f {
    return shadow_view.shadow_from_world * vec4f(posed_vertex(vertex, instance).position, 1.0);
}
