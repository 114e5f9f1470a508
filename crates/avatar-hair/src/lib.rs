//! Hair of faces on the CPU.
mod density;
mod random;
mod regions;
mod roots;
pub use density::{DensityError, DensityMap};
pub use regions::{REGION_COUNT, Region, Regions};
pub use roots::{MAX_STRANDS, Root, density_area, scatter};
#[cfg(test)]
mod tests;
