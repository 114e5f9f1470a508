// Surfaces of interchange files in the picture: opaque, with holes, or blended.

@fragment
fn opaque_main(in: StandardOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let base = base_color(in);
    return vec4f(standard_color(in, base.rgb, is_front, view_occlusion(in.position_clip)), 1.0);
}

struct Cut {
    @location(0) color: vec4f,
    @builtin(sample_mask) samples: u32,
}

@fragment
fn cut_main(in: StandardOut, @builtin(front_facing) is_front: bool) -> Cut {
    let base = base_color(in);
    let samples = covered_samples(in);
    let color = standard_color(in, base.rgb, is_front, view_occlusion(in.position_clip));
    return Cut(vec4f(color, 1.0), samples);
}

// Earlier passes saw what lies behind it: their ambient occlusion is not that of this surface.
@fragment
fn blended_main(in: StandardOut, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let base = base_color(in);
    let alpha = saturate(base.a);
    return vec4f(standard_color(in, base.rgb, is_front, 1.0) * alpha, alpha);
}
