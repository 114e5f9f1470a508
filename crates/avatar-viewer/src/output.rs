use anyhow::{Context, Result, bail};
use std::fs::Permissions;
use std::io::{BufWriter, ErrorKind, Seek, StdoutLock, Write};
use std::path::{Path, PathBuf};
use tempfile::{NamedTempFile, TempDir};

/// A file to be written, whole or not at all. Checked before the work, so that a slip in a name costs
/// nothing.
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
        if matches!(self.kind, Kind::Device) {
            return std::fs::write(&self.path, bytes).with_context(|| self.expected());
        }
        let mut draft = self.draft()?;
        draft.write_all(bytes).with_context(|| self.expected())?;
        self.commit(draft)
    }

    /// An empty file that is to become this one. It vanishes when it is dropped.
    pub(crate) fn draft(&self) -> Result<NamedTempFile> {
        let mut builder = tempfile::Builder::new();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As for any new file; the umask then removes permissions.
            builder.permissions(Permissions::from_mode(0o666));
        }
        builder.prefix(DRAFT);
        let file = match self.kind {
            Kind::File(_) => builder.tempfile_in(folder_of(&self.path)),
            Kind::Device => builder.tempfile(),
        };
        file.map_err(without_path).with_context(|| self.expected())
    }

    /// Puts a draft that is written in this file's place.
    pub(crate) fn commit(&self, mut draft: NamedTempFile) -> Result<()> {
        match &self.kind {
            Kind::File(permissions) => {
                if let Some(permissions) = permissions {
                    let set = draft.as_file().set_permissions(permissions.clone());
                    set.with_context(|| self.expected())?;
                }
                let put = draft.persist(&self.path).map_err(|error| error.error);
                put.with_context(|| self.expected())?;
            }
            Kind::Device => {
                copy_to(&mut draft, &self.path).with_context(|| self.expected())?;
            }
        }
        Ok(())
    }

    /// The path and what was expected there, for error messages.
    pub(crate) fn expected(&self) -> String {
        format!("{}: expected a file that can be written", self.path.display())
    }
}

/// A folder to be made and filled, whole or not at all.
#[derive(Debug)]
pub(crate) struct OutputFolder(PathBuf);

impl OutputFolder {
    /// Checks that the name is free, or that of an empty folder.
    pub(crate) fn check(named: &Path) -> Result<Self> {
        // Without the separator at its end, which would hide the name of what is beside it.
        let path: PathBuf = named.components().collect();
        match std::fs::read_dir(&path) {
            Ok(mut entries) => {
                if entries.next().is_some() {
                    bail!("{}: expected a new or an empty folder, found one with files", named.display());
                }
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(_) if !path.is_dir() => {
                bail!("{}: expected a new or an empty folder, found a file", named.display())
            }
            Err(error) => Err(error).with_context(|| format!("{}: expected a folder", named.display()))?,
        }
        let folder = folder_of(&path);
        if !folder.is_dir() {
            bail!("{}: expected a folder to write to, found none", folder.display());
        }
        Ok(Self(path))
    }

    /// An empty folder that is to become this one. It vanishes when it is dropped, with all that is in it.
    pub(crate) fn draft(&self) -> Result<TempDir> {
        let mut builder = tempfile::Builder::new();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(Permissions::from_mode(0o777));
        }
        let folder = builder.prefix(DRAFT).tempdir_in(folder_of(&self.0));
        folder.map_err(without_path).with_context(|| self.expected())
    }

    /// Puts a draft that is filled in this folder's place.
    pub(crate) fn commit(&self, draft: TempDir) -> Result<()> {
        match std::fs::remove_dir(&self.0) {
            Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
            _ => std::fs::rename(draft.path(), &self.0),
        }
        .with_context(|| self.expected())
    }

    /// Fills the folder with these files and no others.
    pub(crate) fn write(&self, files: &[(String, Vec<u8>)]) -> Result<()> {
        let draft = self.draft()?;
        for (name, bytes) in files {
            std::fs::write(draft.path().join(name), bytes)
                .map_err(without_path)
                .with_context(|| self.expected())?;
        }
        self.commit(draft)
    }

    /// The path and what was expected there, for error messages.
    pub(crate) fn expected(&self) -> String {
        format!("{}: expected a folder that can be written", self.0.display())
    }
}

/// Names of unfinished files begin with this.
const DRAFT: &str = ".avatar-viewer-";

/// Copies the contents of a file to a device.
fn copy_to(file: &mut NamedTempFile, device: &Path) -> std::io::Result<u64> {
    file.rewind()?;
    std::io::copy(file, &mut std::fs::OpenOptions::new().write(true).open(device)?)
}

/// How many links in a row are followed; a longer chain is taken for a circle.
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

/// Whether the error says that the reader of our output has closed the pipe.
pub(crate) fn is_closed_pipe(error: &anyhow::Error) -> bool {
    let io = error.chain().find_map(|cause| cause.downcast_ref::<std::io::Error>());
    io.is_some_and(|error| error.kind() == ErrorKind::BrokenPipe)
}
