// Strands go with their guides as these swing, and stay outside of the skin.

// How far the points of guides are from where they grow.
@group(0) @binding(5) var offsets: texture_2d<f32>;

// How often a point is taken back, and pushed out; most are outside at once.
const MOST_RETURNS: i32 = 4;
const MOST_PUSHES: i32 = 4;

fn near_swung(grid: FieldGrid, at: vec3f, shares: vec2f) -> Near {
    return field_at(grid, at + moved(pose.others[0], at) * shares.x + moved(pose.others[1], at) * shares.y);
}

// `grown` says how far the skin is from where the point grows.
fn swung(grid: FieldGrid, placed: vec3f, offset: vec3f, grown: Near, least_grown: f32) -> vec3f {
    var at = placed + offset;
    // Strands that moved far keep a little more distance from the skin, because a neck may turn below them.
    let far = length(offset);
    let least = least_grown + min(far, hair.margin);
    // Strands that hang still stay where they have grown.
    let firmness = saturate(4.0 * far / hair.margin);
    var near = near_swung(grid, at, grown.shares);
    // Deep inside, the direction outward may lead to any side, or further in where it changes from one to the
    // other. Back along the way, to about where it went in: as if distances changed evenly along it.
    let outside = max(grown.distance, hair.margin);
    var share = 1.0;
    for (var i = 0; i < MOST_RETURNS; i++) {
        let deep = saturate(-near.distance / hair.margin - 1.0);
        if deep <= 0.0 {
            break;
        }
        share *= mix(1.0, outside / (outside - near.distance), deep);
        at = placed + offset * share;
        near = near_swung(grid, at, near.shares);
    }
    // The direction is that of the place inside: again from the new one.
    for (var i = 0; i < MOST_PUSHES; i++) {
        let push = max(least - min(near.distance, near.distance * DEEPER), 0.0) * firmness;
        if push <= 0.0 {
            break;
        }
        at += normalize_or(near.outward, vec3f(0.0, 1.0, 0.0)) * push;
        near = near_swung(grid, at, near.shares);
    }
    return at;
}
