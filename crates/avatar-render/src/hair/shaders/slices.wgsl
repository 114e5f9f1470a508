// How much strands cover in each slice of a pixel's hair.

struct SlicesOut {
    @location(0) front: vec4f,
    @location(1) back: vec4f,
}

@fragment
fn strand_slices_main(in: LayersOut) -> SlicesOut {
    let coverage = strand_coverage(in.pixels, in.off);
    let layers = textureLoad(hair_layers, vec2i(in.position_clip.xy), 0);
    // What is behind all slices counts for the last.
    let slice = u32(min(slice_at(layers, nearness(in.position_clip.z)), SLICE_COUNT - 1.0));
    let front = vec4u(0u, 1u, 2u, 3u);
    return SlicesOut(
        select(vec4f(0.0), vec4f(coverage), front == vec4u(slice)),
        select(vec4f(0.0), vec4f(coverage), front + 4u == vec4u(slice)),
    );
}
