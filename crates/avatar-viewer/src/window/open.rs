//! Another avatar takes the place of the one that is shown.

use super::App;
use super::camera::HandCamera;
use super::loading::{Loaded, Loading};
use super::messages::About;
use super::pointing::Pointing;
use super::session::Session;
use crate::face_args::FaceChoice;
use anyhow::Result;
use std::path::Path;

impl App {
    /// Reads another avatar beside the running picture.
    pub(super) fn open(&mut self, path: &Path) {
        if !self.may_leave() {
            return;
        }
        self.session.loading = Some(Loading::start(path, self.proxy.clone()));
        self.presenter.redraw();
    }

    /// Shows the avatar that was read. If its file is broken, the one before stays.
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
