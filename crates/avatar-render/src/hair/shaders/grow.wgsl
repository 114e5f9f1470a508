// Grows every strand anew on the deformed skin. The twin on the CPU is avatar_groom::grow, line by line.

// Per strand its points with their height above the skin in w, then the normal of the skin at the root.
@group(0) @binding(3) var<storage, read_write> points: array<vec4f>;

// The field at a place. Where the skin moves with other bones, it is read at the bind pose of the place, with
// the shares of the place before.
fn skin_at(grid: FieldGrid, other_0: Bone, other_1: Bone, place: vec3f, shares: vec2f) -> Near {
    var near = field_at(grid, place + moved(other_0, place) * shares.x + moved(other_1, place) * shares.y);
    let turned_0 = turned_back(other_0, near.outward) * near.shares.x;
    let turned_1 = turned_back(other_1, near.outward) * near.shares.y;
    near.outward = normalize_or(near.outward + turned_0 + turned_1, vec3f(0.0, 1.0, 0.0));
    return near;
}

@compute @workgroup_size(GROW_WORKGROUP_SIZE)
fn grow_main(@builtin(global_invocation_id) id: vec3u) {
    let number = id.x;
    if number >= min(hair.strand_count, arrayLength(&points) / POINT_STRIDE) {
        return;
    }
    let root = root_of(number);
    let style = hair.regions[root.region];
    let a = deformed_vertex(root.corners.x);
    let b = deformed_vertex(root.corners.y);
    let c = deformed_vertex(root.corners.z);
    let w = root.barycentric;
    let start_world = a.position * w.x + b.position * w.y + c.position * w.z;
    let normal_world =
        normalize_or(a.normal * w.x + b.normal * w.y + c.normal * w.z, vec3f(0.0, 1.0, 0.0));
    let x = normalize_or(b.position - a.position, vec3f(1.0, 0.0, 0.0));
    let z = normalize_or(cross(x, c.position - a.position), vec3f(0.0, 0.0, 1.0));
    let comb_world = x * root.comb.x + cross(z, x) * root.comb.y + z * root.comb.z;
    // All that follows is in the head's bind pose.
    // Uniforms are read once: software adapters would read them again wherever they are used.
    let head = pose.head;
    let other_0 = pose.others[0];
    let other_1 = pose.others[1];
    let grid = field_grid();
    let margin = hair.margin;
    let per_lock_reach = hair.per_lock_reach;
    let per_combed_reach = hair.per_combed_reach;
    let posed_rows = mat3x3f(head[0].xyz, head[1].xyz, head[2].xyz);
    let head_position = vec3f(head[0].w, head[1].w, head[2].w);
    let start = posed_rows * (start_world - head_position);
    let normal = posed_rows * normal_world;
    let comb = posed_rows * comb_world;
    let down = posed_rows * vec3f(0.0, -1.0, 0.0);

    let first = FIRST_SEGMENT * root.length / f32(SEGMENTS);
    let own = root.random * 2.0 - 1.0;
    // Short strands have smaller curls: they are too short for a whole one.
    let curl_reach = min(style.curl_radius, CURL_SHARE * root.length);
    // Guides are the middle lines of locks.
    let curl_radius = select(curl_reach, 0.0, root.guide == IS_GUIDE);
    let lift = style.volume * root.random.z + curl_reach;
    let has_guide = root.guide < IS_GUIDE;
    let guide = select(0u, root.guide * POINT_STRIDE, has_guide);
    // Curls wind around the strand: beside it is what is across the plane that it bends in.
    let beside = normalize_or(cross(normal, down + comb), vec3f(1.0, 0.0, 0.0));
    var phase = vec2f(cos(root.phase), sin(root.phase));
    let out = number * POINT_STRIDE;
    points[out] = vec4f(start_world, 0.0);
    var before = start + normal * first;
    points[out + 1u] = vec4f(start_world + normal_world * first, first);
    var direction = normal;
    var skin_normal = normal;
    var near = 1.0;
    var skin: Near;
    for (var i = 2u; i <= SEGMENTS; i++) {
        let t = f32(i - 1u) * (1.0 / f32(SEGMENTS - 1u));
        let step = (root.length - first) * (f32(i + 1u) * (1.0 / STEP_SUM));
        // Along the skin: the skin stops the part of the comb's force that points into it.
        let combed = (comb - skin_normal * (dot(comb, skin_normal) * near)) * max(near, style.hold * (1.0 - t));
        let force = combed + own * (style.noise * t) + down * style.gravity - skin_normal * (style.tuck * t);
        // A force straight back is ignored: the sum might have no direction.
        let across = force - direction * min(dot(force, direction), 0.0);
        direction = normalize_or(direction + across * style.bend, direction);
        var next = before + direction * step;
        if has_guide {
            let toward = posed_rows * (vec4_of(guides, guide + i) - head_position) - next;
            let share = saturate(2.0 - length(toward) * per_lock_reach);
            next += toward * (style.clump * t * share);
        }
        skin = skin_at(grid, other_0, other_1, next, skin.shares);
        if root.region != SCALP {
            // Lids and brows move in the head's frame, and their hair is short: the plane of the skin at the
            // root takes the place of the field.
            skin.outward = normal;
            skin.distance = dot(next - start, normal);
        }
        let least = margin * min(4.0 * t, 1.0) + lift * min(3.0 * t, 1.0);
        next += skin.outward * max(least - min(skin.distance, skin.distance * DEEPER), 0.0);
        // Deep inside, the direction outward is inexact: once more from the new place.
        let again = saturate(-skin.distance / margin - 1.0);
        if again > 0.0 && root.region == SCALP {
            let there = skin_at(grid, other_0, other_1, next, skin.shares);
            next += there.outward * (max(least - there.distance, 0.0) * again);
            skin.distance = mix(skin.distance, there.distance, again);
            skin.outward = normalize_or(mix(skin.outward, there.outward, again), skin.outward);
            skin.shares = there.shares;
        }
        // A segment that is pushed out of the skin keeps its length by what leads along the skin, since it
        // has to stay as far out as it is. It may get shorter: at its full length it would end inside again.
        let out_part = skin.outward * dot(next - before, skin.outward);
        let along = next - before - out_part;
        let left = max(step * step - dot(out_part, out_part), 0.0) / max(dot(along, along), 1e-30);
        let segment = out_part + along * sqrt(min(left, 1.0));
        let segment2 = dot(segment, segment);
        let segment_length = sqrt(max(segment2, 1e-30));
        direction = select(direction, segment * (1.0 / segment_length), segment2 > 1e-20);
        before += direction * min(step, segment_length);
        let turn = style.curl_turn;
        phase = vec2f(turn.x * phase.x - turn.y * phase.y, turn.y * phase.x + turn.x * phase.y);
        let side = normalize_or(cross(direction, beside), normal);
        let curl = (beside * phase.x + side * phase.y) * (curl_radius * min(3.0 * t, 1.0));
        var placed = before + curl;
        if SWINGING && has_guide {
            let offset = posed_rows * textureLoad(offsets, texel_of(guide + i), 0).xyz;
            placed = swung(grid, placed, offset, skin, margin * min(4.0 * t, 1.0));
        }
        points[out + i] = vec4f(head_position + placed * posed_rows, max(skin.distance, least));
        skin_normal = skin.outward;
        near = saturate(1.0 - (skin.distance - least) * per_combed_reach);
    }
    points[out + SEGMENTS + 1u] = vec4f(normal_world, 0.0);
}
