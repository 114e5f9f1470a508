//! VRM 1.0 and 0.x: avatars in GLB that say which node is which bone, what expressions are made of, and how
//! eyes look.
//!
//! ```text
//!  bytes ──gltf──▶ scene ◀── mtoon / mtoon_v0: materials as cartoons
//!        └─JSON──▶ v1 / v0 ──▶ Vrm { meta, humanoid, expressions, look_at, first_person, springs,
//!                                    constraints }
//!
//!  values of expressions ──expression_weights──▶ weights of shapes at nodes
//!  head, target ──LookAt::gaze──▶ angles ──eyes──▶ turns of eye bones
//!                                        └─expressions──▶ values of expressions
//! ```
//!
//! Names are those of VRM 1.0: older ones are translated. Angles are in degrees, as in the files.

mod place;
mod meta;
mod expression;
mod first_person;
mod descent;
mod spring;
mod spring_v0;
mod constraint;
mod mtoon;
mod mtoon_v0;
mod v0;
mod v1;

use crate::gltf;
use crate::scene::{Finding, ImportError, Node, Note, RawScene, Resolve, Scene, Transform, Trs};
use glam::Quat;
use place::Place;
use serde_json::Value;

pub use crate::look_at::{EyeTurn, Gaze, LookAt, LookAtKind, RangeMap};
pub use avatar_mesh::expressions::Override;
pub use constraint::{ConstraintKind, NodeConstraint};
pub use expression::{ShapeWeights, expression_weights};
pub use first_person::{FirstPerson, FirstPersonView};
pub use meta::Meta;
pub use spring::{ColliderGroup, ColliderShape, SpringChain, SpringCollider, SpringJoint, Springs};

/// A scene, and what it means as an avatar.
#[derive(Clone, Debug, PartialEq)]
pub struct VrmModel {
    /// The scene; avatars of version 0.x are turned to look along +Z by a root above all nodes.
    pub scene: Scene,
    /// Bones, expressions and eyes.
    pub vrm: Vrm,
}

/// What a VRM file says beside its scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vrm {
    /// Which generation of the format the file is of.
    pub version: Version,
    /// Who made it, and what may be done with it.
    pub meta: Meta,
    /// Names of bones and their nodes, in the file's order: `head`, `leftEye`, `leftThumbMetacarpal` …
    pub humanoid: Vec<(String, usize)>,
    /// Expressions, in the file's order.
    pub expressions: Vec<Expression>,
    /// How the eyes look at things.
    pub look_at: Option<LookAt>,
    /// What is seen through the avatar's own eyes.
    pub first_person: FirstPerson,
    /// What swings.
    pub springs: Springs,
    /// Nodes that turn with others, in the order of the nodes that turn.
    pub constraints: Vec<NodeConstraint>,
}

/// A generation of VRM.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Version {
    /// 0.x, whose avatars look along −Z in their files.
    V0,
    /// 1.0.
    #[default]
    V1,
}

/// An expression of the face: shapes with their weights, and how it changes other expressions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Expression {
    /// Unique name; of presets the one of VRM 1.0: `happy`, `blinkLeft`, `aa` …
    pub name: String,
    /// Whether it is one of those that the standard lists.
    pub is_preset: bool,
    /// Whether values above 0.5 count as 1 and others as 0.
    pub is_binary: bool,
    /// How it changes `blink`, `blinkLeft` and `blinkRight`.
    pub override_blink: Override,
    /// How it changes `lookUp`, `lookDown`, `lookLeft` and `lookRight`.
    pub override_look_at: Override,
    /// How it changes `aa`, `ih`, `ou`, `ee` and `oh`.
    pub override_mouth: Override,
    /// Shapes that make it.
    pub binds: Vec<MorphBind>,
}

/// A shape that takes part in an expression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MorphBind {
    /// The node whose weights are meant.
    pub node: usize,
    /// Which of its shapes.
    pub shape: usize,
    /// Its weight at the expression's value 1.
    pub weight: f32,
}

impl Vrm {
    /// The node of a bone.
    pub fn bone(&self, name: &str) -> Option<usize> {
        self.humanoid.iter().find(|(bone, _)| bone == name).map(|(_, node)| *node)
    }

    /// The expression of this name.
    pub fn expression(&self, name: &str) -> Option<&Expression> {
        self.expressions.iter().find(|expression| expression.name == name)
    }
}

/// Bones that the standard asks for.
const REQUIRED_BONES: [&str; 15] = [
    "hips",
    "spine",
    "head",
    "leftUpperLeg",
    "leftLowerLeg",
    "leftFoot",
    "rightUpperLeg",
    "rightLowerLeg",
    "rightFoot",
    "leftUpperArm",
    "leftLowerArm",
    "leftHand",
    "rightUpperArm",
    "rightLowerArm",
    "rightHand",
];

/// The extensions of VRM 1.0.
const REPRESENTED: [&str; 6] = [
    "VRMC_vrm",
    "VRMC_springBone",
    constraint::EXTENSION,
    mtoon::EXTENSION,
    spring::EXTENDED,
    mtoon::EMISSION,
];

/// Reads a VRM. `file` is its name for messages.
///
/// Bones that the standard asks for and the file lacks, colours and textures that expressions change, and
/// curves of looking are told in the scene's notes.
///
/// # Errors
/// As [`gltf::read()`], and data of VRM that is missing or not as the standard says, with its place in the
/// JSON.
pub fn read(file: &str, bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<VrmModel, ImportError> {
    let in_file = |error: ImportError| error.in_file(file);
    let (mut raw, extras) = gltf::read_with_extras(bytes, mtoon::SHADE_TEXTURE, resolve).map_err(in_file)?;
    let vrm = read_vrm(&mut raw, extras).map_err(in_file)?;
    let scene = Scene::from_raw(raw).map_err(in_file)?;
    Ok(VrmModel { scene, vrm })
}

fn read_vrm(raw: &mut RawScene, extras: gltf::Extras) -> Result<Vrm, ImportError> {
    let extensions = Value::Object(extras.extensions);
    let extensions = Place::new(&extensions, "extensions");
    let extension = |name: &str| extensions.get(name);
    // A file may carry both, for older programs.
    let (vrm, represented) = match (extension("VRMC_vrm")?, extension("VRM")?) {
        (Some(vrm), _) => {
            let mut vrm = v1::read(&vrm, raw)?;
            let springs = extension("VRMC_springBone")?.map(|place| spring::read(&place, raw)).transpose()?;
            vrm.springs = springs.unwrap_or_default();
            vrm.constraints = constraint::read(&extras.nodes, raw)?;
            mtoon::read(&extras.materials, &extras.textures, &extras.further_textures, raw)?;
            (vrm, &REPRESENTED[..])
        }
        (None, Some(vrm)) => (v0::read(&vrm, &extras.nodes_of_meshes, &extras.textures, raw)?, &["VRM"][..]),
        (None, None) => {
            return Err(ImportError::new("extensions", "VRMC_vrm (VRM 1.0) or VRM (0.x)", "neither"));
        }
    };
    raw.notes.retain(|note| match &note.finding {
        Finding::Extension(name) => !represented.contains(&name.as_str()),
        _ => true,
    });
    for bone in REQUIRED_BONES.iter().filter(|bone| vrm.bone(bone).is_none()) {
        note(raw, "humanoid", Finding::Missing(format!("lacks the bone {bone}")));
    }
    if vrm.version == Version::V0 {
        turn(raw);
    }
    Ok(vrm)
}

fn note(raw: &mut RawScene, place: impl Into<String>, finding: Finding) {
    raw.notes.push(Note::new(place, finding));
}

/// Turns everything by half a turn around the vertical. The new root comes last, so that no position changes.
fn turn(raw: &mut RawScene) {
    let root = raw.nodes.len();
    raw.nodes.iter_mut().filter(|node| node.parent.is_none()).for_each(|node| node.parent = Some(root));
    // Half a turn exactly, which the sine of a rounded π is not.
    let local = Transform::Trs(Trs { rotation: Quat::from_xyzw(0.0, 1.0, 0.0, 0.0), ..Trs::default() });
    raw.nodes.push(Node { name: "VRM 0.x".to_owned(), parent: None, local, weights: Vec::new() });
    note(raw, "VRM", Finding::converted("looks along -Z: it is turned around by a root node"));
}
