//! One face, many names for what it does: the spaces of trackers and avatars, maps between any two of them,
//! and what such a map loses.
//!
//! ```text
//!  Standard ──space──▶ Space: names, meanings, ranges, sides, aliases
//!           └─Route::between(a, b)─▶ Route: Maps one after the other ──apply──▶ values in the other space
//!
//!  Loss::of(there, back) ──▶ which names are kept, changed or lost on the way there and back
//!  Solver { displacement fields, ranges } ──solve──▶ values where no map is written, by least squares
//!  Calibration (face.toml) ──apply──▶ a tracker's values less those of its person's resting face
//!  Retarget { what each control of an avatar means } ──apply──▶ a tracker's values as that avatar's controls
//! ```
//!
//! A space's names and a map's rules are TOML in this crate (`assets/`); programs can read their own.
//! Left and right are always the character's. Values are clamped to the ranges of both spaces; one that is
//! no number counts as rest.
//!
//! ```
//! use face_space::{Route, Standard};
//!
//! let arkit = Standard::ArKit.space();
//! let mut face = arkit.rest();
//! face[arkit.find("EyeBlink_L").unwrap_or(0)] = 1.0;
//!
//! let mut route = Route::between(Standard::ArKit, Standard::Vrm1).ok_or("no way")?;
//! let mut expressions = Standard::Vrm1.space().rest();
//! route.apply(&face, &mut expressions);
//! assert_eq!(Standard::Vrm1.space().index("blinkLeft").map(|at| expressions[at]), Some(1.0));
//! # Ok::<(), &str>(())
//! ```
//!
//! This crate knows no files, no clock and no meshes. [`Route::apply`], [`Solver::solve`],
//! [`Calibration::apply`] and [`Retarget::apply`] allocate nothing.

mod plain;
mod space;
mod map;
mod standard;
mod route;
mod loss;
mod solve;
mod calibration;
mod retarget;

pub use calibration::Calibration;
pub use loss::{Fate, Loss, VertexError};
pub use map::{Map, Rule, Term};
pub use placed_toml::TomlError;
pub use plain::plain;
pub use retarget::{Control, Retarget, meaning};
pub use route::Route;
pub use solve::{SolveError, Solver, least_squares};
pub use space::{Name, Side, Space};
pub use standard::Standard;
