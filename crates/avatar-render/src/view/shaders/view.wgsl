// Group 1 of programs that draw parts: the results of earlier passes of this frame, one sample per pixel:
// depth and normals of opaque parts, how much ambient light reaches them, and light under the skin.

@group(1) @binding(3) var depth_texture: texture_depth_2d;
@group(1) @binding(4) var normal_texture_view: texture_2d<f32>;
@group(1) @binding(5) var occlusion_view: texture_2d<f32>;
@group(1) @binding(6) var skin_light: texture_2d<f32>;

// The share of ambient light that ambient occlusion leaves at this pixel.
fn view_occlusion(position_clip: vec4f) -> f32 {
    if OCCLUSION_VIEW {
        return textureLoad(occlusion_view, vec2i(position_clip.xy), 0).r;
    }
    return 1.0;
}
