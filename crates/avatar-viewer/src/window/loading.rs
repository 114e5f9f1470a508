use super::watch::Wake;
use crate::files::Files;
use anyhow::Result;
use avatar_pack::{Pack, Texture, Textures};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};
use winit::event_loop::EventLoopProxy;

/// A dialog that ends before this was never open.
const AT_ONCE: Duration = Duration::from_millis(400);

/// An avatar that is read beside the running picture.
pub(super) struct Loading {
    /// What is read.
    pub(super) path: PathBuf,
    /// How much of it is there already, 0 to 1.
    pub(super) fraction: f32,
    news: Receiver<News>,
}

enum News {
    Progress(f32),
    Done(Box<Result<Loaded>>),
}

/// An avatar that was read.
pub(super) struct Loaded {
    pub(super) files: Files,
    pub(super) pack: Pack,
    pub(super) textures: Textures,
}

impl Loading {
    /// Begins to read. The window is woken when there is news.
    pub(super) fn start(path: &Path, window: EventLoopProxy<Wake>) -> Self {
        let (sender, news) = channel();
        let wanted = path.to_owned();
        let tell = move |what| {
            // Whoever listened may have turned to another file.
            let _ = sender.send(what);
            let _ = window.send_event(Wake::Ready);
        };
        std::thread::spawn(move || {
            let read = || -> Result<Loaded> {
                let files = Files::open(Some(&wanted), &[])?;
                tell(News::Progress(0.4));
                let pack = files.load_pack()?;
                tell(News::Progress(0.7));
                let textures = files.load_textures(&Texture::DRAWN);
                Ok(Loaded { files, pack, textures })
            };
            tell(News::Done(Box::new(read())));
        });
        Self { path: path.to_owned(), fraction: 0.0, news }
    }

    /// The avatar, or why there is none, once that is known.
    pub(super) fn take(&mut self) -> Option<Result<Loaded>> {
        loop {
            match self.news.try_recv() {
                Ok(News::Progress(fraction)) => self.fraction = fraction,
                Ok(News::Done(result)) => return Some(*result),
                Err(TryRecvError::Empty) => return None,
                Err(TryRecvError::Disconnected) => {
                    return Some(Err(anyhow::anyhow!(
                        "{}: expected an avatar, found a file that ended its reader",
                        self.path.display()
                    )));
                }
            }
        }
    }
}

/// Asks the user for an avatar, beside the running window.
pub(super) fn ask(window: EventLoopProxy<Wake>) {
    let endings: Vec<&str> =
        avatar_exchange::Format::ALL.iter().flat_map(|format| format.extensions()).copied().collect();
    let dialog = rfd::AsyncFileDialog::new()
        .set_title("Open an avatar")
        .add_filter("Avatars", &endings)
        .add_filter("Packs (their Transformations.xml)", &["xml"]);
    wait_for(dialog, window, |path| {
        // A pack is a folder, which this dialog shows by the file that every pack has.
        let is_pack = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("xml"));
        let folder = path.parent().filter(|_| is_pack).map(Path::to_owned);
        Wake::Chosen(folder.unwrap_or(path))
    });
}

/// Asks the user for a file to speak by, beside the running window.
pub(super) fn ask_for_speech(endings: &[&str], window: EventLoopProxy<Wake>) {
    let dialog = rfd::AsyncFileDialog::new().set_title("Open something to speak");
    wait_for(
        dialog.add_filter("Recordings, and sounds with their times", endings),
        window,
        Wake::ChosenSpeech,
    );
}

/// Asks the user for a recording of a face to play, beside the running window.
pub(super) fn ask_for_recording(window: EventLoopProxy<Wake>) {
    let dialog = rfd::AsyncFileDialog::new().set_title("Play a recording");
    wait_for(dialog.add_filter("Tables of Live Link Face", &["csv"]), window, Wake::ChosenRecording);
}

/// Waits for what the user chooses, and tells the window.
fn wait_for(
    dialog: rfd::AsyncFileDialog,
    window: EventLoopProxy<Wake>,
    chosen: impl FnOnce(PathBuf) -> Wake + Send + 'static,
) {
    // Made here, awaited there: some systems want dialogs to begin on the window's own thread.
    let dialog = dialog.pick_file();
    std::thread::spawn(move || {
        let asked = Instant::now();
        match pollster::block_on(dialog) {
            Some(file) => drop(window.send_event(chosen(file.path().to_owned()))),
            // Nobody cancels that fast: there was no dialog.
            None if asked.elapsed() < AT_ONCE => drop(window.send_event(Wake::NoDialog)),
            None => {}
        }
    });
}
