//! Where poses and clips that a user makes are kept.

use crate::output::{Contents, OutputFile};
use crate::reading;
use anyhow::{Context, Result, anyhow};
use avatar_pack::files;
use std::path::{Path, PathBuf};

/// Names of the files, and their places in [`Store`].
pub(crate) const POSES: usize = 0;
pub(crate) const CLIPS: usize = 1;
pub(crate) const NAMES: [&str; 2] = [files::POSES, files::CLIPS];

/// The files that hold an avatar's poses and clips.
#[derive(Debug)]
pub(crate) struct Store {
    paths: [Option<PathBuf>; 2],
    /// Links must not lead out of the folder: somebody else made it.
    is_confined: bool,
    /// The texts that were taken over or written last.
    taken: [String; 2],
    /// Texts written by another program that the user was told of, and may replace.
    known: [Option<String>; 2],
}

impl Store {
    /// Poses and clips in these files, if there can be files; `is_confined` refuses links out of their
    /// folder.
    pub(crate) fn new(paths: [Option<PathBuf>; 2], is_confined: bool) -> Self {
        Self { paths, is_confined, taken: Default::default(), known: Default::default() }
    }

    /// Where a file is, if there can be one.
    pub(crate) fn path(&self, which: usize) -> Option<&Path> {
        self.paths[which].as_deref()
    }

    /// The file's text; `None` where there is none.
    pub(crate) fn read(&self, which: usize) -> Result<Option<String>> {
        let Some(path) = self.path(which) else { return Ok(None) };
        if self.is_confined { reading::text_within_its_folder(path) } else { reading::text(path) }
    }

    /// The text that was taken over or written last.
    pub(crate) fn text(&self, which: usize) -> &str {
        &self.taken[which]
    }

    /// A text that was read has been taken over.
    pub(crate) fn take(&mut self, which: usize, text: String) {
        self.taken[which] = text;
        self.known[which] = None;
    }

    /// The user was told of this text, which is not taken over: it may be replaced.
    pub(crate) fn tell(&mut self, which: usize, text: String) {
        self.known[which] = Some(text);
    }

    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// The file was changed by another program and the user was not told yet: writing would lose that change.
    pub(crate) fn write(&mut self, which: usize, text: &str) -> Result<()> {
        if text == self.taken[which] {
            return Ok(());
        }
        let others = self.read(which)?.filter(|found| *found != self.taken[which]);
        if others.is_some() && others != self.known[which] {
            return Err(self.placed(
                which,
                &"expected the text that was read last, found another one, which would be lost: mend it first, or move it away",
            ));
        }
        let path = self.path(which);
        let path = path.ok_or_else(|| {
            anyhow!("expected a folder of the user's to write {} to, found none", NAMES[which])
        })?;
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)
                .with_context(|| format!("{}: expected a folder that can be made", folder.display()))?;
        }
        OutputFile::check(path, Contents::Text)?.write(text.as_bytes())?;
        self.take(which, text.to_owned());
        Ok(())
    }

    /// An error in a file, with its name before its place.
    pub(crate) fn placed(&self, which: usize, error: &dyn std::fmt::Display) -> anyhow::Error {
        match self.path(which) {
            Some(path) => anyhow!("{}: {error}", path.display()),
            None => anyhow!("{error}"),
        }
    }
}
