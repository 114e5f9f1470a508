//! `controls.toml`, `poses.toml` and `clips.toml`: how they are read and written, and those of the default
//! face.

mod entries;
mod controls;
mod poses;
mod clips;
mod write;

pub use controls::DEFAULT_CONTROLS_TOML;
pub use poses::DEFAULT_POSES_TOML;
