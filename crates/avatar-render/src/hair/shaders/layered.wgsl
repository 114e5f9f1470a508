// Strands where pixels have one sample, blended without sorting: M. McGuire and L. Bavoil, "Weighted Blended
// Order-Independent Transparency", 2013. The weight of a strand is what the strands before it let through, by
// the cover of slices behind the nearest strand (C. Yuksel and J. Keyser, "Deep Opacity Maps", 2008): within
// a slice it grows evenly.

struct StrandLayer {
    @location(0) weighted: vec4f,
    // Multiplied by blending: the share that all strands together leave clear.
    @location(1) cover: vec4f,
}

// Weights get no smaller behind this many layers of hair, so that f16 holds their sums.
const DEEPEST: f32 = 12.0;
const SCALE: f32 = 64.0;

@fragment
fn strand_layered_main(in: StrandOut) -> StrandLayer {
    let coverage = strand_coverage(in.pixels, in.off);
    let pixel = vec2i(in.position_clip.xy);
    let layers = textureLoad(hair_layers, pixel, 0);
    let front = textureLoad(front_slices, pixel, 0);
    let back = textureLoad(back_slices, pixel, 0);
    let at = vec4f(slice_at(layers, nearness(in.position_clip.z)));
    let first = vec4f(0.0, 1.0, 2.0, 3.0);
    let before = dot(front, saturate(at - first)) + dot(back, saturate(at - first - 4.0));
    let weight = coverage * SCALE * exp(-min(before, DEEPEST));
    return StrandLayer(vec4f(in.color * weight, weight), vec4f(coverage));
}
