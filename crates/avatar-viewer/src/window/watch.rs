use crate::files::{Files, Place};
use crate::standard;
use crate::store::Store;
use avatar_pack::files;
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use std::path::{Path, PathBuf};
use winit::event_loop::EventLoopProxy;

/// What wakes the window beside its own events.
#[derive(Debug)]
pub(super) enum Wake {
    /// This file of the avatar may have changed.
    Changed(Watched),
    /// Something that another thread works at is ready to be taken.
    Ready,
    /// A sender's packets have arrived.
    Packet,
    /// The user has chosen a file to open.
    Chosen(PathBuf),
    /// The user has chosen a file to speak by.
    ChosenSpeech(PathBuf),
    /// A device of sound has failed, and why.
    SoundFailed(String),
    /// The user has chosen a recording of a face to play.
    ChosenRecording(PathBuf),
    /// The system has no dialog to choose one in.
    NoDialog,
    /// A screen reader asks for something, or acts for the user.
    Accessibility(accesskit_winit::Event),
}

impl From<accesskit_winit::Event> for Wake {
    fn from(event: accesskit_winit::Event) -> Self {
        Self::Accessibility(event)
    }
}

/// A file whose changes are taken over while the window is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Watched {
    Materials,
    Hair,
    Poses,
    Clips,
}

impl Watched {
    pub(super) const ALL: [Self; 4] = [Self::Materials, Self::Hair, Self::Poses, Self::Clips];

    fn path(self, files: &Files, store: &Store) -> Option<PathBuf> {
        let in_folder = |name: &str| match &files.place {
            Place::Folder(folder) => Some(folder.join(name)),
            _ => None,
        };
        match self {
            Self::Materials => in_folder(files::MATERIALS),
            Self::Hair => in_folder(files::HAIR),
            Self::Poses => store.path(crate::store::POSES).map(Path::to_owned),
            Self::Clips => store.path(crate::store::CLIPS).map(Path::to_owned),
        }
    }
}

/// Files are watched as long as this lives.
pub(super) struct Watching {
    _watcher: Option<RecommendedWatcher>,
    /// Folders that were not there.
    missing: Vec<PathBuf>,
}

impl Watching {
    /// Whether there are folders by now that are not watched.
    pub(super) fn is_behind(&self) -> bool {
        self.missing.iter().any(|folder| folder.is_dir())
    }
}

/// Tells the window when files of the avatar change that it follows. Folders are watched instead of files:
/// many editors put a new file in the place of the old one. Where watching does not work the window works all
/// the same, after a warning.
pub(super) fn watch(files: &Files, store: &Store, window: EventLoopProxy<Wake>) -> Watching {
    let paths: Vec<(Watched, PathBuf)> =
        Watched::ALL.into_iter().filter_map(|file| Some((file, file.path(files, store)?))).collect();
    let mut folders: Vec<PathBuf> =
        paths.iter().filter_map(|(_, path)| Some(path.parent()?.to_owned())).collect();
    folders.sort();
    folders.dedup();
    // The user's own folder may not be there yet.
    let is_there = |folder: &PathBuf| folder.as_os_str().is_empty() || folder.is_dir();
    let (folders, missing): (Vec<_>, Vec<_>) = folders.into_iter().partition(is_there);
    let changed = move |event: notify::Result<notify::Event>| {
        let Ok(event) = event else { return };
        // Reading a file is an event, too.
        if matches!(event.kind, EventKind::Access(_)) {
            return;
        }
        for (file, path) in &paths {
            if event.paths.iter().any(|changed| changed.file_name() == path.file_name()) {
                // An error means that the window is closed.
                let _ = window.send_event(Wake::Changed(*file));
            }
        }
    };
    let watcher = notify::recommended_watcher(changed).and_then(|mut watcher| {
        for folder in &folders {
            let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
            watcher.watch(folder, RecursiveMode::NonRecursive)?;
        }
        Ok(watcher)
    });
    let watcher = watcher
        .inspect_err(|error| {
            let folders =
                folders.iter().map(|folder| folder.display().to_string()).collect::<Vec<_>>().join(" and ");
            standard::warn(format_args!(
                "{folders}: expected to be told of changes of files, found: {error}"
            ));
        })
        .ok();
    Watching { _watcher: watcher, missing }
}
