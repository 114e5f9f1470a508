//! Tests of avatar-mesh as its users see it, in one binary; those that count allocations have one of their
//! own.

mod common;
mod blend;
mod coherence;
mod crowd;
mod deform;
mod deform_bounds;
mod definitions;
mod drivers;
mod golden_makehuman;
mod influences;
mod offsets;
mod raw;
mod raw_shapes;
mod sequence;
mod shape;
mod simplify;
mod space;
mod turning;
mod validate;
mod weld;
