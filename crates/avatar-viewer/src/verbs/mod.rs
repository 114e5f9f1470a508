//! One module per verb of the command line.

mod bones;
mod convert;
mod deform;
mod info;
mod keys;
mod live;
mod record;
mod render;
mod sheet;
mod spaces;
mod strands;
mod trace;

use crate::cli::{Cli, PackArg, Verb};
use crate::command_line::misspelt_verb;
use crate::files::Files;
use crate::window;
use anyhow::Result;
use clap::ArgMatches;

/// Runs the verb; without a verb it opens the window.
pub(crate) fn run(cli: Cli, matches: &ArgMatches) -> Result<()> {
    let Some(verb) = cli.verb else {
        let name = cli.window.pack.pack.as_deref().map(|path| path.to_string_lossy());
        if let Some(error) = name.and_then(|name| misspelt_verb(&name)) {
            return Err(error);
        }
        return window::run(&cli.window, matches);
    };
    let matches = matches.subcommand().map_or(matches, |(_, matches)| matches);
    match verb {
        Verb::Render(args) => render::run(&args, matches),
        Verb::Record(args) => record::run(&args),
        Verb::Speak(args) => record::speak(&args),
        Verb::Sheet(args) => sheet::run(&args),
        Verb::Bones(args) => bones::run(&args, matches),
        Verb::Deform(args) => deform::run(&args, matches),
        Verb::Convert(args) => convert::run(&args, matches),
        Verb::Strands(args) => strands::run(&args, matches),
        Verb::Trace(args) => trace::run(&args),
        Verb::Live(args) => live::run(&args, matches),
        Verb::Info(args) => info::run(&args),
        Verb::Keys(args) => keys::run(&args),
        Verb::Spaces(args) => spaces::run(&args),
    }
}

fn open(pack: &PackArg) -> Result<Files> {
    Files::of_args(pack)
}
