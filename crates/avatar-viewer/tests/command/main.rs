//! The command line: what every verb prints and writes, and what it says to bad input.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "tests and their helpers may fail"
)]

#[path = "../common/mod.rs"]
mod common;

mod alpha;
mod bad_input;
mod contract;
mod convert;
mod expected_data;
mod hair;
mod identity;
mod import;
mod levels;
mod life;
mod live;
mod look;
mod mirrored;
mod outputs;
mod places;
mod record;
#[cfg(unix)]
mod safety;
mod shapes;
mod snapshots;
mod spaces;
mod speech;
mod springs;
mod stage;
mod words;
