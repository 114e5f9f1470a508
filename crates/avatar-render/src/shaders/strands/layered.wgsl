// Strands where pixels have one sample: each covers the share of the pixel that lies under it, and all of them are
// blended without sorting, the nearer the more: M. McGuire and L. Bavoil, "Weighted Blended Order-Independent
// Transparency", 2013, with distances from the nearest strand instead of from the viewer.

struct StrandLayer {
    @location(0) weighted: vec4f,
    // Multiplied: the share that all strands together leave clear.
    @location(1) cover: vec4f,
}

// The weight of the nearest strand is e to this, and that of the farthest: half floats hold sums of both.
const MOST: f32 = 4.0;
const LEAST: f32 = -7.0;

// The share of a pixel that a straight strand covers, exact where it runs along rows or columns: E. Chan and F. Durand,
// "Fast Prefiltered Lines", 2005, with a filter of one pixel.
fn strand_coverage(pixels: f32, off: f32) -> f32 {
    let least = hair_view.least_pixels;
    if least <= 0.0 {
        return 1.0;
    }
    return saturate(min(0.5 * (pixels + least) - abs(off), pixels) / least);
}

@fragment
fn strand_layered_main(in: StrandOut) -> StrandLayer {
    let coverage = strand_coverage(in.pixels, in.off);
    let nearest = textureLoad(depth_texture, vec2i(in.position_clip.xy), 0);
    let behind = view_distance(in.position_clip.z) - view_distance(nearest);
    let weight = coverage * exp(clamp(MOST - behind / hair_view.layer, LEAST, MOST));
    let color = target_color(in.light, 1.0).rgb;
    return StrandLayer(vec4f(color * weight, weight), vec4f(coverage));
}
