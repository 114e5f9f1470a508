mod entry;

use crate::TomlError;
use crate::text::{Text, join};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

pub use entry::{Entry, LARGEST};

/// A parsed text.
#[derive(Clone, Debug)]
pub struct Document<'a> {
    text: Text<'a>,
    root: Spanned<DeTable<'a>>,
}

impl<'a> Document<'a> {
    /// Parses a text. A byte-order mark, which tools on some systems write, is skipped.
    ///
    /// # Errors
    /// The first syntax error, with its place.
    pub fn parse(source: &'a str) -> Result<Self, TomlError> {
        let text = Text(source.strip_prefix('\u{feff}').unwrap_or(source));
        match DeTable::parse(text.0) {
            Ok(root) => Ok(Self { text, root }),
            Err(error) => {
                let found = error.message().lines().collect::<Vec<_>>().join(", ");
                let found = format!("an error: {found}");
                Err(text.error(&error.span().unwrap_or(0..0), "", "valid TOML", found))
            }
        }
    }

    /// The table that is the whole document.
    pub fn root(&self) -> Table<'_, 'a> {
        Table::new(self.text, "", 0..0, self.root.get_ref())
    }
}

/// A table whose entries are taken one by one, so that the entries left at the end are the unknown ones.
#[derive(Clone, Debug)]
pub struct Table<'t, 'a> {
    text: Text<'a>,
    path: String,
    span: Range<usize>,
    /// By place in the text.
    left: Vec<Entry<'t, 'a>>,
}

impl<'t, 'a> Table<'t, 'a> {
    pub(crate) fn new(text: Text<'a>, path: &str, span: Range<usize>, table: &'t DeTable<'a>) -> Self {
        let entry = |(key, value): (&Spanned<std::borrow::Cow<'a, str>>, &'t Spanned<DeValue<'a>>)| {
            let name = key.get_ref().to_string();
            Entry { text, path: join(path, &name), name, key_span: key.span(), value }
        };
        let mut left: Vec<_> = table.iter().map(entry).collect();
        left.sort_by_key(|entry| entry.key_span.start);
        Self { text, path: path.to_owned(), span, left }
    }

    /// The entries that have not been taken, by place in the text.
    pub fn entries(&self) -> &[Entry<'t, 'a>] {
        &self.left
    }

    /// Takes the entry of this key, if there is one.
    pub fn take(&mut self, key: &str) -> Option<Entry<'t, 'a>> {
        let at = self.left.iter().position(|entry| entry.name == key)?;
        Some(self.left.remove(at))
    }

    /// Takes the entry of this key, which must be there.
    ///
    /// # Errors
    /// The key is missing. The error has the place of the table and says what was `expected`.
    pub fn require(&mut self, key: &str, expected: &str) -> Result<Entry<'t, 'a>, TomlError> {
        // The error finds its line by reading the text from the start: only when there is one.
        match self.take(key) {
            Some(entry) => Ok(entry),
            None => Err(self.error_here(key, expected, "none")),
        }
    }

    /// An error about a key that this table lacks, at the table's place.
    pub fn error_here(&self, key: &str, expected: &str, found: &str) -> TomlError {
        self.text.error(&self.span, &join(&self.path, key), expected, found)
    }

    /// Takes the tables of `[[key]]`, in the order of the text; none if the key is absent.
    ///
    /// # Errors
    /// The key is there, but not as tables.
    pub fn take_tables(&mut self, key: &str) -> Result<Vec<Table<'t, 'a>>, TomlError> {
        let Some(entry) = self.take(key) else { return Ok(Vec::new()) };
        let Some(items) = entry.as_array() else {
            return Err(entry.error_found(format!("tables that begin with [[{key}]]")));
        };
        items.iter().map(Entry::table).collect()
    }

    /// All entries that have not been taken, by place in the text.
    pub fn rest(self) -> impl Iterator<Item = Entry<'t, 'a>> {
        self.left.into_iter()
    }

    /// Checks that no entries are left.
    ///
    /// # Errors
    /// The first entry that was not taken; `known` lists the keys that may be here.
    pub fn finish(self, known: &[&str]) -> Result<(), TomlError> {
        match self.left.first() {
            None => Ok(()),
            Some(entry) => Err(entry.unknown_name(entry.name(), "one of the keys", known.iter().copied())),
        }
    }
}
