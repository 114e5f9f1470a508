// The eyeball: iris and pupil seen through the cornea, a dark ring around them, a wet white that lids and
// brow shade.

// The white beside the iris takes its level of detail from its own coordinates: its neighbours' are bent by
// the cornea, and would let the size of the pupil reach one pixel beyond the iris.
fn eye_color(uv: vec2f, own_uv: vec2f) -> vec4f {
    let is_white = all(uv == own_uv);
    let across = select(dpdx(uv), dpdx(own_uv), is_white);
    let down = select(dpdy(uv), dpdy(own_uv), is_white);
    if (material.textures & COLOR_TEXTURE) == 0u {
        return bare_color();
    }
    return painted_color(uv, textureSampleGrad(color_texture, color_sampler, uv, across, down));
}

@fragment
fn eyeball_main(in: EyeOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let view = iris_view(in);
    var surface = surface_of(vertex_of(in), view.uv, eye_color(view.uv, in.uv), is_front);
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
