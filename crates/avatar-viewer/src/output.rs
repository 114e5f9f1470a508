use anyhow::{Context, Result, bail};
use std::fs::Permissions;
use std::io::{BufWriter, ErrorKind, StdoutLock, Write};
use std::path::{Path, PathBuf};

/// A file to be written, whole or not at all. Checked before the work, so that a slip in a name costs nothing.
#[derive(Debug)]
pub(crate) struct OutputFile {
    path: PathBuf,
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    /// Written beside its place, then renamed; an old file's permissions stay.
    File(Option<Permissions>),
    /// A terminal, a pipe, `/dev/null`: written to directly, for a rename would replace it.
    Device,
}

impl OutputFile {
    /// Checks that a file can be made there.
    pub(crate) fn check(named: &Path) -> Result<Self> {
        if named.to_string_lossy().ends_with(std::path::is_separator) {
            bail!("{}: expected the name of a file to write, found that of a folder", named.display());
        }
        // A link keeps pointing to the file that it names, also where that file is yet to be made.
        let mut path = named.to_owned();
        for _ in 0..MAX_LINKS {
            let Ok(target) = std::fs::read_link(&path) else { break };
            path = folder_of(&path).join(target);
        }
        let kind = match std::fs::metadata(&path) {
            Ok(metadata) if metadata.is_dir() => {
                bail!("{}: expected the name of a file to write, found a folder", named.display())
            }
            Ok(metadata) if metadata.is_file() => Kind::File(Some(metadata.permissions())),
            Ok(_) => Kind::Device,
            Err(_) => Kind::File(None),
        };
        let folder = folder_of(&path);
        if !folder.is_dir() {
            bail!("{}: expected a folder to write to, found none", folder.display());
        }
        Ok(Self { path, kind })
    }

    /// Writes the file.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<()> {
        let what = || format!("{}: expected a file that can be written", self.path.display());
        let Kind::File(permissions) = &self.kind else {
            return std::fs::write(&self.path, bytes).with_context(what);
        };
        let mut builder = tempfile::Builder::new();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As for any new file: the umask takes away what it must.
            builder.permissions(Permissions::from_mode(0o666));
        }
        let file = builder.prefix(".avatar-viewer-").tempfile_in(folder_of(&self.path));
        let mut file = file.map_err(without_path).with_context(what)?;
        file.write_all(bytes).with_context(what)?;
        if let Some(permissions) = permissions {
            file.as_file().set_permissions(permissions.clone()).with_context(what)?;
        }
        file.persist(&self.path).map_err(|error| error.error).with_context(what)?;
        Ok(())
    }
}

/// A folder to be written with all of its files, or not at all. Checked before the work.
#[derive(Debug)]
pub(crate) struct OutputFolder {
    path: PathBuf,
    /// Whether there is an empty folder to be replaced.
    is_there: bool,
}

impl OutputFolder {
    /// Checks that a folder can be made there, or that there is an empty one.
    pub(crate) fn check(named: &Path) -> Result<Self> {
        let shown = named.display();
        let (path, is_there) = match std::fs::read_dir(named) {
            Ok(mut entries) => {
                if entries.next().is_some() {
                    bail!("{shown}: expected an empty folder or none, found one with files");
                }
                let path = named.canonicalize();
                (path.with_context(|| format!("{shown}: expected a folder that can be written"))?, true)
            }
            Err(error) if error.kind() == ErrorKind::NotFound => (named.components().collect(), false),
            Err(error) => bail!("{shown}: expected an empty folder or none, found: {error}"),
        };
        let folder = folder_of(&path);
        if !folder.is_dir() {
            bail!("{}: expected a folder to write to, found none", folder.display());
        }
        Ok(Self { path, is_there })
    }

    /// Writes the folder with these files.
    pub(crate) fn write(&self, files: &[(String, Vec<u8>)]) -> Result<()> {
        let what = || format!("{}: expected a folder that can be written", self.path.display());
        let mut builder = tempfile::Builder::new();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(Permissions::from_mode(0o777));
        }
        let folder = builder.prefix(".avatar-viewer-").tempdir_in(folder_of(&self.path));
        let folder = folder.map_err(without_path).with_context(what)?;
        for (name, bytes) in files {
            std::fs::write(folder.path().join(name), bytes).map_err(without_path).with_context(what)?;
        }
        if self.is_there {
            // Fails where files came into it meanwhile.
            std::fs::remove_dir(&self.path).with_context(what)?;
        }
        std::fs::rename(folder.path(), &self.path).with_context(what)?;
        // It is no temporary folder any more.
        let _ = folder.keep();
        Ok(())
    }
}

/// Links that lead to links; more are a circle.
const MAX_LINKS: usize = 40;

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// The bare reason: the name of the temporary file would only confuse.
fn without_path(error: std::io::Error) -> std::io::Error {
    error.raw_os_error().map_or_else(|| error.kind().into(), std::io::Error::from_raw_os_error)
}

/// Prints to standard output, all or an error.
pub(crate) fn print(text: &str) -> Result<()> {
    stream(|out| Ok(out.write_all(text.as_bytes())?))
}

/// Prints to standard output piece by piece, so that long output needs no room.
pub(crate) fn stream(write: impl FnOnce(&mut BufWriter<StdoutLock<'static>>) -> Result<()>) -> Result<()> {
    let mut out = BufWriter::new(std::io::stdout().lock());
    write(&mut out).context("standard output")?;
    out.flush().context("standard output")
}

/// Whether the error is that nobody reads our output any more.
pub(crate) fn is_closed_pipe(error: &anyhow::Error) -> bool {
    let io = error.chain().find_map(|cause| cause.downcast_ref::<std::io::Error>());
    io.is_some_and(|error| error.kind() == ErrorKind::BrokenPipe)
}
