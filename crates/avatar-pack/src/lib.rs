//! Avatar packs: rig, meshes, textures, controls and poses from a set of named byte strings.
//!
//! ```text
//!  Source ──▶ Pack  { rig, parts, palette, controls, poses, clips, materials, hair } geometry and motion
//!         └─▶ Textures { skin, eyes, teeth … }                    pictures, missing ones with a warning
//!
//!  Pack + Textures + Hair ──Pack::groom──▶ Groom: the hair, planted
//!  Pack + control values ──FaceState──▶ bone matrices + blend weights ──▶ avatar-render, or avatar_mesh::deform
//!  Pack + control values + target ──Gaze──▶ values of eyes and head that look at it
//!  Pack ──Reach──▶ which vertices a control moves, which controls move a vertex; Pack::hit: which vertex a ray hits
//! ```
//!
//! A pack in the raw format is a folder with `Transformations.xml` (or `Transformationen.xml`), a vertex and an index
//! buffer for each of the seven [parts](avatar_mesh::FACE_PARTS), textures, and optionally `controls.toml`,
//! `poses.toml`, `clips.toml`, `materials.toml` and `hair.toml`. This crate opens no files itself: a [`Source`] does, be it a folder, an archive, a web server or
//! bytes in the program.
//!
//! ```
//! use avatar_pack::{Pack, Source, SourceError};
//!
//! struct Nothing;
//! impl Source for Nothing {
//!     fn read(&self, _name: &str) -> Result<Option<std::borrow::Cow<'_, [u8]>>, SourceError> {
//!         Ok(None)
//!     }
//! }
//! let error = Pack::load(&Nothing).expect_err("there is no rig");
//! assert!(error.to_string().starts_with("Transformations.xml: expected the file"));
//! ```

mod source;
pub mod files;
mod sliders;
mod motion;
mod pack;
mod load;
mod textures;
mod face;
pub mod gaze;
mod reach;
mod pick;
mod hair;
mod import;
mod export;
mod raw;
mod unique;
mod error;

pub use error::{ContentsError, PackError, PackProblem, Warning};
pub use export::{export, portable_pictures};
pub use face::{FaceError, FaceState};
pub use gaze::Gaze;
#[cfg(feature = "vrm")]
pub use import::gaze_values;
pub use import::{Import, ImportFailure, ImportReport, Role, ShapeSet, leave_helpers_out};
pub use load::{load_clips, load_hair, load_materials, load_poses};
pub use motion::{MotionAt, MotionError, MotionSampler, SceneMotion};
pub use pack::{Pack, PackContents, PaletteBone, Part};
pub use pick::Hit;
pub use raw::{RawError, RawFiles, raw_files};
pub use reach::Reach;
pub use sliders::Sliders;
pub use source::{MemorySource, Source, SourceError};
pub use textures::{PartImages, Texture, Textures};
