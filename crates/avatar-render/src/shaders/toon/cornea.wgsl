// The cornea, drawn: clear, with one hard spot of light.

@fragment
fn cornea_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let surface = surface_at(in, in.uv, is_front);
    let key = frame.lamps[KEY_LAMP];
    let half_way = normalize(key.direction_world + surface.view);
    let spot = band(dot(surface.smooth_normal, half_way), 0.988);
    let opacity = max(surface.opacity, spot);
    return target_color(mix(surface.color * surface.opacity, key.radiance, spot), opacity);
}
