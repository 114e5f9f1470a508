use crate::cli::TraceArgs;
use crate::ending;
use crate::life_args::Living;
use crate::output::{Contents, OutputFile};
use crate::script::Script;
use crate::speech::Spoken;
use crate::usage::usage;
use anyhow::Result;
use avatar_pack::Pack;
use std::borrow::Cow;
use std::io::Write;

/// More rows than this are a slip of the keyboard, not a wish.
const MAX_ROWS: f64 = 10_000_000.0;

pub(super) fn run(args: &TraceArgs) -> Result<()> {
    ending::format(&args.out, None, &[("csv", ())], "")?;
    let out = OutputFile::check(&args.out, Contents::Text)?;
    let pack = super::open(&args.pack)?.load_pack()?;
    let script = Script::parse(args.script.as_deref().unwrap_or_default(), &pack)?;
    let mut life = args.life.begin(&pack);
    let spoken = Spoken::read(&args.speech, &pack)?;
    // The product may lie a rounding error below a whole number of ticks.
    let last_row = (args.duration * args.hz * (1.0 + 1e-12)).floor();
    if last_row > MAX_ROWS {
        return Err(usage(format!("expected at most {MAX_ROWS} rows, found --hz × --duration = {last_row}")));
    }
    let rows = Rows { hz: args.hz, last: last_row as u64, derivatives: args.derivatives };
    out.stream(|out| trace(&pack, &script, spoken.as_ref(), &mut life, &rows, out))
}

/// Which rows and columns to print.
struct Rows {
    hz: f64,
    last: u64,
    derivatives: bool,
}

fn trace(
    pack: &Pack,
    script: &Script,
    spoken: Option<&Spoken>,
    life: &mut Option<Living>,
    rows: &Rows,
    out: &mut dyn Write,
) -> Result<()> {
    let mut motion = script.motion(pack);
    let suffixes: &[&str] = if rows.derivatives { &["", "'", "''"] } else { &[""] };
    header(pack, suffixes, out)?;
    for number in 0..=rows.last {
        let t = number as f64 / rows.hz;
        let player = motion.at(t)?;
        let mut values = player.values().to_vec();
        if let Some(spoken) = spoken {
            spoken.say(t, &mut values);
        }
        if let Some(life) = life {
            life.go_to(t)?;
            life.over(&mut values)?;
        }
        let columns = [&values[..], player.velocities(), player.accelerations()];
        row(t, columns.into_iter().take(suffixes.len()).flatten(), out)?;
    }
    Ok(())
}

/// The line with the names of the columns: the time, and all controls with each of the suffixes.
pub(super) fn header(pack: &Pack, suffixes: &[&str], out: &mut dyn Write) -> Result<()> {
    write!(out, "t")?;
    for suffix in suffixes {
        for control in pack.controls().controls() {
            write!(out, ",{}", quoted(&format!("{}{suffix}", control.name)))?;
        }
    }
    Ok(writeln!(out)?)
}

/// A row: the time and its values.
pub(super) fn row<'a>(
    secs: f64,
    values: impl IntoIterator<Item = &'a f32>,
    out: &mut dyn Write,
) -> Result<()> {
    write!(out, "{secs}")?;
    for value in values {
        // The sum turns −0 into 0.
        write!(out, ",{}", value + 0.0)?;
    }
    Ok(writeln!(out)?)
}

/// A column's name as CSV wants it (RFC 4180).
fn quoted(name: &str) -> Cow<'_, str> {
    match name.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", name.replace('"', "\"\"")).into(),
        false => name.into(),
    }
}
