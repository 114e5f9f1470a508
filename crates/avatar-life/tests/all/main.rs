//! Tests of living faces.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "helpers of tests fail as tests do")]

mod common;
mod controls;
mod face;
mod frame_rates;
mod smooth;
mod statistics;
mod targets;
