// Where strands lie in each pixel: how much all of them cover (r), how near they are on average (g / r), and
// how near the nearest is (a), as hair_shadow.wgsl has it for the key.

struct LayersOut {
    @builtin(position) position_clip: vec4f,
    @location(0) pixels: f32,
    @location(1) off: f32,
}

@vertex
fn strand_layers_main(@builtin(vertex_index) corner: u32, @builtin(instance_index) strand: u32) -> LayersOut {
    let ribbon = ribbon_corner(strand_point(strand, corner, kind_of(strand)), corner);
    return LayersOut(ribbon.position_clip, ribbon.pixels, ribbon.off);
}

@fragment
fn strand_layers_fragment_main(in: LayersOut) -> @location(0) vec4f {
    let coverage = strand_coverage(in.pixels, in.off);
    let near = nearness(in.position_clip.z);
    return vec4f(coverage, coverage * near, 0.0, select(0.0, near, coverage > 0.0));
}
