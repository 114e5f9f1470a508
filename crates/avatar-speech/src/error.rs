use std::fmt;

/// Why a text is no timeline of speech.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: expected {expected}, found {found}")]
#[non_exhaustive]
pub struct SpeechError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What would have been right.
    pub expected: String,
    /// What is there instead.
    pub found: String,
}

/// Something in a text that was passed over or put right.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Note {
    /// Line, from 1.
    pub line: usize,
    /// What it is and what was done.
    pub text: String,
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.text)
    }
}

/// Longer texts are cut in messages.
const SHOWN: usize = 40;

/// What a message says of a text.
pub(crate) fn shown(text: &str) -> String {
    match text.trim().char_indices().nth(SHOWN) {
        _ if text.trim().is_empty() => "nothing".to_owned(),
        None => format!("{:?}", text.trim()),
        Some((at, _)) => format!("{:?} and more", &text.trim()[..at]),
    }
}

/// A place in a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) line: usize,
    pub(crate) column: usize,
}

impl Place {
    /// The beginning of a line.
    pub(crate) fn of_line(line: usize) -> Self {
        Self { line, column: 1 }
    }

    /// The place of a byte in a text.
    pub(crate) fn of_byte(text: &str, byte: usize) -> Self {
        let before = text.get(..byte).unwrap_or(text);
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
        Self { line, column }
    }

    /// The place of a part of a line.
    pub(crate) fn in_line(line: usize, whole: &str, part: &str) -> Self {
        let byte = (part.as_ptr() as usize).saturating_sub(whole.as_ptr() as usize);
        let column = whole.get(..byte).map_or(1, |before| before.chars().count() + 1);
        Self { line, column }
    }

    pub(crate) fn error(self, expected: impl Into<String>, found: impl Into<String>) -> SpeechError {
        let (expected, found) = (expected.into(), found.into());
        SpeechError { line: self.line, column: self.column, expected, found }
    }
}
