//! All tests of the crate in one program, but those that count allocations.

mod controls;
mod default_poses;
mod toml_errors;
mod easing;
mod player;
mod recording;
mod targets;
mod clips;
mod clip_ends;
mod long_times;
mod layers;
mod joints;
mod scripts;
mod crowd;
