// Group 2: the looks of one part, shared by all avatars of a model.

struct Iris {
    // The sphere that the cornea is a part of, at bind pose.
    cornea_center: vec3f,
    cornea_radius: f32,
    // How the ball is painted around its axis: the middle, directions in the texture for x and y, and the
    // distance in the texture over the root of the distance at bind pose, up to a reach.
    uv_center: vec2f,
    uv_from_x: vec2f,
    uv_from_y: vec2f,
    profile_reach: f32,
    // Where the plane of the iris lies at bind pose.
    plane_z: f32,
    profile: array<vec4f, PROFILE_ROWS>,
    // 0 if there is no iris to refract.
    radius: f32,
    refractive_index: f32,
    pupil: f32,
    painted_pupil: f32,
    limbal_width: f32,
    limbal_darkness: f32,
    color: vec3f,
    // Radius of the iris in the texture; 0 if its colour stays.
    uv_radius: f32,
    painted_color: vec3f,
}

// Lengths are in the world's units here.
struct Material {
    color: vec3f,
    opacity: f32,
    wrap: vec3f,
    reflectance: f32,
    // The parameter d of Burley's profile.
    scatter: vec3f,
    roughness_matte: f32,
    roughness_glossy: f32,
    normal_strength: f32,
    sharp_share: f32,
    sharp_roughness: f32,
    transmission: f32,
    thickness: f32,
    pore_strength: f32,
    // Tiles over the texture's width.
    pore_density: f32,
    // Tiles over a unit of length.
    pores_per_length: f32,
    wetness: f32,
    film_roughness: f32,
    back_light: f32,
    // Largest z at bind pose (the face looks along +Z), and 1 / (largest - smallest).
    front_z: f32,
    per_depth: f32,
    // Which textures are there, the others are not sampled; and how colours are made.
    textures: u32,
    // Of surfaces of interchange files from here to `iris`. Which textures lie by the second coordinates.
    second_uvs: u32,
    shade_color: vec3f,
    // Below this opacity nothing is drawn.
    alpha_cutoff: f32,
    emissive: vec3f,
    metallic: f32,
    outline_color: vec3f,
    outline_width: f32,
    occlusion_strength: f32,
    shading_shift: f32,
    shading_toony: f32,
    // Below this opacity no shadow is cast.
    shadow_cutoff: f32,
    // What the colour of bare skin is multiplied by, and its green as a share of its red in the texture.
    tone: vec3f,
    bare_green: f32,
    wrinkle_depth: f32,
    iris: Iris,
}

@group(2) @binding(0) var<uniform> material: Material;
@group(2) @binding(1) var color_texture: texture_2d<f32>;
@group(2) @binding(2) var occlusion_texture: texture_2d<f32>;
@group(2) @binding(3) var gloss_texture: texture_2d<f32>;
@group(2) @binding(4) var normal_texture: texture_2d<f32>;
@group(2) @binding(5) var thickness_texture: texture_2d<f32>;
// How deep wrinkles are.
@group(2) @binding(11) var wrinkle_texture: texture_2d<f32>;
// Of each texture, what lies beyond its edges.
@group(2) @binding(6) var color_sampler: sampler;
@group(2) @binding(7) var occlusion_sampler: sampler;
@group(2) @binding(8) var gloss_sampler: sampler;
@group(2) @binding(9) var normal_sampler: sampler;
@group(2) @binding(10) var thickness_sampler: sampler;
