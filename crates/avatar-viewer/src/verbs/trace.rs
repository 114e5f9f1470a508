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
    let spoken = args.visemes.as_deref().map(|path| Spoken::read(path, &pack)).transpose()?;
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
    write!(out, "t")?;
    let suffixes: &[&str] = if rows.derivatives { &["", "'", "''"] } else { &[""] };
    for suffix in suffixes {
        for control in pack.controls().controls() {
            write!(out, ",{}", quoted(&format!("{}{suffix}", control.name)))?;
        }
    }
    writeln!(out)?;
    for row in 0..=rows.last {
        let t = row as f64 / rows.hz;
        let player = motion.at(t)?;
        write!(out, "{t}")?;
        let mut values = player.values().to_vec();
        if let Some(spoken) = spoken {
            spoken.say(t, &mut values);
        }
        if let Some(life) = life {
            life.go_to(t)?;
            life.over(&values.clone(), &mut values)?;
        }
        let columns = [&values[..], player.velocities(), player.accelerations()];
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
