//! Draws rigged faces with wgpu: deformation in WGSL, skin, teeth, eyes and corneas.
