// Strands as ribbons, for all passes that draw them: which of them, where their points are, how wide they
// are.

// Which strands a pass draws.
struct HairView {
    // Number of strands, not rounded.
    strands: f32,
    // How many of the last strands fade.
    fading: f32,
    // Factor on the widths that strands have if all are drawn.
    width: f32,
    // Width in pixels below which a strand fades instead of getting thinner.
    least_pixels: f32,
    // The same as `width`, of brows and lashes.
    other_width: f32,
    // From one drawn point of a strand to the next.
    stride: u32,
    // Pieces that are drawn from one point of a strand to the next.
    pieces: u32,
    // Width where strands leave the skin, by what they have further out.
    root_width: f32,
}

@group(2) @binding(0) var<uniform> hair: Hair;
@group(2) @binding(1) var roots: texture_2d<u32>;
@group(2) @binding(2) var<storage, read> points: array<vec4f>;
@group(3) @binding(0) var<uniform> hair_view: HairView;

// A point of a strand.
struct StrandPoint {
    position: vec3f,
    // Above the head.
    height: f32,
    tangent: vec3f,
    // 0 at the root, 1 at the tip.
    along: f32,
    // Of the skin at the root.
    normal: vec3f,
    radius: f32,
}

// The region of a strand, and its thickness in 255ths in the next eight bits.
fn kind_of(strand: u32) -> u32 {
    return textureLoad(roots, texel_of(4u * strand), 0).w;
}

fn random_of(strand: u32) -> vec3f {
    return bitcast<vec3f>(textureLoad(roots, texel_of(4u * strand + 3u), 0).xyz);
}

struct Curve {
    position: vec3f,
    along: vec3f,
}

// A strand that curls, between the points of numbers `i` and `i + 1`, from the points before to after these.
// Around the middle of a curl each point is turned by the same angle from the one before: the second
// difference of points says where the middle is, as that of a helix is its radius times 2 cos(turn) - 2.
fn curve_at(before: vec3f, a: vec3f, b: vec3f, after: vec3f, t: f32, i: u32, turn: vec2f) -> Curve {
    let way = b - a;
    if i > 0u && i + 2u <= SEGMENTS && abs(turn.y) > 0.2 {
        let per_radius = 1.0 / (2.0 * turn.x - 2.0);
        let from_middle = (before - 2.0 * a + b) * per_radius;
        let to_middle = (a - 2.0 * b + after) * per_radius;
        let angle = atan2(turn.y, turn.x);
        let shares = vec2f(sin((1.0 - t) * angle), sin(t * angle)) / turn.y;
        let speeds = vec2f(-cos((1.0 - t) * angle), cos(t * angle)) * (angle / turn.y);
        let middle_way = way + from_middle - to_middle;
        return Curve(
            a - from_middle + middle_way * t + from_middle * shares.x + to_middle * shares.y,
            middle_way + from_middle * speeds.x + to_middle * speeds.y);
    }
    // A curve through the points: E. Catmull and R. Rom, "A Class of Local Interpolating Splines", 1974.
    let in = 0.5 * (b - before);
    let out = 0.5 * (after - a);
    let square = 3.0 * way - 2.0 * in - out;
    let cube = in + out - 2.0 * way;
    return Curve(a + t * (in + t * (square + t * cube)), in + t * (2.0 * square + t * 3.0 * cube));
}

// `corner` counts the corners of the ribbon, two at each point.
fn strand_point(strand: u32, corner: u32, kind: u32) -> StrandPoint {
    let region = kind & 255u;
    let style = hair.regions[region];
    let piece = corner / 2u;
    let i = piece / hair_view.pieces * hair_view.stride;
    let between = f32(piece % hair_view.pieces) / f32(hair_view.pieces);
    let first = strand * (SEGMENTS + 2u);
    let here = points[first + i];
    let before = points[first + max(i, hair_view.stride) - hair_view.stride].xyz;
    let after = points[first + min(i + hair_view.stride, SEGMENTS)];
    var point: StrandPoint;
    point.position = here.xyz;
    point.height = here.w;
    var along = after.xyz - before;
    if hair_view.pieces > 1u {
        let next = points[first + min(i + 2u, SEGMENTS)].xyz;
        let curve = curve_at(before, here.xyz, after.xyz, next, between, i, style.curl_turn);
        point.position = curve.position;
        point.height = mix(here.w, after.w, between);
        along = curve.along;
    }
    point.tangent = normalize(along + vec3f(1e-9, 0.0, 0.0));
    point.along = (f32(i) + between) / f32(SEGMENTS);
    point.normal = points[first + SEGMENTS + 1u].xyz;
    // Strands near the cut fade, so that they do not pop where the cut moves.
    let share = saturate((hair_view.strands - f32(strand)) / max(hair_view.fading, 1e-3));
    let factor = select(hair_view.other_width, hair_view.width, region == SCALP);
    // Strands that stand for several leave the skin thinner: where they part, their ends would be a row of
    // wide stubs.
    let leaves = mix(hair_view.root_width, 1.0, saturate(0.5 * (f32(i) + between)));
    let width = hair.width_factor * factor * share * (f32(kind >> 8u) * (1.0 / 255.0));
    point.radius = mix(style.root_radius, style.tip_radius, point.along) * width * leaves;
    return point;
}

// The share of a lamp's light that nothing but hair blocks at a point of a strand. One sample is enough: the
// light of a strand changes evenly between its points, and their places differ from strand to strand, which
// makes edges of shadows on a lock soft. Toon style draws hard edges of two tones, where steps would be seen.
fn strand_visibility(lamp: u32, position: vec3f, normal: vec3f) -> f32 {
    return sampled_visibility(lamp, position, normal, select(0, SHADOW_REACH, TOON));
}

// From the middle of a strand to the side, across the direction of view.
fn strand_side(tangent: vec3f, to_eye: vec3f) -> vec3f {
    let across = cross(tangent, to_eye);
    return across / max(length(across), 1e-4);
}

fn corner_sign(corner: u32) -> f32 {
    return select(-1.0, 1.0, (corner & 1u) == 0u);
}

struct RibbonCorner {
    position_clip: vec4f,
    // Width of the strand, and distance from its middle, in pixels.
    pixels: f32,
    off: f32,
}

// With several samples per pixel, strands fade below this share of the least width, because samples are
// nearer to one another than pixels. Wider strands would flicker less, and look noisier in a still picture.
const LEAST_OF_SAMPLES: f32 = 0.35;

// A corner of the ribbon that is drawn for a strand. Where pixels have one sample, it reaches over all pixels
// that the strand touches; where they have several, it is wide enough to meet one.
fn ribbon_corner(point: StrandPoint, corner: u32) -> RibbonCorner {
    let middle = frame.clip_from_world * vec4f(point.position, 1.0);
    let per_pixel = max(middle.w, 1e-6) / frame.pixels_per_unit;
    let pixels = 2.0 * point.radius / per_pixel;
    let least = hair_view.least_pixels;
    let drawn = select(pixels + least, max(pixels, LEAST_OF_SAMPLES * least), COVERAGE_MASK);
    let to_eye = normalize(frame.eye_world - point.position);
    let side = strand_side(point.tangent, to_eye) * corner_sign(corner);
    let position = point.position + side * (0.5 * drawn * per_pixel);
    return RibbonCorner(
        frame.clip_from_world * vec4f(position, 1.0), pixels, 0.5 * drawn * corner_sign(corner));
}
