use std::borrow::Cow;
use std::collections::BTreeMap;

/// Where the files of a pack come from.
pub trait Source {
    /// The bytes of the file of this name; `None` if there is no such file.
    ///
    /// # Errors
    /// The file is there, but could not be read.
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError>;

    /// How to name this file to a person; by default its bare name.
    fn locate(&self, name: &str) -> String {
        name.to_owned()
    }
}

/// Why a file that is there could not be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct SourceError(pub String);

/// Files in memory, by name.
#[derive(Clone, Debug, Default)]
pub struct MemorySource {
    /// Bytes by file name.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl Source for MemorySource {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        Ok(self.files.get(name).map(|bytes| Cow::Borrowed(bytes.as_slice())))
    }
}
