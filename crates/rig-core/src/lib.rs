//! Joint hierarchies of rigged faces: `Transformations.xml`, bind matrices and bone matrices.
//!
//! ```text
//!  bytes ──from_xml──▶ RawRig ──Rig::from_raw──▶ Rig ──update(L)──▶ RigPose { T, X }
//!                      editable, by name         frozen, parents first
//! ```
//!
//! # Conventions
//!
//! Column vectors (`x' = M x`), right-handed, +Y up; the face looks along +Z and the character's left is +X.
//! Angles are radians and lengths are the file's own units. A matrix that is printed as
//!
//! ```text
//!         ┌ r00 r01 r02 tx ┐      columns 0..2: the axes of the frame, seen from its parent
//!     M = │ r10 r11 r12 ty │      column 3:     its origin, seen from its parent
//!         │ r20 r21 r22 tz │
//!         └  0   0   0   1 ┘      transposed="true" in the file: the text runs down the columns
//! ```
//!
//! is held as a [`glam::Affine3A`]. For a joint `J` with parent `P`:
//!
//! | here | letter | formula |
//! |---|---|---|
//! | `parent_from_joint` | `B` | from the file, rigid (see [`Rig::from_raw`]) |
//! | `local` | `L` | set at run time, identity at first |
//! | `world_from_bind` | `W` | `W_P · B`, `B` at a root |
//! | `bind_from_world` | `W⁻¹` | `[Rᵀ ∣ −Rᵀt]` |
//! | `world_from_joint` | `T` | `T_P · B · L`, `B · L` at a root |
//! | `posed_from_bind` | `X` | `T · W⁻¹`, the bone matrix that deforms vertices |
//!
//! The names follow `a_from_b`, so that neighbours cancel.
//!
//! # Example
//!
//! ```
//! use rig_core::{Axis, Elementary, Rig};
//!
//! let xml = br#"<JointSet><Joint name="NeckJoint">
//!     <Matrix>1 0 0 0  0 1 0 2  0 0 1 0  0 0 0 1</Matrix>
//! </Joint></JointSet>"#;
//! let rig = Rig::from_xml(xml)?;
//! let neck = rig.joint("NeckJoint").ok_or("no neck")?;
//! let mut locals = rig.locals();
//! locals.set_product(neck, &[Elementary::rotation(Axis::Y, 30f32.to_radians())])?;
//! let mut pose = rig.pose();
//! rig.update(locals.as_slice(), &mut pose)?;
//! assert!((pose.world_from_joint()[neck.index()].translation.y - 2.0).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! This crate knows no time, no blend shapes, no files and no GPU.

mod error;
mod raw;
mod xml;
mod rig;
mod elementary;
mod pose;
mod crowd;

pub use crowd::{BoneLanes, MotionLanes, RigCrowd};
pub use elementary::{Axis, Elementary, product};
pub use error::{CrowdError, LengthMismatch, Place, RigError, UnknownJoint, XmlError, XmlProblem};
pub use pose::{Locals, RigPose};
pub use raw::{MatrixLayout, RawJoint, RawRig};
pub use rig::{JointId, RIGID_TOLERANCE, Rig, TRANSLATION_LIMIT};
pub use xml::{MAX_DEPTH, MAX_NAME_BYTES};
