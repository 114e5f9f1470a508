//! The window on a virtual display, driven by real keys and the mouse.

#[path = "../common/mod.rs"]
mod common;
mod desk;

mod keys;
mod look;
mod hair;
mod panel;
mod files;
