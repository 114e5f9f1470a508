//! What a face does by itself, over everything that it is told.

use super::{Performer, PerformerError};
use avatar_life::{Life, LifeError};

impl Performer {
    /// Puts speech and life on top of everything else.
    pub(super) fn show(&mut self) -> Result<(), PerformerError> {
        self.say();
        let Self { spoken, life, shown, .. } = self;
        match life {
            Some(life) => life.apply(spoken, shown)?,
            None => shown.copy_from_slice(spoken),
        }
        Ok(())
    }

    /// Lets the face live by itself, over all poses and clips; or be still. Made with [`Life::new`] for the
    /// controls of the pack.
    ///
    /// # Errors
    /// A life of an avatar with another number of controls; then the face goes on as it did.
    pub fn set_life(&mut self, life: Option<Life>) -> Result<(), PerformerError> {
        if let Some(life) = &life {
            life.apply(&self.spoken, &mut self.shown)?;
        }
        self.life = life;
        self.take_role();
        self.show()?;
        self.pose()
    }

    /// The life of the face.
    pub fn life(&self) -> Option<&Life> {
        self.life.as_ref()
    }

    /// The life of the face, to give it targets of attention, or to tell it of light.
    pub fn life_mut(&mut self) -> Option<&mut Life> {
        self.life.as_mut()
    }

    /// Lays what the face says and its life over other values of all controls than its own, one value per
    /// control in both slices.
    ///
    /// # Errors
    /// Slices of another length; then nothing is written.
    pub fn over(&self, below: &[f32], out: &mut [f32]) -> Result<(), PerformerError> {
        let check = |what, found: usize| match found == self.shown.len() {
            true => Ok(()),
            false => Err(LifeError::Length { what, expected: self.shown.len(), found }),
        };
        check("values", below.len())?;
        check("values to be written", out.len())?;
        out.copy_from_slice(below);
        self.speak_over(out);
        if let Some(life) = &self.life {
            life.apply_in_place(out)?;
        }
        Ok(())
    }

    /// Values of the controls as they are shown, with speech and life on top.
    pub fn shown(&self) -> &[f32] {
        &self.shown
    }
}
