use crate::{Format, Rate};

/// Why a film or picture could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// A picture without pixels, or with more than the format holds.
    #[error(
        "{format}: expected a size from 1x1 to {} (either way round), found {width}x{height}",
        Format::words(*largest)
    )]
    Size {
        /// The format.
        format: Format,
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// Longer and shorter side of the largest picture.
        largest: (u32, u32),
    },
    /// A rate that the format cannot show.
    #[error("{format}: expected at most {most} frames per second, found {rate}")]
    Rate {
        /// The format.
        format: Format,
        /// What was asked for.
        rate: Rate,
        /// The fastest.
        most: u32,
    },
    /// A frame of another size than the film's.
    #[error("expected a frame of {expected} bytes, found {found}")]
    Frame {
        /// Bytes of a frame of the film's size.
        expected: usize,
        /// Bytes that were given.
        found: usize,
    },
    /// A film that ends before its first frame.
    #[error("expected at least one frame, found none")]
    NoFrames,
    /// A sound that the film cannot have.
    #[error("{format}: expected {expected}, found {found}")]
    Sound {
        /// The format.
        format: Format,
        /// What would have been right.
        expected: String,
        /// What was given.
        found: String,
    },
    /// More frames than the format counts.
    #[error("{format}: expected at most {most} frames")]
    TooManyFrames {
        /// The format.
        format: Format,
        /// How many there can be.
        most: u32,
    },
    /// A text that a PNG cannot hold.
    #[error("expected a keyword of 1 to 79 Latin letters and a text, found {keyword:?}: {reason}")]
    Text {
        /// Keyword of the text.
        keyword: String,
        /// What the encoder says.
        reason: String,
    },
    /// The encoder gave up.
    #[error("{format}: {reason}")]
    Encoder {
        /// The format.
        format: Format,
        /// What the encoder says.
        reason: String,
    },
    /// The sink takes no more.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

impl FilmError {
    pub(crate) fn encoder(format: Format, reason: impl ToString) -> Self {
        Self::Encoder { format, reason: reason.to_string() }
    }
}
