//! Tests of avatar-pack as its users see it, in one binary.

mod apart;
mod common;
mod contents;
mod export;
mod export_targets;
mod faces;
mod further;
mod gaze;
mod growth;
mod hair;
mod identity;
mod levels;
mod materials;
mod pack;
mod pictures;
mod looks;
mod poses;
mod raw;
mod recording;
mod reach;
mod sliders;
mod springs;
mod retarget;
mod vrm;
mod vrm_springs;
mod crowd;
