//! All tests of the crate in one program.

mod common;
mod naive;

mod wellformed;
mod malformed;
mod hostile;
mod round_trip;
mod transforms;
mod golden_makehuman;
mod crowd;
