//! Generates the default avatar: the head of a Martian woman, as a pack of raw meshes, joints and pictures.
//!
//! The head is a solid, written as one distance-like function ([`form`]). The outer skin is drawn from it: a
//! chart ([`surface::chart`]) gives every place on the head a ray, rows of vertices follow eyes, mouth and
//! ears, the rest is scattered by need and joined by a Delaunay triangulation. What is thin or hidden (edges
//! of the lids, sockets, mouth bag, ears) is swept onto the open rows. Only the left half is built; the right
//! half is its mirror image. Shapes are displacement fields over the half ([`shapes`]), weights are functions
//! of the place ([`weights`]).
//!
//! The result depends on nothing but this source: no clock, no chance, no hash order, no platform
//! mathematics.

pub mod math;
pub mod anatomy;
pub mod cheek;
pub mod lids;
pub mod mesh;
pub mod parts;
pub mod rig;
pub mod sdf;
pub mod form;
pub mod surface;
pub mod crease;
pub mod layout;
pub mod shapes;
pub mod weights;
pub mod skin;
pub mod sculpture;
pub mod arkit;
pub mod raw;
pub mod bake;
pub mod paint;
pub mod pack;

#[cfg(test)]
mod tests;

pub use pack::{Pack, build};
pub use paint::{Complexion, Detail};
