//! Standard output and standard error, either of which may be gone: what nobody reads is no reason to panic,
//! as `println!` does.

use anyhow::{Context, Result, anyhow};
use std::fmt::Display;
use std::io::{BufWriter, ErrorKind, StdoutLock, Write};

/// Writes a line to standard error.
pub(crate) fn tell(line: impl Display) {
    // Nothing is lost if nobody reads it.
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Writes a warning to standard error.
pub(crate) fn warn(text: impl Display) {
    tell(format_args!("warning: {text}"));
}

/// Prints a text to standard output, all or an error.
pub(crate) fn print(text: &str) -> Result<()> {
    stream(|out| Ok(out.write_all(text.as_bytes())?))
}

/// Prints a text to standard output piece by piece, so that long output needs no room.
pub(crate) fn stream(write: impl FnOnce(&mut BufWriter<StdoutLock<'static>>) -> Result<()>) -> Result<()> {
    let mut out = BufWriter::new(std::io::stdout().lock());
    write(&mut out).context("standard output")?;
    out.flush().context("standard output")
}

/// Writes what is of use only as a whole, such as a picture, to standard output.
///
/// # Errors
/// Whoever reads it went away before its end, which is no mistake with a text ([`is_closed_pipe`]).
pub(crate) fn whole(write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let mut out = BufWriter::new(std::io::stdout().lock());
    let written = write(&mut out).and_then(|()| Ok(out.flush()?));
    written.map_err(|error| match is_closed_pipe(&error) {
        true => {
            anyhow!("standard output: expected a reader that takes all of it, found a pipe that was closed")
        }
        false => error.context("standard output"),
    })
}

/// Whether the error says that the reader of our text has closed the pipe.
pub(crate) fn is_closed_pipe(error: &anyhow::Error) -> bool {
    let io = error.chain().find_map(|cause| cause.downcast_ref::<std::io::Error>());
    io.is_some_and(|error| error.kind() == ErrorKind::BrokenPipe)
}
