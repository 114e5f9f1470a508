// Strands where pixels have one sample: what each covers, and how deep in the hair it lies.

// The share of a pixel that a straight strand covers, exact where it runs along rows or columns: E. Chan and
// F. Durand, "Fast Prefiltered Lines", 2005, with a filter of one pixel.
fn strand_coverage(pixels: f32, off: f32) -> f32 {
    let least = hair_view.least_pixels;
    if least <= 0.0 {
        return 1.0;
    }
    return saturate(min(0.5 * (pixels + least) - abs(off), pixels) / least);
}

// 1 at the front of the space that hair fills, 0 at its back: half floats hold steps of a two-thousandth of
// it.
fn nearness(depth: f32) -> f32 {
    return saturate((frame.hair_far - view_distance(depth)) * frame.hair_per_depth);
}

const SLICE_COUNT: f32 = 8.0;

// The slice of a pixel's hair at a nearness, plus the share of the slice in front of it. Slices reach from
// the nearest strand to as far behind the mean. Those in front are thinner, because what lies in front hides
// the rest.
fn slice_at(layers: vec4f, near: f32) -> f32 {
    let mean = layers.g / max(layers.r, 1e-4);
    let depth = saturate((layers.a - near) / max(2.0 * (layers.a - mean), 1e-3));
    return SLICE_COUNT * sqrt(depth);
}
