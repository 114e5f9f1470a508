//! Where hair grows on a face, and how: plain data and plain functions, without a GPU.
//!
//! ```text
//!  density texture + skin ──▶ Root per strand ─┐
//!  hair.toml ──▶ Hair { Style, seed … } ───────┼──▶ Groom ──▶ avatar-render grows and draws it every frame
//!  skin at bind pose ──▶ Field ─────────────────┘         └──▶ grow(): the same strand on the CPU
//! ```
//!
//! A root keeps its triangle, its place in it and its random numbers for good, so that it follows the
//! deformed skin exactly. Roots come in a random but fixed order: the first N are a fair sample of all, which
//! is what changing the density at run time and level of detail are. Lengths of a style are fractions of the
//! height of the skin.
//!
//! This crate knows no files, no clock and no ambient randomness: the same input gives the same roots on
//! every machine.

mod region;
mod strand;
mod style;
mod hair;

mod random;
mod pieces;
mod density;
mod regions;
mod roots;

mod pseudonormal;
mod shoulders;
mod grid;
mod creases;
mod field;
mod groom;
mod grow;
mod guides;
mod plant;
mod swing;

pub use density::DensityMap;
pub use field::{Field, Near};
pub use grid::OTHER_BONES;
pub use groom::{Groom, PlantedStrand};
pub use grow::{
    COMBED_REACH, CURL_SHARE, DEEPER, FIRST_SEGMENT, LOCK_REACH, MARGIN, STEP_SUM, Triangle, grow,
    grow_guide, offset_from_head,
};
pub use hair::Hair;
pub use placed_toml::TomlError;
pub use region::Region;
pub use roots::{MAX_ROOTS, Root, scatter};
pub use strand::{SEGMENTS, Strand};
pub use style::{RegionStyle, Style};
pub use swing::{Oscillator, TICKS_PER_SECOND, TickClock, Ticks};
