use pose_anim::TomlError;

/// What keeps a text from being read or edited.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BookError {
    /// A text that is not as its format demands.
    #[error(transparent)]
    Text(Box<TomlError>),
    /// An edit after which the text would not be as its format demands; the place is one in the text as it
    /// would be.
    #[error("cannot {edit}: {source}")]
    Refused {
        /// What was to be done.
        edit: String,
        /// What would be wrong.
        source: Box<TomlError>,
    },
    /// No entry at this place.
    #[error("expected an index below {len}, found {index}")]
    Index {
        /// The index that was given.
        index: usize,
        /// How many there are.
        len: usize,
    },
}

impl From<TomlError> for BookError {
    fn from(error: TomlError) -> Self {
        Self::Text(Box::new(error))
    }
}
