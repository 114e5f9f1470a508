//! Who imports whom, from the source's own `mod`, `use` and paths.
//!
//! ```text
//! files ─▶ Modules (items, uses, paths) ─▶ Graph (file → file) ─▶ findings
//! ```
//!
//! What is compiled only for tests is left out. Three rules are checked:
//!
//! - No circle of files, but for a module and its own submodules: these may know each other, their submodules
//!   may not.
//! - No arrow against the order of rooms. A crate's rooms are the modules of its `lib.rs` (or `main.rs`), in
//!   the order in which they stand there: each may use those before it.
//! - Between crates, what ARCHITECTURE.md's table of dependencies says.

mod circles;
mod crates;
mod graph;
mod modules;
mod rooms;
mod scan;
#[cfg(test)]
mod tests;
mod use_tree;

pub use circles::circles;
pub use crates::{Crate, dependencies, read_crates};
pub use graph::{Graph, Import};
pub use modules::{Files, Modules};
pub use rooms::{order_that_fits, rooms};
