//! Faces of other people on the same head: axes from −1 to 1 that change its form.

mod draw;
mod field;
mod text;
mod write;

pub(crate) use draw::colors;
pub(crate) use field::{Eye, Field};

/// Axes along which a face becomes that of somebody else: what `identity.toml` says.
///
/// An axis is a field of displacement over space, linear in its value, so that axes can be mixed as one
/// likes. [`Pack::with_identity`](crate::Pack::with_identity) applies values to a pack once; what it makes is
/// a pack like any other, which costs nothing more in a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Identity {
    /// What stays a ball, and how far around it; `None` where nothing does.
    pub eyes: Option<EyeRegion>,
    /// The axes, in the order of their values.
    pub axes: Vec<Axis>,
}

/// Distances from the centre of an eye that say what moves as one with it. Within the first two, lids, edges
/// of the lids and eyeball are moved, turned and scaled alike, hence fit as they did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeRegion {
    /// Up to here skin follows its eye alone.
    pub full: f32,
    /// From here on other maps act in full.
    pub apart: f32,
    /// From here on nothing follows the eye any more.
    pub reach: f32,
}

/// One axis. Its value is from −1 to 1; at 0 it changes nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// Unique name.
    pub name: String,
    /// What the face becomes at −1, in a word.
    pub less: String,
    /// What the face becomes at 1, in a word.
    pub more: String,
    /// Standard deviation of what [`Identity::draw`] draws, beside what follows from other axes.
    pub spread: f32,
    /// How much drawn values of earlier axes, by their indices, add to the drawn value of this one.
    pub with: Vec<(usize, f32)>,
    /// Earlier axes, by their indices, that it moves, each by so much at 1.
    pub of: Vec<(usize, f32)>,
    /// What it does to both eyes.
    pub eye: EyeChange,
    /// What else it moves.
    pub maps: Vec<LocalMap>,
}

/// What an axis does to the left eye at 1, with all that belongs to it; the right eye is its mirror image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeChange {
    /// Factor about the eye's centre.
    pub size: f32,
    /// Turn about the forward axis, in degrees, that raises the outer corner. It turns the lids and their
    /// joints, not the ball's axes.
    pub tilt: f32,
    /// Displacement.
    pub shift: [f32; 3],
}

impl Default for EyeChange {
    fn default() -> Self {
        Self { size: 1.0, tilt: 0.0, shift: [0.0; 3] }
    }
}

/// A linear map about a place, which fades out at the surface of an ellipsoid. If its place is beside the
/// plane x = 0, it acts at the mirrored place too, mirrored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalMap {
    /// The place, at bind pose in world space.
    pub center: [f32; 3],
    /// The half axes of the ellipsoid, along x, y and z.
    pub radii: [f32; 3],
    /// Share of the half axes, from 0, up to which the map acts in full.
    pub full: f32,
    /// Factors about the place at 1.
    pub scale: [f32; 3],
    /// Turn about the place at 1, in degrees about x, y and z, to first order.
    pub turn: [f32; 3],
    /// Displacement at 1.
    pub shift: [f32; 3],
}

impl Default for LocalMap {
    fn default() -> Self {
        Self {
            center: [0.0; 3],
            radii: [1.0; 3],
            full: 0.0,
            scale: [1.0; 3],
            turn: [0.0; 3],
            shift: [0.0; 3],
        }
    }
}

impl Identity {
    /// The place of the axis of this name.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.axes.iter().position(|axis| axis.name == name)
    }

    /// Names of the axes, in the order of their values.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.axes.iter().map(|axis| axis.name.as_str())
    }
}
