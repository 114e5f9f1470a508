// The cornea, drawn: clear, with one hard spot of light.

@fragment
fn cornea_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let surface = surface_at(in, in.uv, is_front);
    let key = frame.lamps[KEY_LAMP];
    let half_way = normalize(key.direction_world + surface.view);
    let spot = band(dot(surface.smooth_normal, half_way), 0.988);
    // It covers what lies behind by as much as it shines: a lamp that is off draws no dark spot.
    let brightest = max(key.radiance.r, max(key.radiance.g, key.radiance.b)) * frame.exposure;
    let shine = spot * saturate(brightest);
    let body = surface.color * surface.opacity * (1.0 - shine);
    return target_color(body + key.radiance * spot, max(surface.opacity, shine));
}
