// Strands go with their guides as these swing, and stay outside of the skin.

// How far the points of guides are from where they grow.
@group(0) @binding(5) var offsets: texture_2d<f32>;

fn swung(grid: FieldGrid, placed: vec3f, offset: vec3f, grown_shares: vec2f, least_grown: f32) -> vec3f {
    var at = placed + offset;
    // Strands that moved far keep a little more distance from the skin, because a neck may turn below them.
    let far = length(offset);
    let least = least_grown + min(far, hair.margin);
    // Strands that hang still stay where they have grown.
    let firmness = saturate(4.0 * far / hair.margin);
    var shares = grown_shares;
    // Deep inside, the direction outward is inexact: repeat from the new place.
    for (var i = 0; i < 3; i++) {
        let near = field_at(grid, at + moved(pose.others[0], at) * shares.x + moved(pose.others[1], at) * shares.y);
        shares = near.shares;
        let push = max(least - min(near.distance, near.distance * DEEPER), 0.0) * firmness;
        at += normalize_or(near.outward, vec3f(0.0, 1.0, 0.0)) * push;
    }
    return at;
}
