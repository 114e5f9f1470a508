//! Reads spanned TOML by hand. Deserialising into structs would lose the place of a value that has the right type but a
//! wrong content, and the nearest valid name.

use crate::LookError;
use crate::nearest::nearest;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A text whose places can be named.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Text<'a>(&'a str);

/// A key with its value, or an item of an array.
#[derive(Clone, Debug)]
pub(crate) struct Entry<'t, 'a> {
    text: Text<'a>,
    pub(crate) name: String,
    /// The name behind those of its tables, such as `eyeball.iris`.
    path: String,
    key_span: Range<usize>,
    value: &'t Spanned<DeValue<'a>>,
}

impl<'a> Text<'a> {
    /// Parses a document. Tools on some systems write a byte-order mark; it is no content.
    pub(crate) fn parse(source: &'a str) -> Result<(Self, Spanned<DeTable<'a>>), LookError> {
        let text = Self(source.strip_prefix('\u{feff}').unwrap_or(source));
        DeTable::parse(text.0).map(|document| (text, document)).map_err(|error| {
            let found = error.message().lines().collect::<Vec<_>>().join(", ");
            text.error(&error.span().unwrap_or(0..0), "", "valid TOML", format!("an error: {found}"))
        })
    }

    /// The entries of the document, by place in the text.
    pub(crate) fn entries<'t>(self, table: &'t DeTable<'a>) -> Vec<Entry<'t, 'a>> {
        self.entries_under("", table)
    }

    fn entries_under<'t>(self, path: &str, table: &'t DeTable<'a>) -> Vec<Entry<'t, 'a>> {
        let entry = |(key, value): (&Spanned<std::borrow::Cow<'a, str>>, &'t Spanned<DeValue<'a>>)| {
            let name = key.get_ref().to_string();
            Entry { text: self, path: join(path, &name), name, key_span: key.span(), value }
        };
        let mut entries: Vec<_> = table.iter().map(entry).collect();
        entries.sort_by_key(|entry| entry.key_span.start);
        entries
    }

    fn error(self, span: &Range<usize>, path: &str, expected: &str, found: String) -> LookError {
        let mut end = span.start.min(self.0.len());
        while !self.0.is_char_boundary(end) {
            end -= 1;
        }
        let before = &self.0[..end];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        LookError {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            key: path.to_owned(),
            expected: expected.to_owned(),
            found,
            nearest: None,
        }
    }
}

impl<'t, 'a> Entry<'t, 'a> {
    /// An error at the value, which is shown.
    pub(crate) fn error_found(&self, expected: &str) -> LookError {
        self.text.error(&self.value.span(), &self.path, expected, describe(self.value.get_ref()))
    }

    /// An error at the key, which is none of `valid`.
    pub(crate) fn unknown_name(&self, what: &str, valid: &[&str]) -> LookError {
        let expected = format!("{what} {}", valid.join(", "));
        let nearest = nearest(&self.name, valid.iter().copied()).map(str::to_owned);
        LookError { nearest, ..self.text.error(&self.key_span, &self.path, &expected, quote(&self.name)) }
    }

    /// The entries of a table, by place in the text.
    pub(crate) fn table(&self) -> Result<Vec<Entry<'t, 'a>>, LookError> {
        match self.value.get_ref() {
            DeValue::Table(table) => Ok(self.text.entries_under(&self.path, table)),
            _ => Err(self.error_found("a table")),
        }
    }

    /// The items of an array; they share its key.
    pub(crate) fn items(&self, expected: &str) -> Result<Vec<Entry<'t, 'a>>, LookError> {
        match self.value.get_ref() {
            DeValue::Array(items) => Ok(items.iter().map(|value| Entry { value, ..self.clone() }).collect()),
            _ => Err(self.error_found(expected)),
        }
    }

    /// A number from `min` to `max`.
    pub(crate) fn number(&self, min: f32, max: f32, expected: &str) -> Result<f32, LookError> {
        let number: Option<f32> = match self.value.get_ref() {
            DeValue::Integer(number) => {
                i64::from_str_radix(number.as_str(), number.radix()).ok().map(|number| number as f32)
            }
            DeValue::Float(number) => number.as_str().parse().ok(),
            _ => None,
        };
        // NaN is in no range.
        number.filter(|number| (min..=max).contains(number)).ok_or_else(|| self.error_found(expected))
    }
}

/// A key as it is written in TOML: quoted where it has to be, and shortened where it is long.
fn join(path: &str, key: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    let bare = !key.is_empty() && key.len() <= 60 && key.chars().all(is_bare);
    let key = if bare { key.to_owned() } else { quote(key) };
    if path.is_empty() { key } else { format!("{path}.{key}") }
}

/// A text in quotes, shortened where it is long.
fn quote(text: &str) -> String {
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{:?}…", &text[..end]),
        None => format!("{text:?}"),
    }
}

fn describe(value: &DeValue<'_>) -> String {
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
