use anyhow::{Context, Result, bail};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Writes a file whole or not at all: beside its place, then renamed. What is no regular file (a terminal, a pipe,
/// `/dev/null`) is written to directly, for a rename would replace it.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let what = || format!("{}: expected a file that can be written", path.display());
    let metadata = std::fs::metadata(path);
    match &metadata {
        Ok(metadata) if metadata.is_dir() => {
            bail!("{}: expected the name of a file to write, found a folder", path.display())
        }
        Ok(metadata) if !metadata.is_file() => return std::fs::write(path, bytes).with_context(what),
        _ => {}
    }
    // A link keeps pointing to the file that it names.
    let path =
        if metadata.is_ok() { std::fs::canonicalize(path).with_context(what)? } else { path.to_owned() };
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    if !folder.is_dir() {
        bail!("{}: expected a folder to write to, found none", folder.display());
    }
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As for any new file: the umask takes away what it must.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.prefix(".avatar-viewer-").tempfile_in(&folder).with_context(what)?;
    file.write_all(bytes).with_context(what)?;
    file.persist(&path).with_context(what)?;
    Ok(())
}

/// Prints to standard output, all or an error.
pub(crate) fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).context("standard output")
}

/// Whether the error is that nobody reads our output any more.
pub(crate) fn is_closed_pipe(error: &anyhow::Error) -> bool {
    let io = error.downcast_ref::<std::io::Error>();
    io.is_some_and(|error| error.kind() == ErrorKind::BrokenPipe)
}
