/// Brings a file that another one refers to: takes a relative path with `/` between folders, never absolute
/// and never leading upwards, and returns the file's bytes, or what went wrong.
pub type Resolve<'a> = dyn FnMut(&str) -> Result<Vec<u8>, String> + 'a;

/// A file with its name.
#[derive(Clone, Copy, Debug)]
pub struct TextFile<'a> {
    /// Name of the file, for messages; also the name of what is read from it where the file gives none.
    pub file: &'a str,
    /// Contents.
    pub bytes: &'a [u8],
}
