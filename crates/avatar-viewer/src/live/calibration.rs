//! The file that keeps a person's neutral face, and how much stronger the avatar shall move.

use crate::output::{Contents, OutputFile};
use crate::reading;
use anyhow::{Context, Result, anyhow};
use avatar_live::Calibration;
use std::path::{Path, PathBuf};

/// Its name: in the folder of a pack, beside the file of an avatar behind that file's name, and for the
/// built-in avatar among the user's settings.
const CALIBRATION: &str = "calibration.toml";

/// Where a calibration is kept.
#[derive(Clone, Debug)]
pub(crate) struct CalibrationFile {
    path: PathBuf,
    /// Links must not lead out of the folder: somebody else made it.
    is_confined: bool,
}

impl CalibrationFile {
    /// The file that was named, or else that of the avatar, as `kept` says where it is and whether it is
    /// confined to its folder; `None` where there can be none.
    pub(crate) fn of(
        named: Option<&Path>,
        kept: impl FnOnce(&str) -> Option<(PathBuf, bool)>,
    ) -> Option<Self> {
        let named = named.map(|path| (path.to_owned(), false));
        let (path, is_confined) = named.or_else(|| kept(CALIBRATION))?;
        Some(Self { path, is_confined })
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// What is kept; one that changes nothing where there is no file yet.
    ///
    /// # Errors
    /// A file that cannot be read, with the place of what is wrong.
    pub(crate) fn read(&self) -> Result<Calibration> {
        let read = if self.is_confined { reading::text_within_its_folder } else { reading::text };
        let Some(text) = read(&self.path)? else { return Ok(Calibration::default()) };
        Calibration::from_toml(&text).map_err(|error| anyhow!("{}: {error}", self.path.display()))
    }

    /// Writes the file, whole or not at all.
    pub(crate) fn write(&self, calibration: &Calibration) -> Result<()> {
        if let Some(folder) = self.path.parent() {
            std::fs::create_dir_all(folder)
                .with_context(|| format!("{}: expected a folder that can be made", folder.display()))?;
        }
        OutputFile::check(&self.path, Contents::Text)?.write(calibration.to_toml().as_bytes())
    }
}
