// Spreads light under the skin sideways; the skin itself spreads it upward where it is drawn.

@fragment
fn scatter_across_main(in: VertexOut) -> @location(0) vec4f {
    return vec4f(scattered_along(vec2i(1, 0), in.position_clip), 1.0);
}
