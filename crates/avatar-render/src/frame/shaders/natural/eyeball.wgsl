// The eyeball: iris and pupil seen through the cornea, a dark ring around them, a wet white that lids and
// brow shade.

@fragment
fn eyeball_main(in: EyeOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let view = iris_view(in);
    var surface = surface_at(vertex_of(in), view.uv, is_front);
    if EYE_OPTICS {
        surface.color *= select(1.0, limbal(view.radius), material.iris.radius > 0.0 && in.position_bind.z > material.iris.cornea_center.z);
    }
    // The far sides of the ball lie deep in the socket, and the brow keeps off light from above.
    let in_socket = smoothstep(0.15, 0.6, in.depth);
    let under_brow = smoothstep(-0.1, 0.75, surface.smooth_normal.y);
    surface.occlusion *= mix(1.0, material.back_light, in_socket) * (1.0 - 0.4 * under_brow)
        * view_occlusion(in.position_clip);
    let lit = lit_surface(surface);
    // The cornea brings its own film.
    let wet = under_film(surface, lit, material.wetness * (1.0 - view.inside));
    return target_color(surface.color * wet.diffuse + wet.specular, 1.0);
}
