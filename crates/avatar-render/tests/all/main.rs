//! All tests of the crate from outside, in one program: it opens the adapter once, and tests share the
//! shaders they compile.
//!
//! `cargo test -p avatar-render --test all eyes` runs those of one module.

mod common;

// From the mesh to the picture, as the crate's own modules stand.
mod bad_input;
mod deform;
mod turning;
mod hair;
mod hair_motion;
mod hair_shadows;
mod strands;
mod drafts;
mod targets;
mod frames;
mod limits;
mod pixels;
mod opacity;
mod standard;
mod textures;
mod crowd;
mod crowds;
mod views;
mod welded;
mod mirror;
mod tone;
mod energy;
mod terms;
mod shadows;
mod scattering;
mod colors;
mod eyes;
mod wrinkles;
mod labels;
