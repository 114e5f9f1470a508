//! How time passes for a face, and for what hangs on it.

use super::{Performer, PerformerError};
use avatar_life::Life;
use avatar_pack::{FaceError, FaceState, Pack};

impl Performer {
    /// Lets time pass, and poses the face. Joints that swing by themselves
    /// ([`Springs`](avatar_pack::Springs)) follow; where nothing swings, that costs nothing.
    ///
    /// # Errors
    /// A time step that is negative or NaN, or longer than a day for a face that lives; then nothing changes.
    pub fn advance(&mut self, dt_secs: f64) -> Result<(), PerformerError> {
        self.pass(dt_secs)?;
        self.pose()
    }

    /// Lets time pass without posing the face, which is left to [`Self::pose_with`].
    ///
    /// # Errors
    /// As [`Self::advance`].
    pub fn pass(&mut self, dt_secs: f64) -> Result<(), PerformerError> {
        let mut left = dt_secs;
        // A step that life refuses is refused before anything has changed.
        while self.life.is_none() || left <= Life::LONGEST_SECS {
            let Some((secs, event)) = self.talk.next_event(left) else { break };
            if let Some(life) = &mut self.life {
                life.advance(secs)?;
            }
            self.tell_life(event);
            left = (left - secs).max(0.0);
        }
        if let Some(life) = &mut self.life {
            life.advance(left)?;
        }
        self.layers.advance(dt_secs)?;
        self.talk.pass(left);
        self.waiting_secs += dt_secs;
        self.show()
    }

    /// Poses the face in another way than by its values alone, until the next [`Self::advance`]: `pose` gets
    /// the pack, the values of the controls as they are shown and the state to be posed. What swings follows
    /// that pose, for all the time that has passed since the last one.
    ///
    /// # Errors
    /// What `pose` returns.
    pub fn pose_with<E: From<FaceError>>(
        &mut self,
        pose: impl FnOnce(&Pack, &[f32], &mut FaceState) -> Result<(), E>,
    ) -> Result<(), E> {
        pose(&self.pack, &self.shown, &mut self.state)?;
        Ok(self.hang()?)
    }

    /// Whether joints still swing by themselves, wherever the controls are.
    pub fn swings(&self) -> bool {
        self.state.swings()
    }

    /// Poses the face as it is shown.
    pub(super) fn pose(&mut self) -> Result<(), PerformerError> {
        self.state.pose(&self.pack, &self.shown)?;
        Ok(self.hang()?)
    }

    /// Lets what swings follow the pose, for the time that has passed since the last one. Until any has
    /// passed, and after all time, it hangs still.
    pub(super) fn hang(&mut self) -> Result<(), FaceError> {
        let secs = std::mem::take(&mut self.waiting_secs);
        self.has_moved |= secs > 0.0;
        match self.has_moved && secs.is_finite() {
            true => self.state.swing(&self.pack, secs),
            false => self.state.settle(&self.pack),
        }
    }
}
