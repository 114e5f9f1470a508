use pose_anim::TomlError;

/// Why a text could not be read or edited.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BookError {
    /// A text that its format does not allow.
    #[error(transparent)]
    Text(Box<TomlError>),
    /// An edit after which its format would not allow the text. The place in the error is one in the text
    /// after the edit.
    #[error("cannot {edit}: {source}")]
    Refused {
        /// The edit.
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
