use std::fmt;

/// A place in a file where the scene differs from it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Note {
    /// Where it is, in the words of [`crate::ImportError::place`].
    pub place: String,
    /// What about it.
    pub finding: Finding,
}

/// How a scene differs from its file. The texts are whole predicates or sentences for people; programs match
/// the kind.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Finding {
    /// The file has it and the scene does not.
    LeftOut(String),
    /// The file contradicts its format, or lacks something that a scene needs: what was taken instead.
    Mended(String),
    /// The scene has the same in another form: axes, units, four bones of many.
    Converted(String),
    /// The file refers to something that was not found.
    Missing(String),
    /// The file uses an extension of this name, which the scene does not represent.
    Extension(String),
}

impl Finding {
    /// [`Finding::LeftOut`] with a text.
    pub fn left_out(text: impl Into<String>) -> Self {
        Self::LeftOut(text.into())
    }

    /// [`Finding::Mended`] with a text.
    pub fn mended(text: impl Into<String>) -> Self {
        Self::Mended(text.into())
    }

    /// [`Finding::Converted`] with a text.
    pub fn converted(text: impl Into<String>) -> Self {
        Self::Converted(text.into())
    }

    /// [`Finding::Missing`] with a text.
    pub fn missing(text: impl Into<String>) -> Self {
        Self::Missing(text.into())
    }
}

impl Note {
    /// A finding at a place.
    pub fn new(place: impl Into<String>, finding: Finding) -> Self {
        Self { place: place.into(), finding }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LeftOut(text) | Self::Mended(text) | Self::Converted(text) | Self::Missing(text) => {
                f.write_str(text)
            }
            Self::Extension(name) => write!(f, "{name} is not represented"),
        }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.finding)
    }
}
