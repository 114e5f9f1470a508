// Depth and normals of surfaces with holes.

struct CutNormal {
    @location(0) normal: vec4f,
    @builtin(sample_mask) samples: u32,
}

@fragment
fn cut_prepass_main(in: StandardOut, @builtin(front_facing) is_front: bool) -> CutNormal {
    let normal = normalize(in.normal_world) * select(-1.0, 1.0, is_front);
    return CutNormal(vec4f(normal * 0.5 + 0.5, 1.0), covered_samples(in));
}
