//! Motion that follows by itself: chains of joints that swing, such as hair and earrings, and joints that
//! turn with others.
//!
//! ```text
//!  animated world matrices ──Constraints::apply──▶ ──Swing::advance(dt)──▶ world matrices to draw
//! ```
//!
//! Both change a slice with the world matrix of every joint, after whatever animates the skeleton. Joints are
//! numbered so that a parent stands before its children. Matrices, units and axes are those of the caller;
//! time is in seconds. A joint swings about its origin: its tail, a point in its own space, is what the
//! spring pulls.
//!
//! # The same at every frame rate
//!
//! [`Swing`] computes springs at fixed moments, [`TICKS_PER_SEC`] of them a second, whatever the frames are;
//! where the skeleton was at these moments is found by a parabola through the last three frames. A frame
//! between two moments shows a step of a part of that length. So frames of 24 and 144 Hz differ by the
//! error of that parabola only: the README has figures, which grow with how fast the skeleton moves.
//!
//! # Example
//!
//! ```
//! use glam::{Affine3A, Vec3};
//! use joint_springs::{Law, Spring, Swing};
//!
//! // A head, and a pendant of 10 cm that hangs on it.
//! let parents = [None, Some(0)];
//! let law = Law::Oscillator { frequency_hz: 2.0, damping_ratio: 0.3, gravity: Vec3::ZERO };
//! let pendant = Spring::new(1, Vec3::new(0.0, -0.1, 0.0), law);
//! let mut swing = Swing::new(&parents, vec![pendant], vec![])?;
//! for frame in 0..30 {
//!     let head = Affine3A::from_translation(Vec3::X * (frame as f32 * 0.01));
//!     let mut world = [head, head];
//!     swing.advance(1.0 / 60.0, &mut world)?;
//! }
//! # Ok::<(), joint_springs::SpringError>(())
//! ```
//!
//! This crate knows no files, no clock, no threads and no GPU, and allocates nothing after construction.

mod error;
mod law;
mod collider;
mod input;
mod skeleton;
mod swing;
mod constraint;

pub use collider::{Collider, Shape};
pub use constraint::{Constraint, ConstraintKind, Constraints};
pub use error::SpringError;
pub use law::Law;
pub use swing::{Spring, Swing};

/// How often a second springs are computed: as often as the standard's own programs do on common displays.
/// VRM's numbers for stiffness and drag mean something at this rate only.
pub const TICKS_PER_SEC: f64 = 60.0;
