//! Avatars as callers have them: a model, states of it, and what is drawn, read back.

pub(crate) mod model;
pub(crate) mod read_back;
pub(crate) mod state;
