//! Spaces, maps and what they lose.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests fail as tests do")]
#![allow(clippy::disallowed_methods, reason = "a test: it may read files and the environment")]

mod calibration;
mod loss;
mod maps;
mod retarget;
mod solving;
mod spaces;
