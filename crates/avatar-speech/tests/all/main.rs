//! Tests of the crate from outside.

mod formats;
mod hostile;
mod motion;
mod with_expressions;
