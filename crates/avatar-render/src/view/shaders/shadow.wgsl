// Shadows of the key (0) and rim (1) lamps from depth maps: L. Williams, "Casting Curved Shadows on Curved
// Surfaces", 1978, softened by W. Reeves et al., "Rendering Antialiased Shadows with Depth Maps", 1987.

// Shadow of each lamp; the fill casts none.
const NO_SHADOW: i32 = -1;

fn shadow_of(lamp: u32) -> i32 {
    if lamp == KEY_LAMP {
        return 0;
    }
    return select(NO_SHADOW, 1, lamp == RIM_LAMP && SHADOW_COUNT_USED > 1);
}

// A thickness that no light passes, in the world.
const FAR_INSIDE: f32 = 1e6;

// Where a point lies in a shadow map: texture coordinates and depth. The point is lifted off its surface by
// what one texel may hide: D. Holbert, "Saying Goodbye to Shadow Acne", 2011.
fn shadow_place(layer: i32, position: vec3f, normal: vec3f) -> vec3f {
    let lifted = position + normal * frame.shadow_texel[layer] * 1.5;
    let p = (frame.shadow_from_world[layer] * vec4f(lifted, 1.0)).xyz;
    return vec3f(p.x * 0.5 + 0.5, 0.5 - p.y * 0.5, p.z);
}

// An avatar that looks small beside a nearer one may lie outside of the map: nothing casts shadows there.
fn is_beyond_map(place: vec3f) -> bool {
    return any(place != saturate(place));
}

// How the depth of a surface changes across the map, per width and height of the map: samples follow the tilt
// of a surface so that it does not shadow itself. J. Isidoro, "Shadow Mapping: GPU-based Tips and
// Techniques", 2006. Where a lamp grazes the surface the slope has no limit, and is cut; the surface's own
// shade hides the error.
fn depth_slope(layer: i32, normal: vec3f) -> vec2f {
    let width = frame.shadow_texel[layer] * SHADOW_SIZE;
    let depth = frame.shadow_depth[layer];
    let scaled = (frame.shadow_from_world[layer] * vec4f(normal, 0.0)).xyz;
    // The normal with the lamp's axes, its z toward the lamp.
    let n = scaled * vec3f(0.5 * width, 0.5 * width, -depth);
    return vec2f(n.x, -n.y) * width / (depth * max(n.z, 0.2));
}

// The share of a lamp's light that nothing blocks.
fn lamp_visibility(lamp: u32, position: vec3f, normal: vec3f) -> f32 {
    let seen = cast_visibility(lamp, position, normal);
    if SHADOW_REACH < 0 || lamp != KEY_LAMP || frame.hair_shadow <= 0.0 {
        return seen;
    }
    return seen * hair_visibility(position, HAIR_BLOCKS, min(SHADOW_REACH, 1));
}

// The share of a lamp's light that nothing but hair blocks, over a square of samples with Gaussian weights.
// The pattern is its own mirror image, so that a mirrored face under mirrored light is a mirrored picture.
fn cast_visibility(lamp: u32, position: vec3f, normal: vec3f) -> f32 {
    return sampled_visibility(lamp, position, normal, SHADOW_REACH);
}

// The same over the same square, with `samples` on each side of the middle one.
fn sampled_visibility(lamp: u32, position: vec3f, normal: vec3f, samples: i32) -> f32 {
    let layer = shadow_of(lamp);
    if SHADOW_REACH < 0 || layer == NO_SHADOW {
        return 1.0;
    }
    let place = shadow_place(layer, position, normal);
    if is_beyond_map(place) {
        return 1.0;
    }
    let reach = f32(max(SHADOW_REACH, 1));
    // No wider than the samples can fill: gaps between them would show as steps.
    let texels = min(frame.shadow_softness / frame.shadow_texel[layer], 3.0 * reach);
    let spread = texels / SHADOW_SIZE;
    let slope = depth_slope(layer, normal) * spread;
    let bias = 0.5 * frame.shadow_texel[layer] / frame.shadow_depth[layer];
    var seen = 0.0;
    var total = 0.0;
    for (var y = -samples; y <= samples; y++) {
        for (var x = -samples; x <= samples; x++) {
            let offset = vec2f(f32(x), f32(y)) / f32(max(samples, 1));
            let weight = exp(-1.5 * dot(offset, offset));
            let at = place.xy + offset * spread;
            // Surfaces curve as well as tilt: more bias further out.
            let depth = place.z + dot(slope, offset) - bias * (1.0 + 2.0 * length(offset) * reach);
            seen += weight * textureSampleCompareLevel(shadow_map, shadow_sampler, at, layer, depth);
            total += weight;
        }
    }
    return seen / total;
}

// How far the lamp's light has travelled inside before it reaches this point from behind: the depth of the
// point below the first surface that the lamp sees. J. Jimenez et al., "Real-Time Realistic Skin
// Translucency", 2010.
fn thickness_toward(lamp: u32, position: vec3f, normal: vec3f) -> f32 {
    let layer = shadow_of(lamp);
    if SHADOW_REACH < 0 || layer == NO_SHADOW {
        return 0.0;
    }
    // The point is moved inward instead of outward: at a silhouette, the depth of a neighbour would look like
    // a hole.
    let place = shadow_place(layer, position - normal * frame.shadow_texel[layer] * 3.0, normal);
    if is_beyond_map(place) {
        return FAR_INSIDE;
    }
    let size = vec2f(SHADOW_SIZE);
    let texel = vec2i(clamp(place.xy * size, vec2f(1.0), size - 2.0));
    var thickness = 0.0;
    for (var i = 0; i < 4; i++) {
        let depth = textureLoad(shadow_map, texel + vec2i((i & 1) * 2 - 1, (i >> 1) * 2 - 1), layer, 0);
        thickness += 0.25 * max(place.z - depth, 0.0);
    }
    return thickness * frame.shadow_depth[layer];
}
