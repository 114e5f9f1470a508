// The eyeball's vertex stage, and what the cornea's curved front does to the look of the iris.

struct EyeOut {
    // Members of VertexOut: WGSL does not nest stage outputs.
    @invariant @builtin(position) position_clip: vec4f,
    @location(0) position_world: vec3f,
    @location(1) normal_world: vec3f,
    @location(2) uv: vec2f,
    @location(3) depth: f32,
    @location(4) curvature: f32,
    @location(5) position_bind: vec3f,
    // From the point to the viewer, turned back to bind pose.
    @location(6) to_eye_bind: vec3f,
}

// The rows of the eye's bone matrix, for all vertices alike.
struct BoneIn {
    @location(5) row_x: vec4f,
    @location(6) row_y: vec4f,
    @location(7) row_z: vec4f,
}

fn eye_out(in: VertexIn, bone: BoneIn) -> EyeOut {
    let vertex = vertex_out(in);
    let to_eye = frame.eye_world - in.position_world;
    // The matrix is rigid: its transpose turns back.
    let to_eye_bind = bone.row_x.xyz * to_eye.x + bone.row_y.xyz * to_eye.y + bone.row_z.xyz * to_eye.z;
    return EyeOut(
        vertex.position_clip, vertex.position_world, vertex.normal_world, vertex.uv, vertex.depth,
        vertex.curvature, in.bind_position_u.xyz, to_eye_bind);
}

@vertex
fn eye_vertex_main(in: VertexIn, bone: BoneIn) -> EyeOut {
    return eye_out(in, bone);
}

fn vertex_of(in: EyeOut) -> VertexOut {
    return VertexOut(
        in.position_clip, in.position_world, in.normal_world, in.uv, in.depth, in.curvature, 0.0);
}

struct IrisView {
    uv: vec2f,
    // 1 under the cornea, 0 on the white.
    inside: f32,
    // Distance from the middle, 1 at the edge of the iris.
    radius: f32,
}

// The distance in the painted iris at which a point of the iris lies, for the present size of the pupil; the
// edge of the iris stays.
fn painted_radius(radius: f32) -> f32 {
    let iris = material.iris;
    if radius < iris.pupil {
        return radius * iris.painted_pupil / iris.pupil;
    }
    let share = (radius - iris.pupil) / max(1.0 - iris.pupil, 1e-4);
    return mix(iris.painted_pupil, 1.0, min(share, 1.0)) + max(radius - 1.0, 0.0);
}

// Where a point beside the axis is painted.
fn iris_uv(from_axis: vec2f) -> vec2f {
    let iris = material.iris;
    let r = length(from_axis);
    let last = 4u * PROFILE_ROWS - 1u;
    let at = min(sqrt(r / iris.profile_reach), 1.0) * f32(last);
    let below = min(u32(at), last - 1u);
    let painted = mix(
        iris.profile[below / 4u][below % 4u],
        iris.profile[(below + 1u) / 4u][(below + 1u) % 4u],
        at - f32(below));
    let direction = from_axis / max(r, 1e-6);
    return iris.uv_center + (iris.uv_from_x * direction.x + iris.uv_from_y * direction.y) * painted;
}

// Where the line of sight meets the iris: in through the cornea's sphere, bent by Snell's law, on to the
// plane of the iris. J. Jimenez, "Next-Generation Character Rendering", 2013; G. François et al.,
// "Image-based modeling of the human eye", 2009.
fn iris_view(in: EyeOut) -> IrisView {
    let iris = material.iris;
    let center = iris.cornea_center.xy;
    let here = length(in.position_bind.xy - center) / max(iris.radius, 1e-6);
    let in_front = select(0.0, 1.0, in.position_bind.z > iris.cornea_center.z);
    var view = IrisView(in.uv, 0.0, here);
    if !EYE_OPTICS || iris.radius <= 0.0 {
        return view;
    }
    view.inside = in_front * (1.0 - smoothstep(0.98, 1.12, here));
    let toward_eye = normalize(in.to_eye_bind);
    let from_center = in.position_bind - iris.cornea_center;
    let b = dot(from_center, toward_eye);
    let under_root = b * b - dot(from_center, from_center) + iris.cornea_radius * iris.cornea_radius;
    let entry = from_center + toward_eye * (sqrt(max(under_root, 0.0)) - b);
    let normal = normalize(entry);
    let bent = refract(-toward_eye, normal, 1.0 / iris.refractive_index);
    // At grazing views the ray may leave sideways; it never runs along the plane.
    let down = min(bent.z, -0.05);
    let reach = (iris.plane_z - iris.cornea_center.z - entry.z) / down;
    let met = entry.xy + bent.xy * max(reach, 0.0);
    let radius = length(met) / iris.radius;
    let refracted = iris_uv(met * (painted_radius(radius) / max(radius, 1e-4)));
    view.uv = mix(in.uv, refracted, view.inside);
    view.radius = mix(here, radius, view.inside);
    return view;
}

// The limbus: iris and white do not meet at a line, a dark ring lies between them.
fn limbal(radius: f32) -> f32 {
    let iris = material.iris;
    let off = (radius - 1.0) / max(iris.limbal_width, 1e-3);
    return 1.0 - iris.limbal_darkness * exp(-4.0 * off * off);
}
