//! What changes while the window is open beside pose and camera: files of the pack, and the choice of hair.

use super::App;
use avatar_groom::Hair;
use avatar_pack::{load_hair, load_materials};

impl App {
    /// Takes over changed materials; with a mistake in them the old ones stay.
    pub(super) fn reload_materials(&mut self) {
        match load_materials(&self.files) {
            Ok(materials) if materials == self.pack.materials => {}
            Ok(materials) => {
                self.pack.materials = materials;
                let shown = self.stage.as_ref().map_or(Ok(()), |stage| stage.set_materials(&self.pack));
                if let Err(error) = shown {
                    eprintln!("error: {error:#}: not all materials are shown");
                }
                self.redraw();
            }
            Err(error) => eprintln!("error: {error}: the materials stay as they were"),
        }
    }

    /// Takes over changed hair; with a mistake in its file the old one stays.
    pub(super) fn reload_hair(&mut self) {
        match load_hair(&self.files) {
            Ok(hair) if hair == self.pack.hair => {}
            Ok(hair) => {
                let before = self.chosen_hair();
                self.pack.hair = hair;
                self.change_hair(before);
            }
            Err(error) => eprintln!("error: {error}: the hair stays as it was"),
        }
    }

    /// Plants what is chosen now, if it is not as `before`.
    fn change_hair(&mut self, before: Option<Hair>) {
        let hair = self.chosen_hair();
        let Some(stage) = self.stage.as_mut().filter(|_| hair != before) else { return };
        if let Err(error) = stage.set_hair(&self.pack, &self.textures, hair) {
            eprintln!("error: {error:#}: the hair stays as it was");
        }
        self.redraw();
    }

    /// The next hair, or the one before.
    pub(super) fn next_hair(&mut self, backward: bool) {
        let before = self.chosen_hair();
        self.look.hair = self.look.hair.next(self.pack.hair.as_ref(), backward);
        self.show_title();
        self.change_hair(before);
    }

    fn chosen_hair(&self) -> Option<Hair> {
        self.look.hair.choose(self.pack.hair.as_ref())
    }

    /// Which hair was chosen by key stands in the title: without a map of hair it is nowhere else to be seen.
    fn show_title(&self) {
        if let Some(stage) = &self.stage {
            stage.window().set_title(&format!("{} (hair: {})", self.title, self.look.hair.name()));
        }
    }
}
