use super::App;
use super::camera::HandCamera;
use super::messages::About;
use super::point::Pointing;
use super::session::Session;
use super::watch::Wake;
use crate::face_args::FaceChoice;
use crate::files::Files;
use anyhow::Result;
use avatar_pack::{Pack, Textures};
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
                let textures = files.load_textures();
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

/// Asks the user for a file, beside the running window.
pub(super) fn ask(window: EventLoopProxy<Wake>) {
    let endings: Vec<&str> =
        avatar_exchange::Format::ALL.iter().flat_map(|format| format.extensions()).copied().collect();
    // Made here, awaited there: some systems want dialogs to begin on the window's own thread.
    let dialog = rfd::AsyncFileDialog::new()
        .set_title("Open an avatar")
        .add_filter("Avatars", &endings)
        .add_filter("Packs (their Transformations.xml)", &["xml"])
        .pick_file();
    std::thread::spawn(move || {
        let asked = Instant::now();
        let Some(chosen) = pollster::block_on(dialog) else {
            // Nobody cancels that fast: there was no dialog.
            if asked.elapsed() < AT_ONCE {
                let _ = window.send_event(Wake::NoDialog);
            }
            return;
        };
        let path = chosen.path();
        // A pack is a folder, which this dialog shows by the file that every pack has.
        let is_pack = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("xml"));
        let path = if is_pack { path.parent().unwrap_or(path) } else { path };
        let _ = window.send_event(Wake::Chosen(path.to_owned()));
    });
}

impl App {
    /// Reads another avatar beside the running picture.
    pub(super) fn open(&mut self, path: &Path) {
        if !self.may_leave() {
            return;
        }
        self.session.loading = Some(Loading::start(path, self.proxy.clone()));
        self.presenter.redraw();
    }

    /// Takes over what was read; a broken file leaves everything as it is.
    pub(super) fn take_loaded(&mut self) {
        let Some(loading) = &mut self.session.loading else { return };
        let loaded = loading.take();
        self.presenter.redraw();
        let Some(loaded) = loaded else { return };
        let path = loading.path.clone();
        self.session.loading = None;
        match loaded.and_then(|loaded| self.show(loaded)) {
            Ok(()) => {
                self.messages.settle(About::Opening);
                self.config.opened(&path);
                self.remember();
            }
            Err(error) => {
                let title = format!("{} was not opened.", path.display());
                self.messages.error(About::Opening, title, &error);
            }
        }
    }

    fn show(&mut self, loaded: Loaded) -> Result<()> {
        let start = FaceChoice::of_values(loaded.pack.controls().defaults());
        let mut session = Session::new(loaded, start, self.proxy.clone())?;
        if let Some(stage) = &mut self.presenter.stage {
            stage.set_avatar(session.face.pack(), &session.textures, self.presenter.look)?;
        }
        // A film of the avatar before goes on.
        session.filming = self.session.filming.take();
        self.session = session;
        let follows = self.presenter.pointing.follows;
        self.presenter.pointing =
            Pointing::new(self.session.face.performer.pack(), self.proxy.clone(), follows);
        self.presenter.camera = HandCamera::START;
        self.presenter.frames.forget_miniatures();
        for about in [About::Poses, About::Clips, About::Materials, About::Hair] {
            self.messages.settle(about);
        }
        self.presenter.set_title(&self.session.title());
        Ok(())
    }
}
