//! The command line as clap reads it, and what is said in our words where it cannot be read.

use crate::cli::Cli;
use crate::standard;
use crate::usage::{self, usage};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, CommandFactory};
use std::path::Path;
use std::process::ExitCode;

/// What clap knows of all verbs and options.
pub(crate) fn command() -> Command {
    numbers_are_values(Cli::command())
}

/// A number below zero is never an option: it is the value of the option before it, or a name, and what
/// becomes of that can say what was expected.
fn numbers_are_values(command: Command) -> Command {
    let command = command.mut_args(|arg| {
        let takes_them = arg.get_action().takes_values() && !arg.is_allow_hyphen_values_set();
        if takes_them { arg.allow_negative_numbers(true) } else { arg }
    });
    command.mut_subcommands(numbers_are_values)
}

/// Says what is wrong, or prints what was asked for: help and version are errors to clap.
pub(crate) fn wrong_usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        // Nothing can be done where nobody reads it.
        let _ = error.print();
        return ExitCode::SUCCESS;
    }
    let mut command = command();
    command.build();
    let words: Vec<String> =
        std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
    match explained(error, &command, &words) {
        Some(error) => standard::tell(format_args!("error: {error}\n\nFor more information, try '--help'.")),
        None => drop(error.print()),
    }
    let late = words.iter().skip(1).find(|word| command.find_subcommand(word).is_some());
    if let Some(verb) = late.filter(|_| command.find_subcommand(&words[0]).is_none()) {
        standard::tell(format_args!("A verb comes first, its options after it: avatar-viewer {verb} …"));
    }
    ExitCode::from(2)
}

/// The error in our words, where they say more than clap's.
fn explained(error: &clap::Error, command: &Command, words: &[String]) -> Option<anyhow::Error> {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => text.as_str(),
        _ => "",
    };
    if let Some(ContextValue::Strings(names)) = error.get(ContextKind::ValidValue)
        && !names.is_empty()
    {
        let option = text(ContextKind::InvalidArg).split(' ').next().unwrap_or_default();
        let found = text(ContextKind::InvalidValue);
        return Some(usage::unknown_option(option, found, names.iter().map(String::as_str)));
    }
    let (argument, name) = (text(ContextKind::InvalidArg), text(ContextKind::InvalidSubcommand));
    let verb = words.first().and_then(|word| command.find_subcommand(word));
    match error.kind() {
        ErrorKind::InvalidSubcommand => Some(usage::unknown_option("verb", name, verbs(command))),
        _ if verb.is_none() && words.first().is_some_and(|word| is_misspelt_verb(word)) => {
            misspelt_verb(&words[0])
        }
        ErrorKind::UnknownArgument if argument.starts_with('-') => {
            // Of what has a single hyphen clap tells the first letter.
            let found = words.iter().find(|word| !argument.starts_with("--") && word.starts_with(argument));
            Some(unknown_option(command, verb, found.map_or(argument, String::as_str)))
        }
        ErrorKind::UnknownArgument => Some(one_too_many(argument)),
        ErrorKind::ArgumentConflict if !name.is_empty() && command.find_subcommand(name).is_none() => {
            Some(one_too_many(name))
        }
        _ => None,
    }
}

fn verbs(command: &Command) -> impl Iterator<Item = &str> {
    command.get_subcommands().map(Command::get_name)
}

fn options(command: &Command) -> impl Iterator<Item = &str> {
    command.get_arguments().filter_map(clap::Arg::get_long)
}

fn unknown_option(command: &Command, verb: Option<&Command>, found: &str) -> anyhow::Error {
    let bare = found.trim_start_matches('-');
    let has = |command: &Command| options(command).any(|option| option == bare);
    let (place, own) = verb.map_or(("the window", command), |verb| (verb.get_name(), verb));
    // `live` takes the window's options, and opens it.
    let is_other = |verb: &&Command| has(verb) && !(verb.get_name() == "live" && has(command));
    let others: Vec<_> = command.get_subcommands().filter(is_other).map(Command::get_name).collect();
    let is_whole = found.starts_with("--");
    let hint = match placed_toml::nearest(bare, options(own)) {
        _ if is_whole && !others.is_empty() => format!(", an option of {}", others.join(", ")),
        _ if is_whole && has(command) => ", an option of the window".to_owned(),
        Some(name) => format!(" (did you mean \"--{name}\"?)"),
        None => String::new(),
    };
    usage(format!("expected an option of {place}, found {found:?}{hint}"))
}

/// A name behind those that can be given.
fn one_too_many(found: &str) -> anyhow::Error {
    let hint = if is_misspelt_verb(found) {
        usage::did_you_mean(found, verbs(&Cli::command()))
    } else {
        ": a name with blanks stands in quotes, a file to write follows --out".to_owned()
    };
    usage(format!("expected no further name, found {found:?}{hint}"))
}

/// Whether a word is the name of nothing, and looks like a verb.
fn is_misspelt_verb(word: &str) -> bool {
    misspelt_verb(word).is_some()
}

/// Says which verb is meant by a name of nothing that looks like one.
pub(crate) fn misspelt_verb(word: &str) -> Option<anyhow::Error> {
    if word.starts_with('-') || Path::new(word).exists() {
        return None;
    }
    match usage::did_you_mean(word, verbs(&Cli::command())) {
        hint if hint.is_empty() => None,
        hint => Some(usage(format!(
            "expected a verb, or the folder or file of an avatar, found {word:?}, which is neither{hint}"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_option_takes_a_number_for_another_option() {
        fn check(command: &Command) {
            for arg in command.get_arguments().filter(|arg| arg.get_action().takes_values()) {
                assert!(
                    arg.is_allow_negative_numbers_set() || arg.is_allow_hyphen_values_set(),
                    "{} {}",
                    command.get_name(),
                    arg.get_id()
                );
            }
            command.get_subcommands().for_each(check);
        }
        command().debug_assert();
        check(&command());
    }
}
