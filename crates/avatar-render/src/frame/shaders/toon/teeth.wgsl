// Teeth, drawn: bright in front, dark behind.

@fragment
fn teeth_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let color = toon_color(surface_at(in, in.uv, is_front));
    return target_color(color * mix(1.0, material.back_light, band(in.depth, 0.35)), 1.0);
}
