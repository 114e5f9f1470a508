// Group 0: what all avatars of a frame share.

// A distant lamp. Radiance 1 lights a white matte surface that faces the lamp to 1.
struct Lamp {
    direction_world: vec3f, // toward the lamp, unit length
    radiance: vec3f,
}

struct Frame {
    clip_from_world: mat4x4f,
    eye_world: vec3f,
    exposure: f32,
    lamps: array<Lamp, LAMP_COUNT>,
    sky: vec3f,
    ground: vec3f,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var repeat_sampler: sampler;
