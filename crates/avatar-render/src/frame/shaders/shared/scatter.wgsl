// Light that spreads below the skin, in the picture: J. Jimenez et al., "Separable Subsurface Scattering",
// 2015. Each of the two passes blurs along one axis of the picture with a sum of two Gaussians per channel, a
// wide and a narrow one, as wide as the material says at the distance of the pixel.

// Samples on each side of a pixel.
const SCATTER_REACH: i32 = 8;
const PROFILE_UNIT: f32 = 4.0;

// The pixel whose light is used for this one: at an edge of the skin, the middle of the pixel itself may miss
// the skin.
fn skin_pixel(at: vec2i) -> vec2i {
    let size = vec2i(textureDimensions(skin_light));
    for (var i = 0; i < 9; i++) {
        // The pixel itself first, then the neighbours, those that share an edge before those at corners.
        let step = array(
            vec2i(0, 0), vec2i(-1, 0), vec2i(1, 0), vec2i(0, -1), vec2i(0, 1),
            vec2i(-1, -1), vec2i(1, -1), vec2i(-1, 1), vec2i(1, 1))[i];
        let pixel = clamp(at + step, vec2i(0), size - 1);
        if textureLoad(skin_light, pixel, 0).a > 0.5 {
            return pixel;
        }
    }
    return clamp(at, vec2i(0), size - 1);
}

// d: parameters of Burley's profile as fractions of the widest channel's; x in units of PROFILE_UNIT of them.
// Two Gaussians, two thirds and one third of the light, whose variance is that of the profile along a line, 7
// d².
fn profile(x: f32, d: vec3f) -> vec3f {
    let near = max(1.3 / PROFILE_UNIT * d, vec3f(0.02));
    let far = max(4.2 / PROFILE_UNIT * d, vec3f(0.06));
    return 0.67 * exp(-0.5 * x * x / (near * near)) / near + 0.33 * exp(-0.5 * x * x / (far * far)) / far;
}

fn scattered_along(axis: vec2i, position_clip: vec4f) -> vec3f {
    let size = vec2i(textureDimensions(skin_light));
    let center = skin_pixel(vec2i(position_clip.xy));
    let widest = max(material.scatter.r, max(material.scatter.g, material.scatter.b));
    let distance = view_distance(textureLoad(depth_texture, center, 0));
    let unit = PROFILE_UNIT * widest;
    let pixels = unit * frame.pixels_per_unit / max(distance, 1e-6);
    let here = textureLoad(skin_light, center, 0).rgb;
    if pixels < 0.25 {
        return here;
    }
    let d = material.scatter / widest;
    var sum = vec3f(0.0);
    var total = vec3f(0.0);
    for (var i = -SCATTER_REACH; i <= SCATTER_REACH; i++) {
        // Denser in the middle, out to almost three deviations of the wide Gaussian.
        let t = f32(i) / f32(SCATTER_REACH);
        let x = 3.0 * t * abs(t);
        let step = i32(round(x * pixels));
        let pixel = clamp(center + axis * step, vec2i(0), size - 1);
        let light = textureLoad(skin_light, pixel, 0);
        let gap = (view_distance(textureLoad(depth_texture, pixel, 0)) - distance) / (1.5 * widest);
        // Another part, or another side of a fold: light does not jump there.
        let same = light.a * exp(-0.5 * gap * gap);
        let spacing = max(abs(t), 0.5 / f32(SCATTER_REACH));
        let weight = profile(x, d) * spacing * same;
        sum += weight * light.rgb;
        total += weight;
    }
    return sum / max(total, vec3f(1e-6));
}
