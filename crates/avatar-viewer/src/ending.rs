//! The format of what is written: the end of its name says it, or `--format` where there is no name.

use crate::output::is_nameless;
use crate::usage::{self, usage};
use anyhow::Result;
use std::path::Path;

/// Ends of names (without the dot) and what each of them stands for; the first is that of what has no name.
pub(crate) type Endings<'a, F> = &'a [(&'a str, F)];

/// The format of a file to be written: by the end of its name, in whichever case. Standard output and most
/// devices have no such end; there it is the one that was asked for as `--format`, or else the first. `or`
/// says what else can be written, for the error message.
pub(crate) fn format<F: Copy + PartialEq>(
    out: &Path,
    asked: Option<&str>,
    endings: Endings<'_, F>,
    or: &str,
) -> Result<F> {
    let of_ending = |wanted: &str| {
        endings.iter().find(|(ending, _)| ending.eq_ignore_ascii_case(wanted)).map(|(_, format)| *format)
    };
    let asked = asked.map(|name| match of_ending(name) {
        Some(format) => Ok((name, format)),
        None => Err(usage::unknown_option("--format", name, endings.iter().map(|(ending, _)| *ending))),
    });
    let asked = asked.transpose()?;
    let found = out.extension().and_then(|ending| of_ending(&ending.to_string_lossy()));
    // A pipe may have a name that says the format, too.
    if found.is_none() && is_nameless(out) {
        let first = endings.first().map(|(_, format)| *format);
        let format = asked.map(|(_, format)| format).or(first);
        return format.ok_or_else(|| usage("expected a format that can be written, found none"));
    }
    let found = found.ok_or_else(|| {
        let names = listed(endings.iter().map(|(ending, _)| *ending));
        usage(format!(
            "--out: expected a name that ends in {names}{or}, or - for standard output, found {:?}",
            out.display().to_string()
        ))
    })?;
    match asked.filter(|(_, format)| *format != found) {
        Some((name, _)) => Err(usage(format!(
            "--format {name}: expected the format that the name ends in, found --out {}",
            out.display()
        ))),
        None => Ok(found),
    }
}

/// `.png, .jpg or .webp`
pub(crate) fn listed<'a>(endings: impl Iterator<Item = &'a str>) -> String {
    let dotted: Vec<_> = endings.map(|ending| format!(".{ending}")).collect();
    match dotted.as_slice() {
        [most @ .., last] if !most.is_empty() => format!("{} or {last}", most.join(", ")),
        _ => dotted.concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENDINGS: Endings<'_, u8> = &[("png", 1), ("jpg", 2), ("jpeg", 2)];

    fn told(out: &str, asked: Option<&str>) -> Result<u8, String> {
        format(Path::new(out), asked, ENDINGS, ", or that of a folder").map_err(|error| error.to_string())
    }

    #[test]
    fn the_end_of_a_name_says_the_format() {
        for (out, format) in [("a.png", 1), ("b/c.JPG", 2), ("d.e.jpeg", 2)] {
            assert_eq!(told(out, None), Ok(format), "{out}");
        }
        for out in ["face.bmp", "face", ".png", "png", "face.png.", "a.png/face"] {
            let error = told(out, None).expect_err(out);
            assert!(
                error.contains("expected a name that ends in .png, .jpg or .jpeg, or that of a folder, or - for standard output"),
                "{error}"
            );
            assert!(error.contains(&format!("found {out:?}")), "{error}");
        }
        assert_eq!(told("a.jpg", Some("jpeg")), Ok(2));
        assert!(told("a.jpg", Some("png")).expect_err("two formats").contains("found --out a.jpg"));
    }

    #[test]
    fn what_has_no_name_has_the_first_format_or_the_one_that_is_asked_for() {
        assert_eq!(told("-", None), Ok(1));
        assert_eq!(told("-", Some("jpg")), Ok(2));
        let error = told("-", Some("jgp")).expect_err("no format");
        assert_eq!(error, "--format: expected one of png, jpg, jpeg, found \"jgp\" (did you mean \"jpg\"?)");
        if cfg!(unix) {
            assert_eq!(told("/dev/null", Some("jpg")), Ok(2));
        }
    }
}
