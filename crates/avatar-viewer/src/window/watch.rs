use crate::files::Files;
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use winit::event_loop::EventLoopProxy;

/// What wakes the window beside its own events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wake {
    /// `materials.toml` of the pack may have changed.
    Materials,
}

/// The file whose changes are taken over while the window is open.
const WATCHED: &str = "materials.toml";

/// Tells the window when the pack's materials change. The folder is watched instead of the file: many editors put a new
/// file in the place of the old one. Where watching does not work the window works all the same, after a warning.
pub(super) fn watch(files: &Files, window: EventLoopProxy<Wake>) -> Option<RecommendedWatcher> {
    let Files::Folder(folder) = files else { return None };
    let changed = move |event: notify::Result<notify::Event>| {
        let Ok(event) = event else { return };
        let names = |path: &std::path::PathBuf| path.file_name().is_some_and(|name| name == WATCHED);
        // Reading the file is an event, too.
        if !matches!(event.kind, EventKind::Access(_)) && event.paths.iter().any(names) {
            // An error means that the window is closed.
            let _ = window.send_event(Wake::Materials);
        }
    };
    let watcher = notify::recommended_watcher(changed).and_then(|mut watcher| {
        watcher.watch(folder, RecursiveMode::NonRecursive)?;
        Ok(watcher)
    });
    watcher
        .inspect_err(|error| {
            eprintln!(
                "warning: {}: expected to be told of changes of {WATCHED}, found: {error}",
                folder.display()
            );
        })
        .ok()
}
