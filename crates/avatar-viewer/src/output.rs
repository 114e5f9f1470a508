use crate::drafts::{DraftFile, DraftFolder};
use crate::standard;
use crate::usage::usage;
use anyhow::{Context, Error, Result, bail};
use std::fs::{File, OpenOptions, Permissions};
use std::io::{BufWriter, ErrorKind, IntoInnerError, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// A file to be written, whole or not at all. Checked before the work, so that a slip in a name costs
/// nothing.
#[derive(Debug)]
pub(crate) struct OutputFile {
    path: PathBuf,
    kind: Kind,
    contents: Contents,
}

#[derive(Debug)]
enum Kind {
    /// Written beside its place, then renamed; an old file's permissions stay.
    File(Option<Permissions>),
    /// A terminal, a pipe, `/dev/null`: written to directly, for a rename would replace it.
    Device,
    /// Standard output.
    Standard,
}

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Contents {
    /// For people and for programs; every line is of use by itself.
    Text,
    /// For programs, and of use only as a whole. In words, such as "a picture".
    Binary(&'static str),
}

/// The name of standard output.
pub(crate) const STANDARD: &str = "-";

/// Whether there is no name whose end could say a format: standard output, or a device.
pub(crate) fn is_nameless(path: &Path) -> bool {
    path.as_os_str() == STANDARD
        || std::fs::metadata(path).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir())
}

impl OutputFile {
    /// Checks that a file can be made there; `-` is standard output.
    pub(crate) fn check(named: &Path, contents: Contents) -> Result<Self> {
        if named.as_os_str() == STANDARD {
            refuse_terminal(&std::io::stdout(), named, contents)?;
            return Ok(Self { path: named.to_owned(), kind: Kind::Standard, contents });
        }
        if named.to_string_lossy().ends_with(std::path::is_separator) {
            bail!("{}: expected the name of a file to write, found that of a folder", named.display());
        }
        // A link keeps pointing to the file that it names, also where that file is yet to be made.
        let mut path = named.to_owned();
        for _ in 0..MAX_LINKS {
            // The system's links to open pipes lead to no name (`/dev/stdout`).
            let Some(target) = std::fs::read_link(&path).ok().filter(|_| !is_nameless(&path)) else { break };
            path = folder_of(&path).join(target);
        }
        if std::fs::read_link(&path).is_ok() && !is_nameless(&path) {
            bail!("{}: expected the name of a file to write, found links in a circle", named.display());
        }
        let kind = match std::fs::metadata(&path) {
            Ok(metadata) if metadata.is_dir() => {
                bail!("{}: expected the name of a file to write, found a folder", named.display())
            }
            Ok(metadata) if metadata.is_file() => Kind::File(Some(metadata.permissions())),
            Ok(metadata) => {
                if is_character_device(&metadata) {
                    refuse_terminal(&open_device(&path).with_context(|| expected(named))?, named, contents)?;
                }
                Kind::Device
            }
            Err(_) => Kind::File(None),
        };
        check_folder(&folder_of(&path))?;
        Ok(Self { path, kind, contents })
    }

    /// Writes the file.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<()> {
        self.stream(|out| Ok(out.write_all(bytes)?))
    }

    /// Writes the file piece by piece.
    ///
    /// # Errors
    /// What `write` says, or a place that cannot be written to.
    pub(crate) fn stream(&self, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
        match (&self.kind, self.contents) {
            (Kind::Standard, Contents::Text) => standard::stream(|out| write(out)),
            (Kind::Standard, Contents::Binary(_)) => standard::whole(write),
            (Kind::Device, _) => {
                let mut out = BufWriter::new(open_device(&self.path).with_context(|| self.expected())?);
                let written = write(&mut out).and_then(|()| Ok(out.flush()?));
                written.map_err(|error| self.placed(error))
            }
            (Kind::File(_), _) => {
                let mut out = BufWriter::new(self.draft()?);
                write(&mut out).map_err(|error| self.placed(error))?;
                let draft = out.into_inner().map_err(IntoInnerError::into_error);
                self.commit(draft.with_context(|| self.expected())?)
            }
        }
    }

    /// An empty file that is to become this one. It vanishes when it is dropped.
    pub(crate) fn draft(&self) -> Result<DraftFile> {
        let draft = match self.kind {
            Kind::File(_) => DraftFile::new(Some(&folder_of(&self.path))),
            Kind::Device | Kind::Standard => DraftFile::new(None),
        };
        draft.with_context(|| self.expected())
    }

    /// Puts a draft that is written in this file's place.
    pub(crate) fn commit(&self, mut draft: DraftFile) -> Result<()> {
        match &self.kind {
            Kind::File(permissions) => {
                if let Some(permissions) = permissions {
                    let set = draft.as_file().set_permissions(permissions.clone());
                    set.with_context(|| self.expected())?;
                }
                draft.persist(&self.path).with_context(|| self.expected())
            }
            Kind::Device => {
                let copied = open_device(&self.path).and_then(|device| draft.copy_to(device));
                copied.with_context(|| self.expected())
            }
            Kind::Standard => standard::whole(|out| Ok(draft.copy_to(out)?)),
        }
    }

    /// What the system says needs the name of the file; the rest speaks for itself.
    fn placed(&self, error: Error) -> Error {
        if error.is::<std::io::Error>() { error.context(self.expected()) } else { error }
    }

    /// The path and what was expected there, for error messages.
    pub(crate) fn expected(&self) -> String {
        match self.kind {
            Kind::Standard => "standard output".to_owned(),
            _ => expected(&self.path),
        }
    }
}

fn expected(path: &Path) -> String {
    format!("{}: expected a file that can be written", path.display())
}

/// What is not text would only leave a terminal in disorder.
fn refuse_terminal(out: &impl IsTerminal, named: &Path, contents: Contents) -> Result<()> {
    match contents {
        Contents::Binary(what) if out.is_terminal() => Err(usage(format!(
            "--out {}: expected a file or a pipe for {what}, found a terminal, which shows text only",
            named.display()
        ))),
        _ => Ok(()),
    }
}

fn open_device(path: &Path) -> std::io::Result<File> {
    OpenOptions::new().write(true).open(path)
}

#[cfg(unix)]
fn is_character_device(metadata: &std::fs::Metadata) -> bool {
    std::os::unix::fs::FileTypeExt::is_char_device(&metadata.file_type())
}

#[cfg(not(unix))]
fn is_character_device(_: &std::fs::Metadata) -> bool {
    false
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
            // Below a file: the folder that was to hold this one is at fault.
            Err(_) if !path.exists() => {}
            Err(_) if !path.is_dir() => {
                bail!("{}: expected a new or an empty folder, found a file", named.display())
            }
            Err(error) => Err(error).with_context(|| format!("{}: expected a folder", named.display()))?,
        }
        check_folder(&folder_of(&path))?;
        Ok(Self(path))
    }

    /// An empty folder that is to become this one. It vanishes when it is dropped, with all that is in it.
    pub(crate) fn draft(&self) -> Result<DraftFolder> {
        DraftFolder::new(&folder_of(&self.0)).with_context(|| self.expected())
    }

    /// Puts a draft that is filled in this folder's place.
    pub(crate) fn commit(&self, draft: DraftFolder) -> Result<()> {
        match std::fs::remove_dir(&self.0) {
            Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
            _ => draft.persist(&self.0),
        }
        .with_context(|| self.expected())
    }

    /// Fills the folder with these files and no others.
    pub(crate) fn write(&self, files: &[(String, Vec<u8>)]) -> Result<()> {
        let draft = self.draft()?;
        for (name, bytes) in files {
            draft.write(name, bytes).with_context(|| self.expected())?;
        }
        self.commit(draft)
    }

    /// The path and what was expected there, for error messages.
    pub(crate) fn expected(&self) -> String {
        format!("{}: expected a folder that can be written", self.0.display())
    }
}

/// Checks that there is a folder to write to.
fn check_folder(folder: &Path) -> Result<()> {
    if !folder.is_dir() {
        let found = if folder.exists() { "a file" } else { "none" };
        bail!("{}: expected a folder to write to, found {found}", folder.display());
    }
    Ok(())
}

/// How many links in a row are followed; a longer chain is taken for a circle.
const MAX_LINKS: usize = 40;

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}
