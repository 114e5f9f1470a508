//! Places in a text, and how keys and values are shown in errors.

use crate::TomlError;
use std::ops::Range;
use toml::de::DeValue;

/// Longer names and texts are cut in errors.
const SHOWN_CHARS: usize = 60;

/// A text whose places can be named.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Text<'a>(pub(crate) &'a str);

impl Text<'_> {
    pub(crate) fn error(
        self,
        span: &Range<usize>,
        path: &str,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> TomlError {
        let mut end = span.start.min(self.0.len());
        while !self.0.is_char_boundary(end) {
            end -= 1;
        }
        let before = &self.0[..end];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        TomlError {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            key: path.to_owned(),
            expected: expected.into(),
            found: found.into(),
            nearest: None,
        }
    }
}

/// A key behind those of its tables, as it is written in TOML: quoted where it has to be, and cut where it is
/// long.
pub(crate) fn join(path: &str, key: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    let bare = !key.is_empty() && key.len() <= SHOWN_CHARS && key.chars().all(is_bare);
    let key = if bare { key.to_owned() } else { quote(key) };
    if path.is_empty() { key } else { format!("{path}.{key}") }
}

/// A text as a basic string of TOML, with all of its characters.
pub fn string(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => out.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// A text in quotes, as errors show it: cut after 60 characters.
pub fn quote(text: &str) -> String {
    match text.char_indices().nth(SHOWN_CHARS) {
        Some((end, _)) => format!("{:?}…", &text[..end]),
        None => format!("{text:?}"),
    }
}

pub(crate) fn describe(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => quote(text),
        DeValue::Integer(number) => number.to_string(),
        DeValue::Float(number) => number.to_string(),
        DeValue::Boolean(value) => value.to_string(),
        DeValue::Datetime(date) => date.to_string(),
        DeValue::Array(items) => format!("an array of {}", items.len()),
        DeValue::Table(_) => "a table".to_owned(),
    }
}
