//! What a crowd refuses.

use crate::deform::pose::StateError;

/// Why a crowd could not be made or set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CrowdError {
    /// More avatars than the device binds.
    #[error("expected at most {limit} avatars of this model, found {found}")]
    TooMany {
        /// The number.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
    /// The crowd has no such avatar.
    #[error("expected an avatar below {avatars}, found {found}")]
    NoSuchAvatar {
        /// Number of avatars.
        avatars: usize,
        /// The avatar.
        found: usize,
    },
    /// The model is not the one that the crowd was made of.
    #[error("expected the model of this crowd, found another one")]
    OtherModel,
    /// A bone makes a left hand of a right one: a crowd shares its triangles, so that their fronts would be
    /// inside. An [`AvatarState`](crate::AvatarState) can have such bones.
    #[error("expected bones that do not mirror, found that bone {bone} does")]
    Mirrored {
        /// Position in the palette.
        bone: usize,
    },
    /// Bones or weights that do not fit the model.
    #[error(transparent)]
    State(#[from] StateError),
}
