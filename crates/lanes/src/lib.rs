//! Numbers of several faces side by side, computed by the widest vectors of the processor.
//!
//! A [`Lanes`] holds one number of each of [`LANES`] faces. A [`Work`] is a computation with them that is
//! compiled for every kind of vectors and run by [`run`] for the widest that the processor has. In it, a
//! [`Wide`] is as many numbers of a [`Lanes`] as one vector holds; [`steps`] of them make the whole.
//!
//! Only sums, products, quotients, square roots and comparisons are offered, each rounded by itself as in
//! scalar code, so results are the same bits on every processor.
//!
//! ```
//! use lanes::{Lanes, Simd, Wide, Work};
//!
//! struct Twice<'a>(&'a mut Lanes);
//!
//! impl Work for Twice<'_> {
//!     type Output = ();
//!
//!     #[inline(always)]
//!     fn with_simd<S: Simd>(self, simd: S) {
//!         for step in 0..lanes::steps::<S>() {
//!             let number = Wide::load(simd, self.0, step);
//!             (number + number).store(self.0, step);
//!         }
//!     }
//! }
//!
//! let mut numbers = Lanes::splat(1.5);
//! lanes::run(Twice(&mut numbers));
//! assert_eq!(numbers, Lanes::splat(3.0));
//! ```

mod wide;

pub use pulp::{Simd, WithSimd as Work};
pub use wide::{Wide, Wide64, steps, steps64};

use std::ops::{Deref, DerefMut};

/// How many faces stand side by side: as many numbers of 32 bits as the widest vectors of present processors
/// hold. Narrower vectors take them in several steps.
pub const LANES: usize = 16;

/// One number of each of [`LANES`] faces.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes<T = f32>(pub [T; LANES]);

impl<T: Copy> Lanes<T> {
    /// The same number in every lane.
    pub const fn splat(value: T) -> Self {
        Self([value; LANES])
    }
}

impl<T> Deref for Lanes<T> {
    type Target = [T; LANES];

    #[inline(always)]
    fn deref(&self) -> &[T; LANES] {
        &self.0
    }
}

impl<T> DerefMut for Lanes<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T; LANES] {
        &mut self.0
    }
}

/// Runs a computation by the widest vectors that the processor has, as found at run time. What it calls
/// must be marked `#[inline(always)]` to be compiled for them.
#[inline]
pub fn run<W: Work>(work: W) -> W::Output {
    pulp::Arch::new().dispatch(work)
}
