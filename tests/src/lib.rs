//! Checks of the workspace itself: who imports whom (`scripts/imports`), and how files are laid out
//! (`scripts/check-style`). Both read the source as text; nothing is compiled for them.

pub mod tokens;

pub mod imports;
pub mod style;
