// How much ambient light the neighbourhood hides, from depth and normals: lids over eyes, lips over teeth,
// the chin over the neck. L. Bavoil and M. Sainz, "Multi-Layer Dual-Resolution Screen-Space Ambient
// Occlusion", 2009, without noise: the pattern is its own mirror image.

const DIRECTIONS: i32 = 8;
const STEPS: i32 = 4;
// Lower angles come from the curvature of the surface itself.
const LOWEST_SINE: f32 = 0.18;
const STRENGTH: f32 = 1.1;

@vertex
fn picture_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    // One triangle that covers the picture.
    return vec4f(f32(i32(i & 1u) * 4 - 1), f32(i32(i >> 1u) * 4 - 1), 0.0, 1.0);
}

fn position_at(pixel: vec2i) -> vec3f {
    let depth = textureLoad(depth_texture, pixel, 0);
    let clip = vec2f(2.0, -2.0) * (vec2f(pixel) + 0.5) / frame.pixels + vec2f(-1.0, 1.0);
    let near = frame.world_from_clip * vec4f(clip, 1.0, 1.0);
    let on_near = near.xyz / near.w;
    // Along one line of sight, the distance from the eye is proportional to 1 / depth.
    return frame.eye_world + (on_near - frame.eye_world) / max(depth, 1e-7);
}

@fragment
fn occlusion_main(@builtin(position) position_clip: vec4f) -> @location(0) vec4f {
    let center = vec2i(position_clip.xy);
    let depth = textureLoad(depth_texture, center, 0);
    if depth <= 0.0 {
        return vec4f(1.0);
    }
    let here = position_at(center);
    let normal = normalize(textureLoad(normal_texture_view, center, 0).xyz * 2.0 - 1.0);
    let radius = frame.occlusion_radius;
    let pixels = clamp(radius * frame.pixels_per_unit / view_distance(depth), 2.0, 160.0);
    let last = vec2i(frame.pixels) - 1;
    var hidden = 0.0;
    for (var i = 0; i < DIRECTIONS; i++) {
        let angle = (f32(i) + 0.5) * 6.2831853 / f32(DIRECTIONS);
        let direction = vec2f(cos(angle), sin(angle));
        var highest = LOWEST_SINE;
        var of_direction = 0.0;
        for (var s = 1; s <= STEPS; s++) {
            let share = f32(s) / f32(STEPS);
            let pixel = center + vec2i(round(direction * pixels * share * share));
            if any(pixel < vec2i(0)) || any(pixel > last) {
                continue;
            }
            let to = position_at(pixel) - here;
            let distance = length(to);
            let sine = dot(to, normal) / max(distance, 1e-6);
            let near = saturate(1.0 - distance * distance / (radius * radius));
            if sine > highest && distance > 0.0 {
                of_direction += (sine - highest) * near;
                highest = sine;
            }
        }
        hidden += of_direction;
    }
    return vec4f(saturate(1.0 - STRENGTH * hidden / f32(DIRECTIONS)));
}
