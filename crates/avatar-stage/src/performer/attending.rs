//! What a living face attends to.

use super::{Performer, PerformerError};
use avatar_life::Target;
use avatar_render::glam::Vec3;

/// A point more than 70 degrees off the way that the head faces is not attended to: that angle's cosine.
const AHEAD: f32 = 0.342;

/// Something in world space that a face attends to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attention {
    /// Where it is.
    pub point: Vec3,
    /// How often it is looked at, by the others' weights.
    pub weight: f64,
    /// Metres around it within which the eyes go to and fro: about 0.05 for somebody's face, 0 for a point.
    pub size_metres: f64,
}

impl Attention {
    /// Somebody's face, of weight 1.
    pub const fn face(point: Vec3) -> Self {
        Self { point, weight: 1.0, size_metres: 0.05 }
    }
}

impl Performer {
    /// Gives the life of the face something to attend to in one of the places 0 to 7 of its list, or takes
    /// it away ([`avatar_life::Life::attend`]): eyes and head go there as those of a living face do, with
    /// looks elsewhere between. Call it before each [`Self::advance`] while what is there moves. What is
    /// beside or behind the face is not attended to. Does nothing for a face that does not live or has no
    /// eyes that turn.
    ///
    /// # Errors
    /// Control values that do not become a face.
    pub fn attend(&mut self, place: usize, to: Option<Attention>) -> Result<(), PerformerError> {
        let Self { gaze, life, layers, pack, .. } = self;
        let (Some(gaze), Some(life)) = (gaze, life) else { return Ok(()) };
        let Some(Attention { point, weight, size_metres }) = to else {
            life.attend(place, None);
            return Ok(());
        };
        let seen = gaze.head_from_world(pack, layers.values())?.transform_point3(point);
        let is_ahead = seen.z > AHEAD * seen.length();
        let position = seen.to_array().map(f64::from);
        let target = Target { position, velocity: [0.0; 3], weight, size: size_metres };
        life.attend(place, is_ahead.then_some(target));
        Ok(())
    }
}
