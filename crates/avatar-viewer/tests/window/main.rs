//! The window on a virtual display, driven by real keys and the mouse.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "tests and their helpers may fail"
)]

#[path = "../common/mod.rs"]
mod common;
mod desk;

mod keys;
mod look;
mod hair;
mod motion;
mod panel;
mod files;
mod speak;
mod live;
mod vrm;
