//! Avatar packs: rig, meshes, textures, controls and poses from a set of named byte strings.
//!
//! ```text
//!  Source ──▶ Pack { rig, parts, palette, controls, poses, clips, materials, hair }: geometry and motion
//!         └─▶ Textures { skin, eyes, teeth … }: pictures; missing ones give a warning
//!
//!  Pack + Textures + Hair ──Pack::groom──▶ Groom: the hair, planted
//!  Pack + control values ──FaceState──▶ bone matrices + blend weights ──▶ avatar-render, avatar_mesh::deform
//!  Pack + time ──FaceState::swing──▶ bone matrices of what hangs and swings ([`Springs`])
//!  Pack + control values + target ──Gaze──▶ values of eyes and head that look at the target
//!  Pack ──Reach──▶ which vertices a control moves, and which controls move a vertex
//!  Pack + ray ──Pack::hit──▶ the vertex that the ray hits first
//! ```
//!
//! # From a control to a vertex
//!
//! Five lists are counted by index. Each arrow says what leads from one to the next:
//!
//! ```text
//!  control 3 "jaw.open", in degrees           Pack::controls: what people, poses and clips set
//!      │ Coupling: adds a share of one control to another, so an open jaw pulls the mouth's corners
//!      ▼
//!  effective control values                   FaceState::effective, one per control
//!      │ Binding: what the control drives
//!      ├──▶ joint "JawJoint"                  Pack::rig ──palette──▶ bone matrices, FaceState::bones
//!      ▼
//!  slider 7 "smile"                           Pack::sliders; packs without have one for each shape
//!      │ ShapeDrivers: in-between shapes, products of sliders (here sliders are called drivers)
//!      │ Expressions: of VRM; each is a slider, adds to several shapes, and may hold others back
//!      ▼
//!  shape 12 "smile 50 %"                      Pack::shapes: one weight each, FaceState::weights
//!      │ Part::shapes: which range of the shapes is that part's own
//!      ▼
//!  vertices of the parts                      avatar_mesh::deform, or avatar-render on the GPU
//! ```
//!
//! - Values of **controls** have ranges and defaults; several controls may drive one joint.
//! - **Sliders** and shapes may share names: a control drives all of its name at once.
//! - In a pack in the raw format without further shapes a control drives shapes directly.
//!
//! # Files
//!
//! A pack in the raw format is a folder with `Transformations.xml` (or `Transformationen.xml`), a vertex and
//! an index buffer for each of the seven [parts](avatar_mesh::FACE_PARTS), textures, and optionally
//! `controls.toml`, `shapes.toml` with `shapes.raw` ([`FurtherShapes`]), `poses.toml`, `clips.toml`,
//! `identity.toml` ([`Identity`]), `springs.toml` ([`Springs`]), `materials.toml` and `hair.toml`. This
//! crate opens no files itself: a [`Source`] does, be it a folder, an archive, a web server or bytes in the
//! program.
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
mod shapes;
mod identity;
mod springs;
mod look_rule;
mod unique;
mod motion;
mod error;
mod pack;
mod load;
mod person;
mod textures;
mod pictures;
mod face;
mod crowd;
pub mod gaze;
mod reach;
mod levels;
mod pick;
mod hair;
mod wrinkles;
mod import;
mod retarget;
mod export;
mod raw;

pub use crowd::FaceCrowd;
pub use error::{ContentsError, PackError, PackProblem, Warning};
pub use export::{ExportTarget, export, export_targets, portable_pictures};
pub use face::{FaceError, FaceState};
pub use gaze::{Gaze, gaze_values};
pub use identity::{Axis, EyeChange, EyeRegion, Identity, LocalMap};
pub use import::{Import, ImportFailure, ImportReport, Role, ShapeSet, leave_helpers_out};
pub use joint_springs;
pub use levels::Level;
pub use load::{load_clips, load_hair, load_materials, load_poses, load_springs};
pub use look_rule::LookRule;
pub use motion::{MotionAt, MotionError, MotionSampler, SceneMotion};
pub use pack::{Pack, PackContents, PaletteBone, Part};
pub use person::IdentityError;
pub use pick::Hit;
pub use raw::{RawError, RawFiles, raw_files};
pub use reach::Reach;
pub use retarget::retarget;
pub use shapes::{FurtherShape, FurtherShapes, Mixture, ShapeWeight, Side, WrinklePlace};
pub use sliders::{ControlSlider, Expressions, Sliders};
pub use source::{MemorySource, Source, SourceError};
pub use springs::Springs;
pub use textures::{PartImages, Texture, Textures};
