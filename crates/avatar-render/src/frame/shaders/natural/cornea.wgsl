// The cornea: almost clear, blended over the eyeball. Its body is weighted by its opacity, its reflections
// are not: a highlight stays as bright as the lamp makes it, and covers what lies behind by as much.

@fragment
fn cornea_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    var surface = surface_at(in, in.uv, is_front);
    surface.occlusion *= view_occlusion(in.position_clip);
    let lit = under_film(surface, lit_surface(surface), material.wetness);
    let body = surface.color * lit.diffuse * surface.opacity;
    let brightest = max(lit.specular.r, max(lit.specular.g, lit.specular.b)) * frame.exposure;
    return target_color(body + lit.specular, saturate(max(surface.opacity, brightest)));
}
