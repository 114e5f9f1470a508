// The inner side of the skin, seen through the rim of the neck or behind a lid: a hollow that lamps do not
// reach. A little ambient light is enough, and cheap on adapters that shade hidden pixels as well.

const HOLLOW: f32 = 0.4;

@fragment
fn skin_back_main(in: VertexOut) -> @location(0) vec4f {
    let color = part_color(in.uv).rgb;
    return target_color(color * hemisphere(-normalize(in.normal_world)) * HOLLOW, 1.0);
}
