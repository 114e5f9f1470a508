// Lines around cartoons that ask for them: back sides, pushed outward by a width in the world.

@vertex
fn part_outline_main(in: VertexIn) -> StandardOut {
    return pushed(in, NO_EXTRA);
}

@vertex
fn part_outline_extra_main(in: VertexIn, extra: ExtraIn) -> StandardOut {
    return pushed(in, extra);
}

fn pushed(in: VertexIn, extra: ExtraIn) -> StandardOut {
    var out = standard_out(in, extra);
    let at = out.position_world + normalize(out.normal_world) * material.outline_width;
    out.position_clip = frame.clip_from_world * vec4f(at, 1.0);
    return out;
}

struct Line {
    @location(0) color: vec4f,
    @builtin(sample_mask) samples: u32,
}

@fragment
fn line_main(in: StandardOut) -> Line {
    let samples = covered_samples(in);
    return Line(target_color(material.outline_color, 1.0), samples);
}
