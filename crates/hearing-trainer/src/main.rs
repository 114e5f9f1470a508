//! Trains the model of `avatar-hearing`, and measures how well it hears.
//!
//! `speak.py FOLDER` makes the sound and its labels; `compare.mjs` lets two other programs hear the same. See
//! the README.

mod corpus;

mod augment;

mod net;

mod table;

use std::path::PathBuf;

use anyhow::Result;
use clap::Parser;

/// Trains the model of avatar-hearing, or measures it.
#[derive(Debug, Parser)]
struct Arguments {
    /// The folder that speak.py wrote.
    folder: PathBuf,
    /// Where the model is written.
    #[arg(long, default_value = "crates/avatar-hearing/src/model.bin")]
    out: PathBuf,
    /// How often all sounds are heard.
    #[arg(long, default_value_t = 9)]
    epochs: usize,
    /// Where chance begins.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Train nothing: print how well the model in `--out` hears the voices that it was not trained on.
    #[arg(long)]
    table: bool,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    if arguments.table {
        return table::print(&arguments.folder, &arguments.out);
    }
    let sounds = corpus::read(&arguments.folder.join("train"))?;
    println!(
        "{} sounds, {:.0} seconds",
        sounds.len(),
        sounds.iter().map(corpus::Sound::seconds).sum::<f64>()
    );
    let model = net::train(&sounds, arguments.epochs, arguments.seed);
    std::fs::write(&arguments.out, model.to_bytes())?;
    println!("{} written", arguments.out.display());
    Ok(())
}
