// Depth and normals of everything opaque, one sample a pixel: for ambient occlusion and for light under the
// skin.

@fragment
fn prepass_main(in: VertexOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let normal = normalize(in.normal_world) * select(-1.0, 1.0, is_front);
    return vec4f(normal * 0.5 + 0.5, 1.0);
}
