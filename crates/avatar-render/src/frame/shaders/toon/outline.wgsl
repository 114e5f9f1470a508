// Lines around everything: the back sides, pushed outward by a width in pixels. T. Saito and T. Takahashi
// drew lines from depth ("Comprehensible Rendering of 3-D Shapes", 1990); pushing the hull needs no second
// picture: R. Raskar and M. Cohen, "Image Precision Silhouette Edges", 1999.

const LINE_PIXELS: f32 = 1.6;
const LINE_COLOR: vec3f = vec3f(0.012, 0.008, 0.012);

fn outline_out(in: VertexIn) -> VertexOut {
    var out = vertex_out(in);
    let across = (frame.clip_from_world * vec4f(in.normal_world, 0.0)).xy * frame.pixels;
    let direction = across / max(length(across), 1e-6);
    // Thicker in large pictures, as a pen would be chosen.
    let width = LINE_PIXELS * max(frame.pixels.y / 720.0, 0.6);
    let offset = direction * width * 2.0 / frame.pixels * out.position_clip.w;
    out.position_clip = vec4f(out.position_clip.xy + offset, out.position_clip.zw);
    return out;
}

@vertex
fn outline_vertex_main(in: VertexIn) -> VertexOut {
    return outline_out(in);
}

@fragment
fn outline_main(in: VertexOut) -> @location(0) vec4f {
    return target_color(LINE_COLOR / max(frame.exposure, 1e-3), 1.0);
}
