// Group 0: what all avatars of a frame share.

// A distant lamp. Radiance 1 lights a white matte surface that faces the lamp to 1.
struct Lamp {
    direction_world: vec3f, // toward the lamp, unit length
    radiance: vec3f,
}

struct Frame {
    clip_from_world: mat4x4f,
    world_from_clip: mat4x4f,
    eye_world: vec3f,
    exposure: f32,
    lamps: array<Lamp, LAMP_COUNT>,
    // The environment without its panels: straight above and straight below.
    sky: vec3f,
    tone_map: u32,
    ground: vec3f,
    // Distance of the near plane.
    near: f32,
    // The environment's diffuse light in spherical harmonics.
    irradiance: array<vec3f, 9>,
    shadow_from_world: array<mat4x4f, SHADOW_COUNT>,
    // Length in the world of the shadow map's depth 0…1, per shadow.
    shadow_depth: vec2f,
    // Length in the world of a texel of the shadow map, per shadow.
    shadow_texel: vec2f,
    // Width and height of the picture.
    pixels: vec2f,
    // Pixels that a unit of the world covers at distance 1.
    pixels_per_unit: f32,
    // Reach of ambient occlusion, in the world.
    occlusion_radius: f32,
    // How far the edges of shadows are softened, in the world.
    shadow_softness: f32,
    // The last mip level of the reflections.
    reflection_levels: f32,
    // 1 where hair casts shadows, else 0.
    hair_shadow: f32,
    // Hair lies nearer than `hair_far`; the next is 1 / (the depth of the space that it fills).
    hair_far: f32,
    hair_per_depth: f32,
    // Light under the skin is stored between passes multiplied by this.
    pre_exposure: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var repeat_sampler: sampler;
@group(0) @binding(2) var clamp_sampler: sampler;
// Scale and bias of the reflectance over cosine and roughness.
@group(0) @binding(3) var split_sum_table: texture_2d<f32>;
// Diffuse light over cosine and scattering distance times curvature.
@group(0) @binding(4) var scatter_table: texture_2d<f32>;
// The environment, blurred more from level to level.
@group(0) @binding(5) var reflections: texture_cube<f32>;
// Tangent-space normals of pores, tiled.
@group(0) @binding(6) var pores: texture_2d<f32>;

// Distance along the view direction from reversed, infinite depth.
fn view_distance(depth: f32) -> f32 {
    return frame.near / max(depth, 1e-7);
}
