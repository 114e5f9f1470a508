// Grows every strand anew on the deformed skin. The twin on the CPU is avatar_groom::grow, line by line.

struct DeformedVertex {
    position: vec3f,
    normal: vec3f,
}

@group(0) @binding(0) var<uniform> hair: Hair;
@group(0) @binding(1) var<storage, read> roots: array<Root>;
@group(0) @binding(2) var<storage, read> hull: array<f32>;
// Per strand its points with their height above the head in w, then the normal of the skin at the root.
@group(0) @binding(3) var<storage, read_write> points: array<vec4f>;
@group(2) @binding(0) var<storage, read> deformed: array<DeformedVertex>;

fn normalize_or(v: vec3f, other: vec3f) -> vec3f {
    let length2 = dot(v, v);
    return select(other, v * inverseSqrt(max(length2, 1e-30)), length2 > 1e-20);
}

// Q. Meyer et al., "On Floating-Point Normal Vectors", 2010: the octahedron around the sphere, unfolded, 0…1.
fn square_from_direction(d: vec3f) -> vec2f {
    let flat = d.xz / max(abs(d.x) + abs(d.y) + abs(d.z), 1e-12);
    let signs = select(vec2f(1.0), vec2f(-1.0), flat < vec2f(0.0));
    let folded = select(flat, (1.0 - abs(flat.yx)) * signs, d.y < 0.0);
    return folded * 0.5 + 0.5;
}

fn hull_radius(direction: vec3f) -> f32 {
    let last = f32(HULL_SIZE - 1u);
    let place = clamp(square_from_direction(direction) * f32(HULL_SIZE) - 0.5, vec2f(0.0), vec2f(last));
    let low = min(floor(place), vec2f(last - 1.0));
    let share = place - low;
    let at = u32(low.y) * HULL_SIZE + u32(low.x);
    return mix(
        mix(hull[at], hull[at + 1u], share.x),
        mix(hull[at + HULL_SIZE], hull[at + HULL_SIZE + 1u], share.x),
        share.y);
}

// From the head's middle, at bind pose.
fn from_middle(point: vec3f) -> vec3f {
    let head = posed_from_bind[hair.head_bone];
    let d = point - vec3f(head[0].w, head[1].w, head[2].w);
    return head[0].xyz * d.x + head[1].xyz * d.y + head[2].xyz * d.z - hair.hull_center;
}

fn outside(point: vec3f) -> vec3f {
    let from_center = from_middle(point);
    let distance = length(from_center);
    if distance <= 0.0 {
        return point;
    }
    let direction = from_center / distance;
    let least = hull_radius(direction) + hair.margin;
    if distance >= least {
        return point;
    }
    let head = posed_from_bind[hair.head_bone];
    let push = direction * (least - distance);
    return point + vec3f(dot(head[0].xyz, push), dot(head[1].xyz, push), dot(head[2].xyz, push));
}

fn tuft_number(tuft: u32, salt: u32) -> f32 {
    var v = (tuft * 0x9E3779B1u) ^ salt;
    v = (v ^ (v >> 15u)) * 0x2C1B3C6Du;
    v = (v ^ (v >> 12u)) * 0x297A2D39u;
    return f32((v ^ (v >> 15u)) >> 8u) / 8388608.0 - 1.0;
}

@compute @workgroup_size(GROW_WORKGROUP_SIZE)
fn grow_main(@builtin(global_invocation_id) id: vec3u) {
    let strand = id.x;
    if strand >= hair.strand_count {
        return;
    }
    let root = roots[strand];
    let style = hair.regions[root.region];
    let a = deformed[root.corners.x];
    let b = deformed[root.corners.y];
    let c = deformed[root.corners.z];
    let w = root.barycentric;
    let start = a.position * w.x + b.position * w.y + c.position * w.z;
    let normal = normalize_or(a.normal * w.x + b.normal * w.y + c.normal * w.z, vec3f(0.0, 1.0, 0.0));
    let x = normalize_or(b.position - a.position, vec3f(1.0, 0.0, 0.0));
    let z = normalize_or(cross(x, c.position - a.position), vec3f(0.0, 0.0, 1.0));
    let comb = x * root.comb.x + cross(z, x) * root.comb.y + z * root.comb.z;
    let strand_length = style.length * (1.0 - style.length_variation * root.random.x);
    let first_step = FIRST_SEGMENT * strand_length / f32(SEGMENTS);
    let step = (strand_length - first_step) / f32(SEGMENTS - 1u);
    let own = root.random.yzw * 2.0 - 1.0;
    let tuft = vec3f(tuft_number(root.tuft, 1u), tuft_number(root.tuft, 2u), tuft_number(root.tuft, 3u));
    let aside = own * style.noise + tuft * style.clump;

    var strand_points: array<vec3f, SEGMENTS + 1u>;
    strand_points[0] = start;
    var direction = normal;
    for (var i = 1u; i <= SEGMENTS; i++) {
        let t = f32(i - 1u) / f32(SEGMENTS);
        let before = strand_points[i - 1u];
        if i == 1u {
            strand_points[i] = before + direction * first_step;
            continue;
        }
        let pull = vec3f(0.0, -style.gravity * (0.3 + 3.0 * t), 0.0);
        let wanted = normalize_or(comb * (1.0 - t) + aside * min(2.0 * t, 1.0) + pull, direction);
        direction = normalize_or(direction + (wanted - direction) * style.bend, direction);
        direction = normalize_or(outside(before + direction * step) - before, direction);
        strand_points[i] = before + direction * step;
    }

    // Curls: the strand winds around itself, more toward the tip.
    let along = normalize_or(strand_points[SEGMENTS] - strand_points[1], vec3f(0.0, -1.0, 0.0));
    let beside = select(vec3f(0.0, 1.0, 0.0), vec3f(1.0, 0.0, 0.0), abs(along.x) < 0.8);
    let side = normalize_or(cross(along, beside), vec3f(0.0, 0.0, 1.0));
    let other = cross(along, side);
    let first = strand * (SEGMENTS + 2u);
    for (var i = 0u; i <= SEGMENTS; i++) {
        var point = strand_points[i];
        if i >= 2u && style.curl_radius > 0.0 {
            let t = f32(i - 1u) / f32(SEGMENTS - 1u);
            let angle = 6.2831853 * (style.curl_turns * t + root.random.w);
            point += (side * cos(angle) + other * sin(angle)) * (style.curl_radius * min(t, 0.35) / 0.35);
        }
        let from_center = from_middle(point);
        let distance = length(from_center);
        points[first + i] = vec4f(point, distance - hull_radius(from_center / max(distance, 1e-6)));
    }
    points[first + SEGMENTS + 1u] = vec4f(normal, 0.0);
}
