//! One module per verb of the command line.

mod bones;
mod convert;
mod deform;
mod info;
mod keys;
mod record;
mod render;
mod sheet;
mod strands;
mod trace;

use crate::cli::{Cli, PackArg, Verb, WindowArgs};
use crate::files::Files;
use crate::usage;
use crate::window;
use anyhow::Result;
use clap::{ArgMatches, Command, CommandFactory};

/// Runs the verb; without a verb it opens the window.
pub(crate) fn run(cli: Cli, matches: &ArgMatches) -> Result<()> {
    let Some(verb) = cli.verb else {
        no_misspelt_verb(&cli.window)?;
        return window::run(&cli.window, matches);
    };
    let matches = matches.subcommand().map_or(matches, |(_, matches)| matches);
    match verb {
        Verb::Render(args) => render::run(&args, matches),
        Verb::Record(args) => record::run(&args),
        Verb::Sheet(args) => sheet::run(&args),
        Verb::Bones(args) => bones::run(&args, matches),
        Verb::Deform(args) => deform::run(&args, matches),
        Verb::Convert(args) => convert::run(&args, matches),
        Verb::Strands(args) => strands::run(&args, matches),
        Verb::Trace(args) => trace::run(&args),
        Verb::Info(args) => info::run(&args),
        Verb::Keys(args) => keys::run(&args),
    }
}

/// Says which verb is meant by a name of nothing that looks like one.
fn no_misspelt_verb(args: &WindowArgs) -> Result<()> {
    let Some(name) = args.pack.pack.as_deref().filter(|path| !path.exists()) else { return Ok(()) };
    let name = name.to_string_lossy();
    let command = Cli::command();
    match usage::did_you_mean(&name, command.get_subcommands().map(Command::get_name)) {
        hint if hint.is_empty() => Ok(()),
        hint => Err(usage::usage(format!(
            "expected a verb, or the folder or file of an avatar, found {name:?}, which is neither{hint}"
        ))),
    }
}

fn open(pack: &PackArg) -> Result<Files> {
    Files::open(pack.pack.as_deref(), &pack.with)
}
