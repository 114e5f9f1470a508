use crate::files::Files;
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use winit::event_loop::EventLoopProxy;

/// What wakes the window beside its own events: this file of the pack may have changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wake {
    Materials,
    Hair,
}

/// The files whose changes are taken over while the window is open.
pub(super) const WATCHED: [(Wake, &str); 2] =
    [(Wake::Materials, "materials.toml"), (Wake::Hair, "hair.toml")];

/// Tells the window when files of the pack change that it follows. The folder is watched instead of the file: many editors put a new
/// file in the place of the old one. Where watching does not work the window works all the same, after a warning.
pub(super) fn watch(files: &Files, window: EventLoopProxy<Wake>) -> Option<RecommendedWatcher> {
    let Files::Folder(folder) = files else { return None };
    let changed = move |event: notify::Result<notify::Event>| {
        let Ok(event) = event else { return };
        // Reading a file is an event, too.
        if matches!(event.kind, EventKind::Access(_)) {
            return;
        }
        for (wake, file) in WATCHED {
            if event.paths.iter().any(|path| path.file_name().is_some_and(|name| name == file)) {
                // An error means that the window is closed.
                let _ = window.send_event(wake);
            }
        }
    };
    let watcher = notify::recommended_watcher(changed).and_then(|mut watcher| {
        watcher.watch(folder, RecursiveMode::NonRecursive)?;
        Ok(watcher)
    });
    watcher
        .inspect_err(|error| {
            eprintln!(
                "warning: {}: expected to be told of changes of {}, found: {error}",
                folder.display(),
                WATCHED.map(|(_, file)| file).join(" and ")
            );
        })
        .ok()
}
