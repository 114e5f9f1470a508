//! What the program remembers of its user: in one folder, as TOML that a person can read.

use crate::output::{Contents, OutputFile};
use crate::reading;
use anyhow::Result;
use avatar_panel::PanelState;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The user's folder for this program; `None` where the system has no such place.
pub(crate) fn folder() -> Option<PathBuf> {
    directories::ProjectDirs::from("", "", "mimik").map(|project| project.config_dir().to_owned())
}

/// More files than these are not remembered.
const RECENT: usize = 10;
const FILE: &str = "viewer.toml";

/// Settings that are kept from run to run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Config {
    /// Size of the window in pixels.
    pub(crate) window: Option<[u32; 2]>,
    /// Avatars that were open, the last one first.
    pub(crate) recent: Vec<PathBuf>,
    /// The panel as it was left.
    pub(crate) panel: PanelState,
}

impl Config {
    /// What was remembered; with a message where the file cannot be understood, which is no reason not to
    /// start.
    pub(crate) fn load() -> (Self, Option<String>) {
        let Some(path) = folder().map(|folder| folder.join(FILE)) else { return Default::default() };
        let read = reading::text(&path).map_err(|error| format!("{error:#}"));
        let parsed = read.and_then(|text| {
            let text = text.unwrap_or_default();
            toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))
        });
        match parsed {
            Ok(config) => (config, None),
            Err(message) => (Self::default(), Some(message)),
        }
    }

    /// Remembers.
    ///
    /// # Errors
    /// The folder or file cannot be written.
    pub(crate) fn save(&self) -> Result<()> {
        let Some(folder) = folder() else { return Ok(()) };
        std::fs::create_dir_all(&folder)?;
        OutputFile::check(&folder.join(FILE), Contents::Text)?.write(toml::to_string(self)?.as_bytes())
    }

    /// Puts an avatar at the top of those that were open.
    pub(crate) fn opened(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(RECENT);
    }
}
