// Group 1: what earlier passes of this frame left for later ones.

@group(1) @binding(0) var shadow_map: texture_depth_2d_array;
@group(1) @binding(1) var shadow_sampler: sampler_comparison;
// One sample a pixel: depth and normals of what is opaque, how much ambient light reaches it, and light under the skin.
@group(1) @binding(2) var depth_texture: texture_depth_2d;
@group(1) @binding(3) var normal_texture_view: texture_2d<f32>;
@group(1) @binding(4) var occlusion_view: texture_2d<f32>;
@group(1) @binding(5) var skin_light: texture_2d<f32>;
// What the key sees of hair, see hair_shadow.wgsl.
@group(1) @binding(6) var hair_map: texture_2d<f32>;

// Distance along the view direction from reversed, infinite depth.
fn view_distance(depth: f32) -> f32 {
    return frame.near / max(depth, 1e-7);
}
