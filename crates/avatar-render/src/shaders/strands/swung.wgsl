// Strands go with their guides as these swing, and stay outside of the skin.

// How far the points of guides are from where they grow.
@group(0) @binding(5) var<storage, read> offsets: array<vec4f>;

fn swung(
    placed: vec3f, offset: vec3f, others: ptr<function, array<Bone, OTHER_BONES>>, shares: vec2f, least: f32,
) -> vec3f {
    var at = placed + offset;
    // Far inside, the nearest way out is not known well: once more from there.
    for (var i = 0; i < 3; i++) {
        let moved_0 = (moved((*others)[0], at) - at) * shares.x;
        let moved_1 = (moved((*others)[1], at) - at) * shares.y;
        let near = field_at(at + moved_0 + moved_1);
        at += near.outward * max(least - near.distance, 0.0);
    }
    return at;
}
