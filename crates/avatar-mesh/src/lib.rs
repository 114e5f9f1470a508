//! Meshes of rigged faces: parts, blend shapes and their mathematics, raw buffers, deformation on the CPU,
//! OBJ.
//!
//! ```text
//!  VB, IB bytes ──raw──▶ Mesh { points, shapes, skinning } ──deform──▶ positions, normals ──obj──▶ text
//! ```
//!
//! Spaces and units are those of the crate `rig-core`: column vectors, right-handed, +Y up, the face looks
//! along +Z, the character's left is +X. Texture coordinates have their origin at the top left corner of the
//! image and v grows downward. Triangles run counter-clockwise seen from outside.
//!
//! With `b` the blend weights, `d`, `dn` a shape's offsets, `X` the bone matrices and `w` a vertex's bone
//! weights, up to eight of them:
//!
//! ```text
//!  v_blend = v + Σ_k b_k · d_k         v_out = Σ_i w_i · X_{bone_i} · v_blend
//!  n_blend = n + Σ_k b_k · dn_k        n_out = normalize( Σ_i w_i · mat3(X_{bone_i}) · n_blend )
//! ```
//!
//! Where one of a mesh's bones scales unevenly, shears or mirrors, normals are turned by the inverse
//! transpose of `Σ_i w_i · mat3(X_{bone_i})` instead, so that they stay normals. Tangents, where a mesh has
//! them, follow the matrix itself. [`deform()`] is the reference that the GPU's results are held against;
//! [`deformed_triangles`] reverses what bones mirror.
//!
//! ```
//! use avatar_mesh::{deform, raw};
//! use glam::{Affine3A, Vec3};
//!
//! // One vertex of a rigid part: position, uv, normal.
//! let vertex = [1.0f32, 2.0, 3.0, 0.5, 0.5, 0.0, 0.0, 1.0];
//! let vertex: Vec<u8> = vertex.iter().flat_map(|x| x.to_le_bytes()).collect();
//! let mesh = raw::read_rigid(&vertex, &[])?;
//! let lifted = Affine3A::from_translation(Vec3::Y);
//! let mut posed = mesh.deformed();
//! deform(&mesh, &[lifted], &[], &mut posed)?;
//! assert_eq!(posed.positions, [Vec3::new(1.0, 3.0, 3.0)]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Blend shapes
//!
//! ```text
//!  drivers ──ShapeDrivers──▶ weights ──normalise, clamp──▶ weights ──deform──▶ mesh
//!  points of a ShapeSpace ────┘ │
//!  keys of a Sequence ──────────┘
//! ```
//!
//! - A [`Shape`] stores moved vertices only, where that is smaller ([`Offsets`]); [`raw_shapes`] reads and
//!   writes these as bytes. Shapes without offsets for
//!   normals leave them alone; [`ShapeNormals`] is the choice, [`SmoothNormals`] recomputes them.
//! - [`weights`]: relative and absolute forms, normalised weights. All functions on weights work with any
//!   renderer.
//! - [`drivers`]: in-between shapes, and combinations that count as the product of others.
//! - [`expressions`]: expressions that add shapes up and hold each other back, as those of VRM.
//! - [`sequence`]: geometries as keys in time, with any transition function.
//! - [`space`]: weights as points along named axes, and their mixtures.
//! - [`coherence`]: whether geometries of several files have the same vertices in the same order.
//! - [`Simplifier`]: fewer triangles for faces that are small in the picture, with all shapes and weights.
//! - [`DeformBounds`]: boxes around what [`deform()`] makes, from the bones and weights alone.
//!
//! ```
//! use avatar_mesh::{Mesh, Shape, ShapeNormals, blend, weights};
//! use glam::Vec3;
//!
//! let mut mesh = Mesh { positions: vec![Vec3::ZERO; 2], normals: vec![Vec3::Z; 2], ..Mesh::default() };
//! mesh.shapes.push(Shape::from_absolute("wide", &mesh.positions, &[Vec3::X * 4.0, Vec3::ZERO])?);
//! mesh.shapes.push(Shape::from_pairs("high", 2, [(0, Vec3::Y * 2.0)])?);
//! // Both at full weight average.
//! let mut both = [1.0, 1.0];
//! weights::normalise(&mut both);
//! let mut blended = mesh.deformed();
//! blend(&mesh, &both, ShapeNormals::Given, &mut blended)?;
//! assert_eq!(blended.positions, [Vec3::new(2.0, 1.0, 0.0), Vec3::ZERO]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! This crate knows no files, no clock and no GPU, and what runs every frame allocates nothing.

mod bounds;
mod offsets;
mod shape;
mod skinning;
mod mesh;
mod parts;
mod validate;
pub mod raw;
pub mod raw_shapes;
mod weld;
mod winding;
mod simplify;

pub mod weights;
mod smooth;
mod turning;
mod skin_lanes;
mod deform;
mod deform_bounds;

pub mod drivers;
pub mod expressions;
pub mod space;
pub mod sequence;
pub mod coherence;
pub mod obj;

pub use bounds::Bounds;
pub use deform::{DeformError, ShapeNormals, blend, deform, deform_with};
pub use deform_bounds::{BoneBounds, DeformBounds};
pub use mesh::{Deformed, Mesh};
pub use offsets::{Offsets, OffsetsError};
pub use parts::{FACE_BONES, FACE_PARTS, FACE_SHAPES, Follows, PartKind, PartSpec};
pub use shape::Shape;
pub use simplify::{Simplified, Simplifier};
pub use skinning::Skinning;
pub use smooth::SmoothNormals;
pub use turning::{MIN_NORMAL_LENGTH, deformed_triangles, mirrors, normal_matrix, turns_evenly};
pub use validate::{MeshError, MeshWarning, WEIGHT_SUM_LIMIT, WEIGHT_SUM_TOLERANCE};
pub use weld::{Welded, weld, weld_positions, weld_repeated};
pub use winding::Winding;
