// The inner side of the skin, seen through the rim of the neck or behind a lid: a hollow that lamps do not
// reach. A little ambient light is enough, and cheap on adapters that shade hidden pixels as well.

const HOLLOW: f32 = 0.3;

@fragment
fn skin_back_main(in: VertexOut) -> @location(0) vec4f {
    let texel = textureSample(color_texture, repeat_sampler, in.uv);
    let covered = select(0.0, texel.a, (material.textures & COLOR_TEXTURE) != 0u);
    let is_tinted = (material.textures & (TINTED | COLOR_TEXTURE)) == (TINTED | COLOR_TEXTURE);
    let color = select(mix(material.color, texel.rgb, covered), material.color * texel.rgb, is_tinted);
    return target_color(color * irradiance_at(-normalize(in.normal_world)) * HOLLOW, 1.0);
}
