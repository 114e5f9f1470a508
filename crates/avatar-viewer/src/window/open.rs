//! Another avatar takes the place of the one that is shown.

use super::App;
use super::camera::HandCamera;
use super::live::CALIBRATION_NOT_READ;
use super::loading::{Loaded, Loading};
use super::messages::About;
use super::pointing::Pointing;
use super::session::Session;
use super::talking::Script;
use crate::face_args::FaceChoice;
use anyhow::Result;
use std::path::Path;

impl App {
    /// Reads another avatar beside the running picture, or something to speak.
    pub(super) fn open(&mut self, path: &Path) {
        if Script::is_for(path) {
            return self.open_speech(path);
        }
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
        let before = &self.session.face;
        let (lively, lives) = (before.lively(), before.lives());
        let mut session = Session::new(loaded, start, lively, self.proxy.clone())?;
        session.face.set_life(lives);
        if let Some(stage) = &mut self.presenter.stage {
            stage.set_avatar(session.face.pack(), &session.textures, self.presenter.look)?;
        }
        // A film of the avatar before goes on.
        session.filming = self.session.filming.take();
        self.session = session;
        self.presenter.stirring.forget();
        self.hand_speech_over();
        let known = self.live.set_pack(&self.session);
        self.messages.report(About::Live, CALIBRATION_NOT_READ, known);
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
