//! What a face does by itself, over everything that it is told.

use super::{Performer, PerformerError};
use avatar_life::Life;

impl Performer {
    /// Puts life on top of everything else, and poses the face.
    pub(super) fn pose(&mut self) -> Result<(), PerformerError> {
        let Self { layers, life, shown, pack, state, .. } = self;
        match life {
            Some(life) => life.apply(layers.values(), shown)?,
            None => shown.copy_from_slice(layers.values()),
        }
        Ok(state.pose(pack, shown)?)
    }

    /// Lets the face live by itself, over all poses and clips; or be still. Made with [`Life::new`] for the
    /// controls of the pack.
    ///
    /// # Errors
    /// A life of an avatar with another number of controls; then the face goes on as it did.
    pub fn set_life(&mut self, life: Option<Life>) -> Result<(), PerformerError> {
        if let Some(life) = &life {
            life.apply(self.layers.values(), &mut self.shown)?;
        }
        self.life = life;
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

    /// Values of the controls as they are shown, with life on top.
    pub fn shown(&self) -> &[f32] {
        &self.shown
    }
}
