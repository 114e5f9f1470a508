//! What changes while the window is open beside pose and camera: files of the avatar, and the choice of hair.

use super::App;
use super::messages::About;
use super::watch::Watched;
use avatar_groom::Hair;
use avatar_pack::{load_hair, load_materials};

impl App {
    /// Reads files again that changed and have been left alone since.
    pub(super) fn follow(&mut self) {
        while let Some(file) = self.session.settled() {
            match file {
                Watched::Materials => self.reload_materials(),
                Watched::Hair => self.reload_hair(),
                Watched::Poses => {
                    let read = self.session.reload_poses();
                    self.messages.report(About::Poses, "The poses stay as they were.", read);
                }
                Watched::Clips => {
                    let read = self.session.reload_clips();
                    self.messages.report(About::Clips, "The clips stay as they were.", read);
                }
            }
            self.presenter.redraw();
        }
    }

    /// Takes over changed materials; with a mistake in them the old ones stay.
    fn reload_materials(&mut self) {
        let face = &mut self.session.face;
        match load_materials(&self.session.files) {
            Ok(materials) if materials == *face.pack().materials() => self.messages.settle(About::Materials),
            Ok(materials) => {
                face.performer.set_materials(materials);
                let stage = self.presenter.stage.as_mut();
                let shown = stage.map_or(Ok(()), |stage| stage.set_materials(face.pack()));
                self.messages.report(About::Materials, "Not all materials are shown.", shown);
                self.presenter.frames.forget_miniatures();
            }
            Err(error) => {
                self.messages.error(About::Materials, "The materials stay as they were.", &error.into());
            }
        }
    }

    /// Takes over changed hair; with a mistake in its file the old one stays.
    fn reload_hair(&mut self) {
        match load_hair(&self.session.files) {
            Ok(hair) if hair.as_ref() == self.session.face.pack().hair() => {
                self.messages.settle(About::Hair);
            }
            Ok(hair) => {
                let before = self.presenter.hair(&self.session);
                self.session.face.performer.set_hair(hair);
                self.change_hair(before);
            }
            Err(error) => self.messages.error(About::Hair, "The hair stays as it was.", &error.into()),
        }
    }

    /// Plants the chosen hair, if it differs from `before`.
    fn change_hair(&mut self, before: Option<Hair>) {
        let hair = self.presenter.hair(&self.session);
        let Some(stage) = self.presenter.stage.as_mut().filter(|_| hair != before) else { return };
        let done = stage.set_hair(self.session.face.pack(), &self.session.textures, hair);
        self.messages.report(About::Hair, "The hair stays as it was.", done);
        self.presenter.frames.forget_miniatures();
        self.presenter.redraw();
    }

    /// The next hair, or the one before.
    pub(super) fn next_hair(&mut self, backward: bool) {
        let before = self.presenter.hair(&self.session);
        let look = &mut self.presenter.look;
        look.hair = look.hair.next(self.session.face.pack().hair(), backward);
        // Without a map of hair, the title is the only place where the choice is seen.
        let title = format!("{} (hair: {})", self.session.title(), self.presenter.look.hair.name());
        self.presenter.set_title(&title);
        self.change_hair(before);
    }
}
