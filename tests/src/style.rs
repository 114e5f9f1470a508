//! How files are laid out: the width of comments, the length of files.

use std::path::Path;
use std::{fs, io};

use crate::tokens;

/// Comments may reach this column.
pub const COMMENT_COLUMNS: usize = 110;
/// The most lines of a Rust file.
pub const RUST_LINES: usize = 400;
/// The most lines of a shader.
pub const SHADER_LINES: usize = 160;

/// What is against the rules in one file, each as a sentence behind `path:line:`. What kind of file it is,
/// its name tells; files of other kinds are in order.
pub fn findings(path: &str, text: &str) -> Vec<String> {
    let name = path.rsplit('/').next().unwrap_or(path);
    let (comments, most_lines): (Vec<(usize, usize)>, _) =
        match name.rsplit_once('.').map(|(_, extension)| extension) {
            Some("rs") => (comments_of_code(text), RUST_LINES),
            Some("wgsl") => (comments_of_code(text), SHADER_LINES),
            Some("toml") => (text.lines().enumerate().filter_map(comment_of_toml).collect(), usize::MAX),
            Some("mjs") => (whole_line_comments(text, "//"), usize::MAX),
            Some("sh" | "py") => (whole_line_comments(text, "#"), usize::MAX),
            None if text.starts_with("#!") || text.starts_with("# shellcheck") => {
                (whole_line_comments(text, "#"), usize::MAX)
            }
            _ => return Vec::new(),
        };
    let mut findings: Vec<_> = comments
        .iter()
        .filter(|(_, column)| *column > COMMENT_COLUMNS)
        .map(|(line, column)| {
            format!("{path}:{line}: a comment reaches column {column}, more than {COMMENT_COLUMNS}")
        })
        .collect();
    let lines = text.lines().count();
    if lines > most_lines && !says_why_it_is_long(text, most_lines) {
        findings.push(format!(
            "{path}:1: {lines} lines, more than {most_lines} (if it has to be: a comment \"More than {most_lines} lines: why\")"
        ));
    }
    findings
}

fn comments_of_code(text: &str) -> Vec<(usize, usize)> {
    tokens::read(text).1.iter().map(|comment| (comment.line, comment.last_column)).collect()
}

fn whole_line_comments(text: &str, sign: &str) -> Vec<(usize, usize)> {
    let lines = text.lines().enumerate().filter(|(_, line)| line.trim_start().starts_with(sign));
    lines.map(|(number, line)| (number + 1, line.chars().count())).collect()
}

/// A line of TOML with a comment. A `#` within quotes starts no comment; strings of several lines contain no
/// `#` in this project.
fn comment_of_toml((number, line): (usize, &str)) -> Option<(usize, usize)> {
    let mut quote = None;
    let starts = line.chars().any(|c| {
        match quote {
            None if matches!(c, '"' | '\'') => quote = Some(c),
            Some(open) if open == c => quote = None,
            _ => {}
        }
        quote.is_none() && c == '#'
    });
    starts.then(|| (number + 1, line.chars().count()))
}

fn says_why_it_is_long(text: &str, most_lines: usize) -> bool {
    let mark = format!("More than {most_lines} lines: ");
    text.lines().any(|line| {
        let comment = line.trim_start().strip_prefix("//");
        comment.and_then(|comment| comment.split_once(&mark)).is_some_and(|(_, why)| why.trim().len() > 10)
    })
}

/// Reads all files of the workspace and returns what [`findings`] says, by path.
///
/// # Errors
///
/// A folder or file that cannot be read.
pub fn check_workspace(workspace: &Path) -> io::Result<Vec<String>> {
    let mut all = Vec::new();
    for top in ["", ".ci", "assets", "crates", "scripts", "tests"] {
        check_folder(workspace, top, !top.is_empty(), &mut all)?;
    }
    all.sort();
    Ok(all)
}

fn check_folder(workspace: &Path, folder: &str, descend: bool, all: &mut Vec<String>) -> io::Result<()> {
    for entry in fs::read_dir(workspace.join(folder))? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let below = if folder.is_empty() { name.clone() } else { format!("{folder}/{name}") };
        if path.is_dir() {
            // What others build beside the source is not ours.
            if descend && name != "target" && name != "node_modules" {
                check_folder(workspace, &below, true, all)?;
            }
        } else if let Ok(text) = String::from_utf8(fs::read(&path)?) {
            all.extend(findings(&below, &text));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::findings;

    fn wide(before: &str) -> String {
        format!("{before} {}\n", "x".repeat(110))
    }

    #[test]
    fn wide_comments_are_found_in_every_kind_of_file() {
        let cases = [
            ("a.rs", "//"),
            ("a.rs", "let a = 1; //"),
            ("a.rs", "/* a\n b */ /*"),
            ("a.wgsl", "///"),
            ("Cargo.toml", "#"),
            ("Cargo.toml", "a = \"#\" #"),
            ("run", "#!/bin/bash\n#"),
            ("check.mjs", "  //"),
            ("make.py", "#"),
        ];
        for (path, before) in cases {
            let found = findings(path, &wide(before));
            assert_eq!(found.len(), 1, "{path} {before:?}: {found:?}");
        }
        assert_eq!(findings("a.rs", &wide("\n//")), ["a.rs:2: a comment reaches column 113, more than 110"]);
        // At the limit, and columns are characters.
        assert!(findings("a.rs", &format!("// {}", "ü".repeat(107))).is_empty());
    }

    #[test]
    fn wide_strings_are_in_order() {
        let cases = [
            ("a.rs", "let a = \"//"),
            ("Cargo.toml", "a = \"#"),
            ("run", "#!/bin/bash\necho #"),
            ("a.md", "//"),
        ];
        for (path, before) in cases {
            assert!(findings(path, &wide(before)).is_empty(), "{path} {before:?}");
        }
    }

    #[test]
    fn long_files_say_why() {
        let long = "fn a() {}\n".repeat(401);
        assert!(findings("a.rs", &long)[0].contains("401 lines"));
        assert!(findings("a.rs", &"fn a() {}\n".repeat(400)).is_empty());
        assert!(findings("a.wgsl", &"fn a() {}\n".repeat(161))[0].contains("161 lines"));
        assert!(
            findings("a.rs", &format!("// More than 400 lines: one table that belongs together.\n{long}"))
                .is_empty()
        );
        assert_eq!(findings("a.rs", &format!("// More than 400 lines: \n{long}")).len(), 1);
    }
}
