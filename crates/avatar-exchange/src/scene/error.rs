/// Why a file could not be read: where it is wrong, and in which way.
///
/// One type for all formats, since what a caller can do about it is the same: show it. Errors of
/// [`crate::Scene::from_raw`] have no file until a reader adds it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{place}: expected {expected}, found {found}", file_prefix(.file))]
pub struct ImportError {
    /// Name of the file, as the caller gave it; may be empty.
    pub file: String,
    /// The place in it: "accessor 3", "animation 'Wave', channel 2", "byte 12".
    pub place: String,
    /// What should stand there.
    pub expected: String,
    /// What stands there.
    pub found: String,
}

fn file_prefix(file: &str) -> String {
    if file.is_empty() { String::new() } else { format!("{file}: ") }
}

/// Characters of a name that messages show.
const SHOWN: usize = 60;

/// A name in a message: quoted, and cut where it is longer than [`SHOWN`], since a file decides how long its
/// names are and how many messages show them.
pub(crate) fn quoted(name: &str) -> String {
    match name.char_indices().nth(SHOWN) {
        None => format!("'{name}'"),
        Some((end, _)) => format!("'{}…'", &name[..end]),
    }
}

/// Characters of each text of an error. Our own lists of what is possible are shorter.
const TEXT_SHOWN: usize = 1000;

/// A text of an error, cut where it is longer than [`TEXT_SHOWN`]: it repeats identifiers and names, and a
/// file decides how long these are.
fn shown(mut text: String) -> String {
    if let Some((end, _)) = text.char_indices().nth(TEXT_SHOWN) {
        text.truncate(end);
        text.push('…');
    }
    text
}

impl ImportError {
    /// An error at a place of a file that is not known here; see [`ImportError::in_file`]. Of each text
    /// the first 1000 characters are told.
    pub fn new(place: impl Into<String>, expected: impl Into<String>, found: impl Into<String>) -> Self {
        let (place, expected) = (shown(place.into()), shown(expected.into()));
        let mut found = shown(found.into());
        if found.is_empty() {
            found.push_str("an empty text");
        }
        Self { file: String::new(), place, expected, found }
    }

    /// The same, in a file of this name.
    #[must_use]
    pub fn in_file(self, file: &str) -> Self {
        Self { file: file.to_owned(), ..self }
    }
}
