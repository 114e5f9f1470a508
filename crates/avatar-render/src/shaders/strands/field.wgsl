// How far a place is from the skin at bind pose, and which bones move the skin there. The twin on the CPU is
// avatar_groom::Field.

// A distance as a share of the largest in 16 bits and shares of the other bones in 8 bits each, then the direction in which
// the distance grows in 8 bits each.
// A texture, because software adapters read textures several times faster than buffers.
@group(0) @binding(2) var field: texture_3d<u32>;

struct Near {
    // The direction in which the distance grows, unit length.
    outward: vec3f,
    distance: f32,
    shares: vec2f,
}

// Between two neighbours across.
fn field_between(place: vec3i, share: f32) -> Near {
    let a = textureLoad(field, place, 0).xy;
    let b = textureLoad(field, place + vec3i(1, 0, 0), 0).xy;
    let distance = mix(unpack2x16snorm(a.x).x, unpack2x16snorm(b.x).x, share);
    let shares = mix(unpack4x8unorm(a.x).zw, unpack4x8unorm(b.x).zw, share);
    return Near(mix(unpack4x8snorm(a.y).xyz, unpack4x8snorm(b.y).xyz, share), distance, shares);
}

fn near_between(a: Near, b: Near, share: f32) -> Near {
    return Near(
        mix(a.outward, b.outward, share), mix(a.distance, b.distance, share), mix(a.shares, b.shares, share));
}

fn field_at(place: vec3f) -> Near {
    let last = vec3f(hair.field_size) - 1.0;
    let wanted = (place - hair.field_origin) / hair.field_cell;
    let inside = clamp(wanted, vec3f(0.0), last);
    let low = min(floor(inside), last - 1.0);
    let share = inside - low;
    let first = vec3i(low);
    let v00 = field_between(first, share.x);
    let v10 = field_between(first + vec3i(0, 1, 0), share.x);
    let v01 = field_between(first + vec3i(0, 0, 1), share.x);
    let v11 = field_between(first + vec3i(0, 1, 1), share.x);
    var near = near_between(near_between(v00, v10, share.y), near_between(v01, v11, share.y), share.z);
    let beyond = length(wanted - inside) * hair.field_cell;
    near.outward = normalize_or(near.outward, vec3f(0.0, 1.0, 0.0));
    near.distance = near.distance * hair.field_range + beyond;
    return near;
}
