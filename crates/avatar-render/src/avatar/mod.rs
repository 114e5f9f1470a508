//! The public types of avatars: a model, its states, and reading back what is drawn.

pub(crate) mod crowd;
pub(crate) mod model;
pub(crate) mod read_back;
pub(crate) mod state;
