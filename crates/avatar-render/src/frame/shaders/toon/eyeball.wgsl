// Eyes, drawn: a strong ring around the iris, the shade of the lid as a band.

@fragment
fn eyeball_main(in: EyeOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let view = iris_view(in);
    var surface = surface_at(vertex_of(in), view.uv, is_front);
    let ring = band(abs(view.radius - 1.0), 0.06);
    let has_iris = material.iris.radius > 0.0;
    surface.color *= select(1.0, mix(0.25, 1.0, ring), has_iris);
    let shade = 1.0 - 0.35 * band(surface.smooth_normal.y, 0.25);
    return target_color(surface.color * (irradiance_at(surface.view) + frame.lamps[KEY_LAMP].radiance * 0.55) * shade, 1.0);
}
