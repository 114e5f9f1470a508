use avatar_life::LifeError;
use avatar_pack::FaceError;
use pose_anim::{AdvanceError, ClipError, JumpError, MixError};

/// Why a performer does not do what it was told. Nothing has changed then, except after [`Self::Face`], where
/// time has passed or values were set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PerformerError {
    /// No pose of this name, or a mixture that cannot be read.
    #[error(transparent)]
    Pose(#[from] MixError),
    /// No control of this name.
    #[error("expected the name of a control, found {found:?}{}", hint(.nearest))]
    UnknownControl {
        /// The name.
        found: String,
        /// The name that is probably meant.
        nearest: Option<String>,
    },
    /// No clip of this name.
    #[error("expected the name of a clip, found {found:?}{}", hint(.nearest))]
    UnknownClip {
        /// The name.
        found: String,
        /// The name that is probably meant.
        nearest: Option<String>,
    },
    /// A time to start at that is NaN or infinite.
    #[error(transparent)]
    Clip(#[from] ClipError),
    /// A time step that is negative or NaN.
    #[error(transparent)]
    Advance(#[from] AdvanceError),
    /// Another number of values than there are controls, or a value that is not finite.
    #[error(transparent)]
    Jump(#[from] JumpError),
    /// A life of an avatar with other controls, or a step that is too long for it.
    #[error(transparent)]
    Life(#[from] LifeError),
    /// Control values that do not become a face.
    #[error(transparent)]
    Face(#[from] FaceError),
}

fn hint(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!("; did you mean {name:?}?")).unwrap_or_default()
}
