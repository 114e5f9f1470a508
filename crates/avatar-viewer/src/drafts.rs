//! Files and folders that are not finished. They are removed where the program fails, and also where it is
//! asked to end by the keyboard (Ctrl+C) or the system.

use crate::standard;
use anyhow::{Context, Result};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::{Builder, NamedTempFile, TempDir};

/// What there is at this moment.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
/// Whether the program was asked to end.
static ASKED: AtomicBool = AtomicBool::new(false);
/// Whether somebody looks at [`ASKED`] again and again, and ends the program then.
static IS_POLLED: AtomicBool = AtomicBool::new(false);
/// How often a folder is emptied into which another thread still writes.
const ATTEMPTS: usize = 20;

/// Names of unfinished files begin with this.
const PREFIX: &str = ".avatar-viewer-";

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Listens from now on whether the program is asked to end.
fn listen() -> Result<()> {
    static LISTENS: Mutex<bool> = Mutex::new(false);
    let mut listens = LISTENS.lock().unwrap_or_else(PoisonError::into_inner);
    if !*listens {
        ctrlc::set_handler(end).context("expected to be told of interrupts")?;
        *listens = true;
    }
    Ok(())
}

/// The program was asked to end. Who is asked twice does not wait.
fn end() {
    if !ASKED.swap(true, Ordering::Relaxed) && IS_POLLED.load(Ordering::Relaxed) {
        return;
    }
    // Nobody can make another one before the program has ended.
    let unfinished = unfinished();
    for path in unfinished.iter() {
        let removed = |_: &usize| match path.is_dir() {
            true => std::fs::remove_dir_all(path).is_ok(),
            false => std::fs::remove_file(path).is_ok() || !path.exists(),
        };
        let _ = (0..ATTEMPTS).find(removed);
    }
    standard::tell("error: interrupted: what was not finished was removed");
    exit(1);
}

/// For work of many steps that ends by itself when the program is asked to end.
#[derive(Debug)]
pub(crate) struct Interrupts(());

impl Interrupts {
    /// From now on, whoever holds this has to look at [`Self::came`].
    pub(crate) fn poll() -> Result<Self> {
        listen()?;
        IS_POLLED.store(true, Ordering::Relaxed);
        Ok(Self(()))
    }

    /// Whether the program was asked to end.
    pub(crate) fn came(&self) -> bool {
        ASKED.load(Ordering::Relaxed)
    }
}

impl Drop for Interrupts {
    fn drop(&mut self) {
        IS_POLLED.store(false, Ordering::Relaxed);
    }
}

/// The place of an unfinished file or folder in the list.
#[derive(Debug)]
struct Entry(PathBuf);

impl Entry {
    fn make<T>(make: impl FnOnce() -> std::io::Result<T>, path: impl Fn(&T) -> &Path) -> Result<(T, Self)> {
        listen()?;
        let mut unfinished = unfinished();
        let made = make().map_err(without_path)?;
        let path = path(&made).to_owned();
        unfinished.push(path.clone());
        Ok((made, Self(path)))
    }
}

impl Drop for Entry {
    fn drop(&mut self) {
        unfinished().retain(|path| *path != self.0);
    }
}

/// An unfinished file. It vanishes when it is dropped.
#[derive(Debug)]
pub(crate) struct DraftFile {
    // Dropped in this order.
    file: NamedTempFile,
    entry: Entry,
}

impl DraftFile {
    /// An empty file in this folder, or where the system keeps such files.
    pub(crate) fn new(folder: Option<&Path>) -> Result<Self> {
        let mut builder = Builder::new();
        #[cfg(unix)]
        if folder.is_some() {
            use std::os::unix::fs::PermissionsExt;
            // As for any new file; the umask then removes permissions.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        builder.prefix(PREFIX);
        let make = || match folder {
            Some(folder) => builder.tempfile_in(folder),
            None => builder.tempfile(),
        };
        let (file, entry) = Entry::make(make, NamedTempFile::path)?;
        Ok(Self { file, entry })
    }

    /// The file itself.
    pub(crate) fn as_file(&self) -> &std::fs::File {
        self.file.as_file()
    }

    /// The file under another name, finished.
    pub(crate) fn persist(self, path: &Path) -> std::io::Result<()> {
        let Self { file, entry } = self;
        let put = file.persist(path).map_err(|error| error.error);
        drop(entry);
        put.map(drop)
    }

    /// Copies its contents.
    pub(crate) fn copy_to(&mut self, mut out: impl Write) -> std::io::Result<()> {
        self.file.rewind()?;
        std::io::copy(&mut self.file, &mut out)?;
        out.flush()
    }
}

impl Write for DraftFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.file.write(bytes).map_err(without_path)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush().map_err(without_path)
    }
}

impl Seek for DraftFile {
    fn seek(&mut self, position: SeekFrom) -> std::io::Result<u64> {
        self.file.seek(position).map_err(without_path)
    }
}

/// An unfinished folder. It vanishes when it is dropped, with all that is in it.
#[derive(Debug)]
pub(crate) struct DraftFolder {
    // Dropped in this order.
    folder: TempDir,
    entry: Entry,
}

impl DraftFolder {
    /// An empty folder in this one.
    pub(crate) fn new(parent: &Path) -> Result<Self> {
        let mut builder = Builder::new();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(std::fs::Permissions::from_mode(0o777));
        }
        let (folder, entry) = Entry::make(|| builder.prefix(PREFIX).tempdir_in(parent), TempDir::path)?;
        Ok(Self { folder, entry })
    }

    /// Writes a file in it.
    pub(crate) fn write(&self, name: &str, bytes: &[u8]) -> std::io::Result<()> {
        std::fs::write(self.folder.path().join(name), bytes)
    }

    /// The folder under another name, finished.
    pub(crate) fn persist(self, path: &Path) -> std::io::Result<()> {
        let Self { folder, entry } = self;
        let put = std::fs::rename(folder.path(), path);
        if put.is_ok() {
            // It has another name now; there is nothing to be removed.
            let _ = folder.keep();
        }
        drop(entry);
        put
    }
}

/// The bare reason: the name of the temporary file would only confuse.
fn without_path(error: std::io::Error) -> std::io::Error {
    error.raw_os_error().map_or_else(|| error.kind().into(), std::io::Error::from_raw_os_error)
}
