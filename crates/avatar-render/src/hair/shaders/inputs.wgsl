// Group 1, for strands: what earlier passes over hair left for later ones, where pixels have one sample.

// Where strands lie, see layers.wgsl.
@group(1) @binding(3) var hair_layers: texture_2d<f32>;
// How much they cover in each slice of their depth, see slices.wgsl.
@group(1) @binding(4) var front_slices: texture_2d<f32>;
@group(1) @binding(5) var back_slices: texture_2d<f32>;
