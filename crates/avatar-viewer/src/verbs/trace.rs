use crate::cli::TraceArgs;
use crate::output;
use crate::usage::{self, usage};
use anyhow::Result;
use avatar_pack::Pack;
use pose_anim::{Player, Pose};
use std::borrow::Cow;
use std::io::Write;

/// More rows than this are a slip of the keyboard, not a wish.
const MAX_ROWS: f64 = 10_000_000.0;

pub(super) fn run(args: &TraceArgs) -> Result<()> {
    let pack = super::open(&args.pack)?.load_pack()?;
    let presses = parse_script(&args.script, &pack)?;
    // The product may lie a rounding error below a whole number of ticks.
    let last_row = (args.duration * args.hz * (1.0 + 1e-12)).floor();
    if last_row > MAX_ROWS {
        return Err(usage(format!("expected at most {MAX_ROWS} rows, found --hz × --duration = {last_row}")));
    }
    let rows = Rows { hz: args.hz, last: last_row as u64, derivatives: args.derivatives };
    output::stream(|out| trace(&pack, &presses, &rows, out))
}

/// `TIME POSE; TIME POSE; …` in the order of the times.
fn parse_script(script: &str, pack: &Pack) -> Result<Vec<(f64, Pose)>> {
    let mut presses = Vec::new();
    for entry in script.split(';').map(str::trim).filter(|entry| !entry.is_empty()) {
        let wrong =
            || usage(format!("--script: expected \"SECONDS POSE; SECONDS POSE; …\", found {entry:?}"));
        let (time, name) = entry.split_once(char::is_whitespace).ok_or_else(wrong)?;
        let time: f64 =
            time.parse().ok().filter(|time: &f64| time.is_finite() && *time >= 0.0).ok_or_else(wrong)?;
        presses.push((time, usage::pose(pack, name.trim())?));
    }
    presses.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    Ok(presses)
}

/// Which rows and columns to print.
struct Rows {
    hz: f64,
    last: u64,
    derivatives: bool,
}

fn trace(pack: &Pack, presses: &[(f64, Pose)], rows: &Rows, out: &mut impl Write) -> Result<()> {
    let mut player = Player::new(&pack.controls);
    let mut presses = presses.iter().peekable();
    let mut now = 0.0;
    write!(out, "t")?;
    let suffixes: &[&str] = if rows.derivatives { &["", "'", "''"] } else { &[""] };
    for suffix in suffixes {
        for control in pack.controls.controls() {
            write!(out, ",{}", quoted(&format!("{}{suffix}", control.name)))?;
        }
    }
    writeln!(out)?;
    for row in 0..=rows.last {
        let t = row as f64 / rows.hz;
        while let Some((time, pose)) = presses.next_if(|(time, _)| *time <= t) {
            player.advance(time - now)?;
            player.press(pose);
            now = *time;
        }
        player.advance(t - now)?;
        now = t;
        write!(out, "{t}")?;
        let columns = [player.values(), player.velocities(), player.accelerations()];
        for number in columns.iter().take(suffixes.len()).copied().flatten() {
            // The sum turns −0 into 0.
            write!(out, ",{}", number + 0.0)?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// A column's name as CSV wants it (RFC 4180).
fn quoted(name: &str) -> Cow<'_, str> {
    match name.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", name.replace('"', "\"\"")).into(),
        false => name.into(),
    }
}
