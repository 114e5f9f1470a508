// Strands go with their guides as these swing, and stay outside of the skin.

// How far the points of guides are from where they grow.
@group(0) @binding(5) var<storage, read> offsets: array<vec4f>;

fn swung(
    placed: vec3f, offset: vec3f, others: ptr<function, array<Bone, OTHER_BONES>>, grown_shares: vec2f, least_grown: f32,
) -> vec3f {
    var at = placed + offset;
    // What moves fast over a turning neck keeps a little further away.
    let far = length(offset);
    let least = least_grown + min(far, hair.margin);
    // What hangs still stays where it has grown.
    let firmness = saturate(4.0 * far / hair.margin);
    var shares = grown_shares;
    // Far inside, the nearest way out is not known well: once more from there.
    for (var i = 0; i < 3; i++) {
        let moved_0 = (moved((*others)[0], at) - at) * shares.x;
        let moved_1 = (moved((*others)[1], at) - at) * shares.y;
        let near = field_at(at + moved_0 + moved_1);
        shares = near.shares;
        at += near.outward * (max(least - near.distance, 0.0) * firmness);
    }
    return at;
}
