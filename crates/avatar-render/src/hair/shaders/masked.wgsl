// Strands where pixels have several samples.

struct StrandPixel {
    @location(0) color: vec4f,
    @builtin(sample_mask) samples: u32,
}

// A strand that is thinner than the least width is drawn that wide and covers fewer samples: it fades, and
// flickers less. Each strand chooses its samples by its random number: with one pattern for all, strands
// would hide each other and never fill a pixel. E. Enderton et al., "Stochastic Transparency", 2010.
@fragment
fn strand_masked_main(in: StrandOut) -> StrandPixel {
    let least = hair_view.least_pixels;
    let coverage = select(1.0, min(in.pixels / max(LEAST_OF_SAMPLES * least, 1e-6), 1.0), least > 0.0);
    let count = u32(coverage * 4.0 + fract(in.random * 61.0));
    let turned = u32(in.random * 4.0) & 3u;
    let run = (1u << min(count, 4u)) - 1u;
    let mask = ((run << turned) | (run >> (4u - turned))) & 15u;
    return StrandPixel(vec4f(in.color, 1.0), mask);
}
