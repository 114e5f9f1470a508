//! Avatars from interchange formats: a scene becomes rig, parts, shapes and controls, and a report says what
//! of it did not.

mod apart;
mod controls;
mod face;
mod known;
mod looks;
mod names;
mod parts;
mod poses;
mod rig;
mod sections;
mod shape_sets;
mod sliders;
mod spellings;
#[cfg(feature = "vrm")]
mod springs;
#[cfg(feature = "vrm")]
mod vrm;

pub use names::Role;
pub use shape_sets::ShapeSet;
pub(crate) use shape_sets::face_control;
pub(crate) use spellings::find_all as known_shapes;

use crate::look_rule::LookRule;
use crate::unique;
use crate::{
    ContentsError, FaceError, FaceState, Pack, PackContents, SceneMotion, Springs, Textures, Warning,
};
use avatar_exchange::Scene;
use avatar_look::Materials;
use avatar_mesh::drivers::DriversError;
use avatar_mesh::{Bounds, DeformError};
pub(crate) use looks::wrap_of;
use pose_anim::ControlError;
use rig_core::{JointId, RigError};
use std::fmt;

/// An avatar from a file of an interchange format.
#[derive(Clone, Debug)]
pub struct Import {
    /// Rig, parts, shapes, controls and clips.
    pub pack: Pack,
    /// The pictures of its parts.
    pub textures: Textures,
    /// What was recognised, and what could not be represented.
    pub report: ImportReport,
}

/// What became of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImportReport {
    /// Joints that are known by what they do: the control's part of the face and the name of the joint.
    pub joints: Vec<(Role, String)>,
    /// Sets of shapes that are known, with the number of those that the avatar has of each.
    pub shape_sets: Vec<(ShapeSet, usize)>,
    /// Shapes that became controls of their own names, unknown ones.
    pub other_shapes: Vec<String>,
    /// Shapes that have one name at several nodes, where these differ: the controls that they got, each by
    /// its node's name and a dot before that of the shape.
    pub apart: Vec<String>,
    /// Joints whose turns became controls of their own names.
    pub other_joints: Vec<String>,
    /// What the file says about itself: name, version, licence, authors, terms of use.
    pub about: Vec<(String, String)>,
    /// What could not be represented, or was mended.
    pub notes: Vec<String>,
}

/// Why a scene cannot become an avatar.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImportFailure {
    /// Nodes that do not form a rig.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// Controls that contradict each other.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// Parts that do not fit together, or controls that do not fit the rig.
    #[error(transparent)]
    Contents(#[from] ContentsError),
    /// Rules of shapes that cannot be followed.
    #[error(transparent)]
    Drivers(#[from] DriversError),
    /// More joints in all skins than vertices can name.
    #[error("expected at most 65536 joints in all skins, found {found}")]
    Joints {
        /// Bones of the scene.
        found: usize,
    },
    /// The rest pose could not be taken.
    #[error(transparent)]
    Face(#[from] FaceError),
    /// A part could not be deformed.
    #[error("part {part:?}: {problem}")]
    Deform {
        /// Name of the part.
        part: String,
        /// What is wrong with it.
        problem: DeformError,
    },
}

impl Import {
    /// Makes an avatar of a scene: nodes become joints, meshes parts, morph targets shapes. Joints and shapes
    /// that are known by their names get the controls of the nine-joint face; all others get controls of
    /// their own names.
    ///
    /// # Errors
    /// Nodes, controls or parts that do not fit together.
    pub fn from_scene(scene: Scene) -> Result<Self, ImportFailure> {
        Self::with_known(scene, known::Known::default())
    }

    /// As [`Import::from_scene`], where something about the scene is known.
    fn with_known(mut scene: Scene, known: known::Known) -> Result<Self, ImportFailure> {
        let mut report = ImportReport {
            notes: scene.notes.iter().map(ToString::to_string).collect(),
            ..Default::default()
        };
        if scene.parts.is_empty() {
            report.notes.push("there is no mesh: a skeleton and its motion, nothing to draw".to_owned());
        }
        note_helpers(leave_helpers_out(&mut scene), &mut report);
        note_long_names(&scene, &mut report);
        let joints = rig::Joints::of(&scene, &known.roles, &mut report)?;
        let mut shapes = parts::ShapeNames::of(&scene);
        let sliders = sliders::Wanted::of(&scene, &joints.names, &mut shapes, &known.expressions)?;
        let eyes = known.look.and_then(|(look_at, _)| controls::EyeRanges::of(&look_at));
        let controls = controls::controls(&scene, &joints, eyes, &sliders, &mut report)?;
        let (parts, textures) = parts::parts(&mut scene, &shapes, &mut report)?;
        let poses = poses::poses(&controls, &sliders.driven.known);
        let head =
            joints.roles.iter().find(|(role, _)| *role == Role::Head).map(|(_, node)| joints.of_node[*node]);
        let look_rule = known
            .look
            .and_then(|(look_at, head)| Some(LookRule { look_at, head: joints.of_node.get(head).copied()? }));
        let mut pack = Pack::new(PackContents {
            face: None,
            head: None,
            look_rule,
            palette: joints.palette,
            rig: joints.rig,
            parts,
            shapes: shapes.names,
            sliders: sliders.sliders,
            further_shapes: None,
            identity: None,
            springs: Springs::default(),
            controls,
            poses,
            clips: pose_anim::ClipSet::default(),
            materials: Materials::default(),
            hair: None,
            motion: Some(SceneMotion::new(scene, joints.of_node, joints.node_from_parent, shapes.first)),
            warnings: report.notes.iter().cloned().map(Warning::Import).collect(),
        })?;
        measure(&mut pack, head)?;
        Ok(Self { pack, textures, report })
    }
}

#[cfg(feature = "vrm")]
impl Import {
    /// Adds a note to the report and to the warnings of the pack.
    fn note(&mut self, text: String) {
        self.pack.warn(Warning::Import(text.clone()));
        self.report.notes.push(text);
    }
}

/// Leaves out of MakeHuman's base mesh the parts that only serve to fit clothes, hair and bones. Returns how
/// many these were. [`Import::from_scene`] does so by itself.
pub fn leave_helpers_out(scene: &mut Scene) -> usize {
    let parts = scene.parts.len();
    if scene.parts.iter().any(|part| part.name == "body") {
        scene.retain_parts(|part| !shape_sets::is_fitting_helper(&part.name));
    }
    parts - scene.parts.len()
}

fn note_long_names(scene: &Scene, report: &mut ImportReport) {
    let shapes = scene.parts.iter().flat_map(|part| &part.mesh.shapes).map(|shape| &shape.name);
    let names = scene.nodes.iter().map(|node| &node.name).chain(scene.parts.iter().map(|part| &part.name));
    let names = names.chain(scene.clips.iter().map(|clip| &clip.name)).chain(shapes);
    let count = names.filter(|name| name.len() > unique::LONGEST).count();
    if count > 0 {
        report.notes.push(format!("{count} names of more than {} bytes are cut", unique::LONGEST));
    }
}

fn note_helpers(left_out: usize, report: &mut ImportReport) {
    if left_out > 0 {
        report
            .notes
            .push(format!("{left_out} parts of MakeHuman's base mesh, which clothes, hair and bones are fitted to, are left out"));
    }
}

/// Boxes around the parts and the face at rest.
fn measure(pack: &mut Pack, head: Option<JointId>) -> Result<(), ImportFailure> {
    let mut state = FaceState::new(pack);
    state.pose(pack, &pack.controls().defaults())?;
    let mut face = face::Measure::new(pack, head);
    let mut bounds = Vec::with_capacity(pack.parts().len());
    for (index, part) in pack.parts().iter().enumerate() {
        let failed = |problem| ImportFailure::Deform { part: part.name.clone(), problem };
        let positions = &state.deform(pack, index).map_err(failed)?.positions;
        face.add(part, positions);
        bounds.push(Bounds::of(positions));
    }
    let whole = bounds.iter().flatten().copied().reduce(Bounds::union);
    pack.set_measures(bounds, face.finish(whole));
    Ok(())
}

impl fmt::Display for ImportReport {
    /// One line for each finding.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (what, text) in &self.about {
            writeln!(f, "{what}: {text}")?;
        }
        for (role, joint) in &self.joints {
            writeln!(f, "joint {joint:?} is the {role}")?;
        }
        for (set, count) in &self.shape_sets {
            writeln!(f, "{count} of {} shapes of {set}", set.names().len())?;
        }
        let list = |f: &mut fmt::Formatter<'_>, what: &str, names: &[String]| match names {
            [] => Ok(()),
            names => writeln!(f, "{what}: {}", names.join(", ")),
        };
        list(f, "shapes by their own names", &self.other_shapes)?;
        list(f, "shapes that each of their nodes has a control for", &self.apart)?;
        list(f, "joints by their own names", &self.other_joints)?;
        self.notes.iter().try_for_each(|note| writeln!(f, "not represented: {note}"))
    }
}
