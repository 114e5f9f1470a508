// Group 1 of all lit programs: what lamps see.

@group(1) @binding(0) var shadow_map: texture_depth_2d_array;
@group(1) @binding(1) var shadow_sampler: sampler_comparison;
// What the key sees of hair, see hair_shadow.wgsl.
@group(1) @binding(2) var hair_map: texture_2d<f32>;
