//! From the solid to half a mesh: places for vertices, triangles between them, and the swept parts.

pub mod chart;
pub mod half;
pub mod ear_root;
pub mod rings;
pub mod delaunay;
pub mod scatter;
pub mod sheet;
pub mod socket;
pub mod mouth_bag;
pub mod ear;
pub mod lashes;
