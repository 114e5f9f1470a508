// Strands where pixels have one sample, blended without sorting: M. McGuire and L. Bavoil, "Weighted Blended
// Order-Independent Transparency", 2013. The weight of a strand is what the strands before it let through, by the same
// measure as shadows of hair: what they cover grows evenly from the nearest to as far behind the mean (C. Yuksel and J.
// Keyser, "Deep Opacity Maps", 2008).

struct StrandLayer {
    @location(0) weighted: vec4f,
    // Multiplied: the share that all strands together leave clear.
    @location(1) cover: vec4f,
}

// Half floats hold sums of weights from the nearest strands to those behind as many as this.
const DEEPEST: f32 = 12.0;
const SCALE: f32 = 64.0;

@fragment
fn strand_layered_main(in: StrandOut) -> StrandLayer {
    let coverage = strand_coverage(in.pixels, in.off);
    let layers = textureLoad(skin_light, vec2i(in.position_clip.xy), 0);
    let mean = layers.g / max(layers.r, 1e-4);
    let before = saturate((layers.a - nearness(in.position_clip.z)) / max(2.0 * (layers.a - mean), 1e-3));
    let weight = coverage * SCALE * exp(-min(layers.r * before, DEEPEST));
    return StrandLayer(vec4f(in.color * weight, weight), vec4f(coverage));
}
