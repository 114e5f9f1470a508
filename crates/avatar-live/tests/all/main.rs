//! Tests of the crate from outside.
#![allow(clippy::panic, clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, clippy::disallowed_types, reason = "tests read files")]

mod calibration;
mod chance;
mod controls;
mod formats;
mod hostile;
mod recording;
mod round_trips;
mod session;
mod smooth;
