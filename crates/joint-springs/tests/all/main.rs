//! Tests of this crate.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod colliders;
mod constraints;
mod hostile;
mod motion;
mod rest;
mod scene;
