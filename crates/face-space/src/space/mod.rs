//! Names of one space.

mod text;

use crate::plain::plain;
use placed_toml::TomlError;
use std::collections::HashMap;

/// A side of the face, as the character has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// Where the character's left eye is.
    Left,
    /// Where the character's right eye is.
    Right,
}

impl Side {
    /// Left, then right.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// In words: `left` or `right`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// What one value of a space is.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Name {
    /// As the space's own programs write it.
    pub name: String,
    /// What the face does where the value is at its largest, in one sentence.
    pub means: String,
    /// The side that it moves; none where it moves both, or the middle.
    pub side: Option<Side>,
    /// The least value.
    pub min: f32,
    /// The largest value.
    pub max: f32,
    /// The value of a face at rest.
    pub rest: f32,
    /// Other names for the same.
    pub aliases: Vec<String>,
    /// The name with `*` where the name of the other side differs.
    pub(crate) pattern: Option<String>,
}

impl Name {
    /// A value within the range; what is no number is at rest.
    pub fn clean(&self, value: f32) -> f32 {
        if value.is_nan() { self.rest } else { value.clamp(self.min, self.max) }
    }
}

/// A list of names that trackers or avatars have for what a face does.
#[derive(Clone, Debug, PartialEq)]
pub struct Space {
    key: String,
    title: String,
    source: String,
    names: Vec<Name>,
    /// Both sides of each name with sides.
    pairs: HashMap<String, [usize; 2]>,
    /// By plain name, aliases included.
    known: HashMap<String, usize>,
}

impl Space {
    /// Reads a space. `key` is what maps and command lines call it; `others` are spaces whose names it may
    /// take over by `like`.
    ///
    /// ```toml
    /// title = "ours"
    /// source = "where this is written down"
    /// sides = ["Left", "Right"]            # what `*` in names stands for
    /// names = [
    ///   { name = "wink*", means = "The * eye closes.", aliases = ["blink*"] },
    ///   { name = "jaw", means = "The jaw drops, in degrees.", min = 0, max = 20 },
    /// ]
    /// ```
    ///
    /// Further keys of a name are `rest`, `side` ("left" or "right", for a name that has no `*`) and `sides`;
    /// of the whole `prefix` (stands before each name), `like` with `without` (names of another space, behind
    /// those here), and `order` (all names, in the order of the values).
    ///
    /// # Errors
    /// What is misspelt, of another type or out of range; a name or alias that two names have.
    pub fn from_toml(key: &str, text: &str, others: &[&Self]) -> Result<Self, TomlError> {
        text::read(key, text, others)
    }

    /// One without names.
    pub(crate) fn empty(key: &str) -> Self {
        Self {
            key: key.to_owned(),
            title: String::new(),
            source: String::new(),
            names: Vec::new(),
            pairs: HashMap::new(),
            known: HashMap::new(),
        }
    }

    /// What maps and command lines call it: `arkit`.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// What people call it: `ARKit`.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Where its names are written down.
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Its names, in the order of its values.
    pub fn names(&self) -> &[Name] {
        &self.names
    }

    /// The number of its values.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether it has no names.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// The place of a name, as it is written.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|other| other.name == name)
    }

    /// The place of a name or alias in any spelling: upper and lower case and what separates words do not
    /// count, and sides can be letters.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.known.get(&plain(name)).copied()
    }

    /// All that [`Self::find`] knows: each spelling as [`plain`] makes it, and the place of its name.
    pub fn spellings(&self) -> impl Iterator<Item = (&str, usize)> {
        self.known.iter().map(|(spelling, place)| (spelling.as_str(), *place))
    }

    /// The values of a face at rest.
    pub fn rest(&self) -> Vec<f32> {
        self.names.iter().map(|name| name.rest).collect()
    }

    /// Both sides of a name with `*` where they differ, as `eyeBlink*`.
    pub fn pair(&self, pattern: &str) -> Option<[usize; 2]> {
        self.pairs.get(pattern).copied()
    }

    /// Names as texts may write them, in a fixed order: the patterns with `*`, then every name.
    pub(crate) fn written(&self) -> impl Iterator<Item = &str> {
        let mut patterns: Vec<&str> = self.pairs.keys().map(String::as_str).collect();
        patterns.sort_unstable();
        patterns.into_iter().chain(self.names.iter().map(|name| name.name.as_str()))
    }
}
