//! From the solid to half a mesh: places for vertices, triangles between them, and the swept parts.

pub mod chart;
pub mod delaunay;
pub mod ear;
pub mod half;
pub mod mouth_bag;
pub mod rings;
pub mod scatter;
pub mod sheet;
pub mod socket;
