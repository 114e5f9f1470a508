//! Reads spanned TOML by hand. Deserialising into structs would lose the place of a value that has the right type
//! but a wrong content, and the nearest valid name.

use crate::{TomlError, nearest::nearest};
use rig_core::Place;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Numbers beyond this are no angle, weight or length that a face can have.
pub(crate) const LARGEST: f64 = 1e9;

/// A text with its name for keys in errors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Text<'a>(&'a str);

/// A value with the path of its key.
#[derive(Clone, Debug)]
pub(crate) struct Entry<'t, 'a> {
    pub(crate) text: Text<'a>,
    /// Path of the key, such as `pose.name`.
    pub(crate) path: String,
    pub(crate) key_span: Range<usize>,
    pub(crate) value: &'t Spanned<DeValue<'a>>,
}

/// A table whose entries are taken one by one, so that what is left at the end is unknown.
#[derive(Debug)]
pub(crate) struct Table<'t, 'a> {
    text: Text<'a>,
    path: String,
    pub(crate) span: Range<usize>,
    /// By place in the text.
    left: Vec<(String, Entry<'t, 'a>)>,
}

impl<'a> Text<'a> {
    /// Parses a document. Tools on some systems write a byte-order mark; it is no content.
    pub(crate) fn parse(source: &'a str) -> Result<(Self, Spanned<DeTable<'a>>), TomlError> {
        let text = Self(source.strip_prefix('\u{feff}').unwrap_or(source));
        match DeTable::parse(text.0) {
            Ok(document) => Ok((text, document)),
            Err(error) => {
                let span = error.span().unwrap_or(0..0);
                let found = error.message().lines().collect::<Vec<_>>().join(", ");
                Err(text.error(&span, "", "valid TOML", format!("an error: {found}")))
            }
        }
    }

    pub(crate) fn error(
        self,
        span: &Range<usize>,
        path: &str,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> TomlError {
        let place = self.place(span.start);
        TomlError {
            place,
            key: path.to_owned(),
            expected: expected.into(),
            found: found.into(),
            nearest: None,
        }
    }

    pub(crate) fn place(self, offset: usize) -> Place {
        let mut end = offset.min(self.0.len());
        while !self.0.is_char_boundary(end) {
            end -= 1;
        }
        let before = &self.0[..end];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        Place { line: before.matches('\n').count() + 1, column: before[line_start..].chars().count() + 1 }
    }
}

impl<'t, 'a> Table<'t, 'a> {
    pub(crate) fn new(text: Text<'a>, path: &str, span: Range<usize>, table: &'t DeTable<'a>) -> Self {
        let mut left: Vec<_> = table
            .iter()
            .map(|(key, value)| {
                let name = key.get_ref().to_string();
                let path = join(path, &name);
                (name, Entry { text, path, key_span: key.span(), value })
            })
            .collect();
        left.sort_by_key(|(_, entry)| entry.key_span.start);
        Self { text, path: path.to_owned(), span, left }
    }

    /// Takes the entry of this key, if there is one.
    pub(crate) fn take(&mut self, key: &str) -> Option<Entry<'t, 'a>> {
        let at = self.left.iter().position(|(name, _)| name == key)?;
        Some(self.left.remove(at).1)
    }

    /// Takes the entry of this key, which must be there.
    pub(crate) fn require(&mut self, key: &str, expected: &str) -> Result<Entry<'t, 'a>, TomlError> {
        let missing = self.error_here(key, expected, "none");
        self.take(key).ok_or(missing)
    }

    /// An error about a key that this table lacks, at the table's place.
    pub(crate) fn error_here(&self, key: &str, expected: &str, found: &str) -> TomlError {
        self.text.error(&self.span, &join(&self.path, key), expected, found)
    }

    /// The tables of `[[key]]`, in the order of the text; none if the key is absent.
    pub(crate) fn take_tables(&mut self, key: &str) -> Result<Vec<Table<'t, 'a>>, TomlError> {
        let Some(entry) = self.take(key) else { return Ok(Vec::new()) };
        let DeValue::Array(items) = entry.value.get_ref() else {
            return Err(entry.error_found(format!("tables that begin with [[{key}]]")));
        };
        items.iter().map(|item| entry.with(item).table()).collect()
    }

    /// All entries that have not been taken.
    pub(crate) fn rest(self) -> impl Iterator<Item = (String, Entry<'t, 'a>)> {
        self.left.into_iter()
    }

    /// Nothing but the keys taken so far may stand here; `known` lists them for the error.
    pub(crate) fn finish(self, known: &[&str]) -> Result<(), TomlError> {
        match self.left.into_iter().next() {
            None => Ok(()),
            Some((name, entry)) => Err(entry.unknown_name(&name, "one of the keys", known.iter().copied())),
        }
    }
}

impl<'t, 'a> Entry<'t, 'a> {
    fn with(&self, value: &'t Spanned<DeValue<'a>>) -> Self {
        Self { value, ..self.clone() }
    }

    /// An error at the value.
    pub(crate) fn error(&self, expected: impl Into<String>, found: impl Into<String>) -> TomlError {
        self.text.error(&self.value.span(), &self.path, expected, found)
    }

    /// An error at the value, which is shown.
    pub(crate) fn error_found(&self, expected: impl Into<String>) -> TomlError {
        self.error(expected, describe(self.value.get_ref()))
    }

    /// An error at the key: a name that is not one of `valid`.
    pub(crate) fn unknown_name<'n>(
        &self,
        name: &str,
        what: &str,
        valid: impl Iterator<Item = &'n str> + Clone,
    ) -> TomlError {
        let list: Vec<_> = valid.clone().collect();
        let mut error =
            self.text.error(&self.key_span, &self.path, format!("{what} {}", list.join(", ")), quote(name));
        error.nearest = nearest(name, valid).map(str::to_owned);
        error
    }

    /// As [`Self::unknown_name`], for a name that stands as a value.
    pub(crate) fn unknown_value<'n>(
        &self,
        name: &str,
        what: &str,
        valid: impl Iterator<Item = &'n str> + Clone,
    ) -> TomlError {
        let at_value = Self { key_span: self.value.span(), ..self.clone() };
        at_value.unknown_name(name, what, valid)
    }

    pub(crate) fn table(&self) -> Result<Table<'t, 'a>, TomlError> {
        match self.value.get_ref() {
            DeValue::Table(table) => Ok(Table::new(self.text, &self.path, self.value.span(), table)),
            _ => Err(self.error_found("a table")),
        }
    }

    pub(crate) fn array(&self) -> Result<Vec<Entry<'t, 'a>>, TomlError> {
        match self.value.get_ref() {
            DeValue::Array(items) => Ok(items.iter().map(|item| self.with(item)).collect()),
            _ => Err(self.error_found("an array")),
        }
    }

    pub(crate) fn string(&self, expected: &str) -> Result<&'t str, TomlError> {
        match self.value.get_ref() {
            DeValue::String(text) if !text.trim().is_empty() => Ok(text),
            _ => Err(self.error_found(expected)),
        }
    }

    /// A finite number of at most [`LARGEST`].
    pub(crate) fn number(&self, expected: &str) -> Result<f32, TomlError> {
        self.precise(expected).map(|number| number as f32)
    }

    /// As [`Self::number`], in full precision.
    pub(crate) fn precise(&self, expected: &str) -> Result<f64, TomlError> {
        let number = match self.value.get_ref() {
            DeValue::Integer(number) => {
                i64::from_str_radix(number.as_str(), number.radix()).ok().map(|n| n as f64)
            }
            DeValue::Float(number) => number.as_str().parse().ok(),
            _ => None,
        };
        match number {
            Some(number) if f64::abs(number) <= LARGEST => Ok(number),
            _ => Err(self.error_found(expected)),
        }
    }
}

/// A key as it is written in TOML: quoted where it has to be.
fn join(path: &str, key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    let key = if bare { key.to_owned() } else { quote(key) };
    if path.is_empty() { key } else { format!("{path}.{key}") }
}

/// A text in quotes, shortened where it is long.
pub(crate) fn quote(text: &str) -> String {
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
