// Shadows of hair in the key's light, without noise: C. Yuksel and J. Keyser, "Deep Opacity Maps", 2008. A
// map holds how much all strands cover (r), the depth of the nearest one (1 - a) and their mean depth (g /
// r). The layers of the paper need a pass for the nearest depth; instead, cover grows evenly from the nearest
// strand to as far behind the mean.

// Optical depth of hair that covers everything once.
const HAIR_BLOCKS: f32 = 1.0;
// Hair reaches beyond the box around the skin.
const HAIR_FIT: f32 = 0.8;
// A point that is this near behind the first strand, as a share of the map's depth, is not behind it.
const HAIR_BIAS: f32 = 0.002;

// −1…1 across and up, 0…1 away from the lamp.
fn hair_map_place(position: vec3f) -> vec3f {
    let p = (frame.shadow_from_world[0] * vec4f(position, 1.0)).xyz;
    return vec3f(p.xy * HAIR_FIT, (p.z - 0.5) * HAIR_FIT + 0.5);
}

// Width of a texel in the world.
fn hair_map_texel() -> f32 {
    return frame.shadow_texel[0] * SHADOW_SIZE / (HAIR_FIT * HAIR_MAP_SIZE);
}

// The share of the key's light that hair lets through to a point, filtered over the nearest texels and
// `reach` more on each side.
fn hair_visibility(position: vec3f, blocks: f32, reach: i32) -> f32 {
    let place = hair_map_place(position);
    let at = vec2f(place.x * 0.5 + 0.5, 0.5 - place.y * 0.5) * HAIR_MAP_SIZE - 0.5;
    let first = vec2i(floor(at)) - reach;
    let last = i32(HAIR_MAP_SIZE) - 1;
    let width = f32(reach) + 1.0;
    var seen = 0.0;
    var total = 0.0;
    for (var y = 0; y < 2 * reach + 2; y++) {
        for (var x = 0; x < 2 * reach + 2; x++) {
            let texel = first + vec2i(x, y);
            let off = width - abs(vec2f(texel) - at);
            let weight = off.x * off.y;
            let map = textureLoad(hair_map, clamp(texel, vec2i(0), vec2i(last)), 0);
            let nearest = 1.0 - map.a;
            let mean = map.g / max(map.r, 1e-4);
            let length = max(2.0 * (mean - nearest), HAIR_BIAS);
            let before = saturate((place.z - nearest - HAIR_BIAS) / length);
            seen += weight * exp(-blocks * map.r * before);
            total += weight;
        }
    }
    return seen / total;
}
