use glam::Vec3;

/// Segments of a strand.
pub const SEGMENTS: usize = 12;

/// The points of a strand, from the root to the tip.
pub type Strand = [Vec3; SEGMENTS + 1];
