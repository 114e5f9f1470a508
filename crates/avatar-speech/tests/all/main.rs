//! Tests of the crate from outside.
#![allow(clippy::panic, clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

mod align;
mod formats;
mod heard;
mod hostile;
mod motion;
mod with_expressions;
