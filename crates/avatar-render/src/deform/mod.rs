//! What one avatar has for itself: its pose, and the vertices that the deform pass makes of it.

pub(crate) mod crowd_chunk;
pub(crate) mod crowd_error;
pub(crate) mod crowd_pose;
pub(crate) mod deformer;
pub(crate) mod pose;
pub(crate) mod posed;
pub(crate) mod reversed;
