//! What changes while the window is open beside pose and camera: files of the avatar, and the choice of hair.

use super::App;
use super::messages::About;
use super::watch::Watched;
use avatar_groom::Hair;
use avatar_pack::{load_hair, load_materials};
use std::time::Instant;

impl App {
    /// Reads files again that changed and have been left alone since.
    pub(super) fn follow(&mut self) {
        for (index, file) in Watched::ALL.into_iter().enumerate() {
            if self.reload_at[index].take_if(|at| *at <= Instant::now()).is_some() {
                match file {
                    Watched::Materials => self.reload_materials(),
                    Watched::Hair => self.reload_hair(),
                    Watched::Poses => {
                        let read = self.face.reload_poses();
                        self.reloaded(About::Poses, "The poses stay as they were.", read);
                    }
                    Watched::Clips => {
                        let read = self.face.reload_clips();
                        self.reloaded(About::Clips, "The clips stay as they were.", read);
                    }
                }
            }
        }
    }

    fn reloaded(&mut self, about: About, kept: &str, read: anyhow::Result<bool>) {
        match read {
            // A mistake that was mended by hand leaves what it was before.
            Ok(_) => self.messages.settle(about),
            Err(error) => self.messages.error(about, kept, &error),
        }
        self.redraw();
    }

    /// Takes over changed materials; with a mistake in them the old ones stay.
    fn reload_materials(&mut self) {
        match load_materials(&self.face.files) {
            Ok(materials) if materials == *self.face.pack.materials() => {
                self.messages.settle(About::Materials)
            }
            Ok(materials) => {
                self.face.pack.set_materials(materials);
                let shown = self.stage.as_mut().map_or(Ok(()), |stage| stage.set_materials(&self.face.pack));
                match shown {
                    Ok(()) => self.messages.settle(About::Materials),
                    Err(error) => {
                        self.messages.error(About::Materials, "Not all materials are shown.", &error)
                    }
                }
                self.frames.forget_miniatures();
            }
            Err(error) => {
                self.messages.error(About::Materials, "The materials stay as they were.", &error.into());
            }
        }
        self.redraw();
    }

    /// Takes over changed hair; with a mistake in its file the old one stays.
    fn reload_hair(&mut self) {
        match load_hair(&self.face.files) {
            Ok(hair) if hair.as_ref() == self.face.pack.hair() => self.messages.settle(About::Hair),
            Ok(hair) => {
                let before = self.chosen_hair();
                self.face.pack.set_hair(hair);
                self.change_hair(before);
            }
            Err(error) => self.messages.error(About::Hair, "The hair stays as it was.", &error.into()),
        }
        self.redraw();
    }

    /// Plants what is chosen now, if it is not as `before`.
    fn change_hair(&mut self, before: Option<Hair>) {
        let hair = self.chosen_hair();
        let Some(stage) = self.stage.as_mut().filter(|_| hair != before) else { return };
        match stage.set_hair(&self.face.pack, &self.face.textures, hair) {
            Ok(()) => self.messages.settle(About::Hair),
            Err(error) => self.messages.error(About::Hair, "The hair stays as it was.", &error),
        }
        self.frames.forget_miniatures();
        self.redraw();
    }

    /// The next hair, or the one before.
    pub(super) fn next_hair(&mut self, backward: bool) {
        let before = self.chosen_hair();
        self.look.hair = self.look.hair.next(self.face.pack.hair(), backward);
        self.show_title();
        self.change_hair(before);
    }

    fn chosen_hair(&self) -> Option<Hair> {
        self.look.hair.choose(self.face.pack.hair())
    }

    /// Which hair was chosen by key stands in the title: without a map of hair it is nowhere else to be seen.
    fn show_title(&self) {
        if let Some(stage) = &self.stage {
            stage.window().set_title(&format!("{} (hair: {})", self.title(), self.look.hair.name()));
        }
    }
}
