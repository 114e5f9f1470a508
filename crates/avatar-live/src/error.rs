use std::fmt;

/// Why bytes are no packet of a format. It owns nothing, so that a flood of bad packets costs no memory.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("byte {at}: expected {expected}, found {found}")]
#[non_exhaustive]
pub struct DecodeError {
    /// Offset of the byte, from 0.
    pub at: usize,
    /// What would have been right.
    pub expected: &'static str,
    /// What is there instead.
    pub found: Found,
}

/// What stands where something else was expected.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Found {
    /// The end of the bytes.
    End,
    /// So many bytes.
    Bytes(usize),
    /// This byte.
    Byte(u8),
    /// A number.
    Number(f64),
    /// Something else, which has a name.
    Other(&'static str),
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::End => f.write_str("the end"),
            Self::Bytes(count) => write!(f, "{count} bytes"),
            Self::Byte(byte) if byte.is_ascii_graphic() => write!(f, "{:?}", char::from(*byte)),
            Self::Byte(byte) => write!(f, "the byte {byte:#04x}"),
            Self::Number(number) => write!(f, "{number}"),
            Self::Other(what) => f.write_str(what),
        }
    }
}

impl DecodeError {
    pub(crate) const fn new(at: usize, expected: &'static str, found: Found) -> Self {
        Self { at, expected, found }
    }

    /// The same for bytes that stand further on.
    pub(crate) fn further(self, by: usize) -> Self {
        Self { at: self.at.saturating_add(by), ..self }
    }
}
