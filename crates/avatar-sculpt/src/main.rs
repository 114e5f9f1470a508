//! Writes the default avatar pack, or checks that the one on disk is what this program makes.
//!
//! `avatar-sculpt [[--out] DIR] [--check] [--draft] [--freckles SHARE] [--marks SHARE]`
//!
//! `--draft` paints pictures at a quarter of their edge length: enough to judge a form, and much quicker.
//! Shares are from 0 (none) to 1.

use std::{fs, path::PathBuf, process::ExitCode};

use anyhow::{Context as _, Result, bail};
use avatar_sculpt::{Complexion, Detail};

fn main() -> Result<ExitCode> {
    let mut out = PathBuf::from("assets/marsienne");
    let mut check = false;
    let mut detail = Detail::Full;
    let mut complexion = Complexion::default();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--out" => out = arguments.next().context("--out needs a folder")?.into(),
            "--check" => check = true,
            "--draft" => detail = Detail::Draft,
            "--freckles" => complexion.freckles = share(arguments.next(), "--freckles")?,
            "--marks" => complexion.marks = share(arguments.next(), "--marks")?,
            dir if !dir.starts_with('-') => out = dir.into(),
            other => bail!(
                "unknown argument {other:?}; usage: avatar-sculpt [[--out] DIR] [--check] [--draft] \
                 [--freckles SHARE] [--marks SHARE]"
            ),
        }
    }
    let pack = avatar_sculpt::build(detail, &complexion)?;
    if check {
        let mut differing = 0;
        for (name, bytes) in &pack.files {
            if fs::read(out.join(name)).ok().as_deref() != Some(bytes) {
                eprintln!("{}: differs from what would be written", out.join(name).display());
                differing += 1;
            }
        }
        return Ok(if differing == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE });
    }
    fs::create_dir_all(&out).with_context(|| format!("cannot create {}", out.display()))?;
    for (name, bytes) in &pack.files {
        // Beside first, then in one step: a reader never sees half a file.
        let (path, beside) = (out.join(name), out.join(format!("{name}.new")));
        fs::write(&beside, bytes).with_context(|| format!("cannot write {}", beside.display()))?;
        fs::rename(&beside, &path).with_context(|| format!("cannot write {}", path.display()))?;
    }
    println!("{} files in {}", pack.files.len(), out.display());
    Ok(ExitCode::SUCCESS)
}

/// A number from 0 to 1.
fn share(text: Option<String>, option: &str) -> Result<f64> {
    let text = text.with_context(|| format!("{option} needs a number from 0 to 1"))?;
    match text.parse() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => bail!("{option}: expected a number from 0 to 1, found {text:?}"),
    }
}
