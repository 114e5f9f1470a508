use crate::cli::KeysArgs;
use crate::standard;
use crate::window::keys::{Keys, MOUSE};
use anyhow::Result;
use std::fmt::Write;

pub(super) fn run(args: &KeysArgs) -> Result<()> {
    let pack = super::open(&args.pack)?.load_pack()?;
    let mut out = String::new();
    for pose in pack.poses().iter() {
        if let Some(key) = &pose.key {
            let _ = writeln!(out, "{key:<24} pose {}", pose.name);
        }
    }
    for clip in &pack.clips().clips {
        if let Some(key) = &clip.key {
            let _ = writeln!(out, "{key:<24} clip {}", clip.name);
        }
    }
    for (name, row) in Keys::load()?.rows() {
        let _ = writeln!(out, "{name:<24} {}", row.meaning);
    }
    for (gesture, meaning) in MOUSE {
        let _ = writeln!(out, "{:<24} {meaning}", format!("mouse {gesture}"));
    }
    standard::print(&out)
}
