use crate::cli::KeysArgs;
use crate::output;
use crate::window::keys::{MOUSE, WINDOW_KEYS};
use anyhow::Result;
use std::fmt::Write;

pub(super) fn run(args: &KeysArgs) -> Result<()> {
    let pack = super::open(&args.pack)?.load_pack()?;
    let mut out = String::new();
    for pose in pack.poses.iter() {
        if let Some(key) = &pose.key {
            let _ = writeln!(out, "{key:<12} pose {}", pose.name);
        }
    }
    for (_, name, meaning, _) in WINDOW_KEYS {
        let _ = writeln!(out, "{name:<12} {meaning}");
    }
    for (gesture, meaning) in MOUSE {
        let _ = writeln!(out, "{:<12} {meaning}", format!("mouse {gesture}"));
    }
    output::print(&out)
}
