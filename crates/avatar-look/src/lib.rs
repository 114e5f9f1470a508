//! How faces look: materials, lights and environments as plain data, and the optics behind them as plain
//! functions.
//!
//! ```text
//!  materials.toml ──▶ Materials ──▶ Material per part ─┐
//!  preset ──▶ Light { lamps, Environment, ToneMap } ───┼──▶ avatar-render
//!  Environment ──▶ irradiance, blurred reflections ────┤
//!  tables: split sum, scattering ──────────────────────┘
//! ```
//!
//! Colours are linear, directions are in the world (right-handed, +Y up, the face looks along +Z). Radiance
//! is measured by what a white matte surface makes of it: a lamp of radiance 1 lights one that faces it to 1,
//! and so does an environment that is 1 everywhere. Lengths of materials are fractions of the height of the
//! skin, so that they fit packs in any unit.
//!
//! This crate knows no GPU, no files and no clock.

mod standard;
mod material;
mod materials;
mod colors;
mod wrinkle;

mod environment;
mod light;

pub mod optics;
mod split_sum;
mod irradiance;
mod reflections;
mod scatter;
pub mod tone;

pub use colors::{Colors, linear_from_hex};
pub use environment::{Environment, PANEL_CORE, PANEL_COUNT, Panel};
pub use irradiance::irradiance_at;
pub use light::{Lamp, Light, LightPreset, ToneMap};
pub use material::{Iris, Material, Tone};
pub use materials::Materials;
/// Why a text about looks could not be read, and where.
pub use placed_toml::TomlError as LookError;
pub use reflections::{CUBE_FACES, cube_direction};
pub use scatter::scatter_table;
pub use split_sum::{directional_albedo, split_sum};
pub use standard::{Alpha, Cartoon, Lighting, SOLID, SecondUvs, Standard, Wrap, Wraps};
pub use wrinkle::Wrinkle;
