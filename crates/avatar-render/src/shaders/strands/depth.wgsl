// Depth of the nearest strand at each pixel, however little of it the strand covers.

@vertex
fn strand_depth_main(
    @builtin(vertex_index) corner: u32,
    @builtin(instance_index) strand: u32,
) -> @builtin(position) vec4f {
    return ribbon_corner(strand_point(strand, corner, roots[strand].region), corner).position_clip;
}
