//! An avatar in the raw format: the way back from [`Pack::load`].

mod joints;
mod looks;
mod merge;
mod parts;
mod shapes;

use crate::files;
use crate::{FurtherShapes, Pack, PackError, Source, SourceError, Textures};
use avatar_mesh::raw::{write_triangles, write_vertices};
use avatar_mesh::{FACE_BONES, FACE_PARTS, Shape, raw_shapes};
use pose_anim::{Clip, ClipSet, ControlError, ControlTable, Coupling, Drive, Pose, PoseSet, Track};
use rig_core::{Rig, RigError};
use std::borrow::Cow;

/// The files of a pack in the raw format.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RawFiles {
    /// Names without folder, and bytes.
    pub files: Vec<(String, Vec<u8>)>,
    /// What the avatar has and the files do not, and what has another name there.
    pub notes: Vec<String>,
}

/// What of an avatar the raw format cannot hold.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RawError {
    /// Nothing to draw.
    #[error("expected a mesh, found none")]
    NoMesh,
    /// More joints that move vertices than there are bones.
    #[error("expected at most {} joints that move vertices (the raw format has no more), found {}: {}", FACE_BONES.len(), found.len(), found.join(", "))]
    TooManyJoints {
        /// All of them.
        found: Vec<String>,
    },
    /// Shapes that are not simply moved by one number each.
    #[error("expected shapes that have a weight each (the raw format has no others), found in-between shapes of: {}", sliders.join(", "))]
    InBetween {
        /// The sliders of the avatar.
        sliders: Vec<String>,
    },
    /// A joint that turns in a space that is not scaled alike along all axes.
    #[error(
        "joint {joint:?}: expected one scale along all axes and no mirror (the raw format has rigid joints only), found another matrix"
    )]
    Uneven {
        /// The joint.
        joint: String,
    },
    /// Joints that no `Transformations.xml` can hold.
    #[error("{}: {_0}", files::RIG)]
    Rig(#[from] RigError),
    /// Controls that would contradict each other.
    #[error("{}: {_0}", files::CONTROLS)]
    Control(#[from] ControlError),
    /// A picture that PNG cannot hold.
    #[error("{file}: expected a picture that PNG can hold, found: {problem}")]
    Picture {
        /// The file.
        file: String,
        /// What is wrong with it.
        problem: String,
    },
    /// Files that would not load again, such as names that text files cannot hold.
    #[error("what would be written could not be read: {0}")]
    Load(#[from] PackError),
}

/// Makes the files of a pack in the raw format, which [`Pack::load`] takes. It touches no file itself.
///
/// * Joints that are known by their controls (`head.turn` …), and those of the format's own names, take their
///   places among the nine. A part at a node of its own below one of them follows that. Other joints that
///   move vertices take free places and their names there; joints that move no vertices stay as they are.
/// * Vertices are those at rest in world space. Bends are the avatar's own where its bind pose is its rest
///   pose.
/// * Parts of the format's own names, and parts that wholly follow jaw, head or eye, become the rigid parts;
///   everything else becomes the skin. Parts that are missing have one vertex and no triangle.
/// * Up to two shapes that are not the face's own take its free places; if there are more, all but the face's
///   own are further shapes, in `shapes.toml` and `shapes.raw`. Their controls keep their names.
/// * Pictures are PNG, looks `materials.toml`, poses `poses.toml`, clips of controls `clips.toml`.
///
/// A pack that was loaded in the raw format comes back bit for bit: joints, vertices, triangles, pixels,
/// texts' meaning.
///
/// # Errors
/// The avatar has something that moves and has no place in the format. Looks and clips of whole joints that
/// have no place are left out with a note.
pub fn raw_files(pack: &Pack, textures: &Textures) -> Result<RawFiles, RawError> {
    if pack.parts().iter().all(|part| part.mesh.positions.is_empty()) {
        return Err(RawError::NoMesh);
    }
    let mut notes = Vec::new();
    if let (Some(sliders), None) = (pack.sliders(), pack.further_shapes()) {
        return Err(RawError::InBetween { sliders: sliders.names.clone() });
    }
    let shapes = shapes::Places::of(pack);
    let bones = joints::Bones::of(pack, &mut notes)?;
    let meshes = parts::Parts::of(pack, &bones, &shapes, &mut notes);
    let (controls, kept) = controls(pack, &bones, &shapes, &mut notes)?;
    let poses = poses(pack, &controls, &kept);

    let mut files = vec![
        (files::RIG.to_owned(), bones.rig.to_xml()?.into_bytes()),
        (files::CONTROLS.to_owned(), controls.to_toml().into_bytes()),
        (files::POSES.to_owned(), poses.to_toml(&controls).into_bytes()),
        (files::MATERIALS.to_owned(), looks::materials(pack, &meshes).to_toml().into_bytes()),
    ];
    let clips = clips(pack, &kept);
    if !clips.clips.is_empty() {
        files.push((files::CLIPS.to_owned(), clips.to_toml(&controls).into_bytes()));
    }
    if let Some(hair) = pack.hair() {
        files.push((files::HAIR.to_owned(), hair.to_toml().into_bytes()));
    }
    if let Some(identity) = pack.identity() {
        files.push((files::IDENTITY.to_owned(), identity.to_toml().into_bytes()));
    }
    springs(pack, &bones, &mut files, &mut notes)?;
    further(shapes.list, &meshes.further, &mut files);
    for (spec, mesh) in FACE_PARTS.iter().zip(&meshes.meshes) {
        files.push((files::vertices(spec), write_vertices(mesh)));
        files.push((files::triangles(spec), write_triangles(mesh)));
    }
    looks::pictures(pack, textures, &meshes, &mut files, &mut notes)?;
    if let Some(motion) = pack.motion().filter(|motion| !motion.clips().is_empty()) {
        notes.push(format!("clips are left out: {}", motion.clips().join(", ")));
    }
    // Only the reader can tell whether all names, whatever their characters, can be read again.
    Pack::load(&Written(&files))?;
    Ok(RawFiles { files, notes })
}

/// What swings, where every joint is what it was.
fn springs(
    pack: &Pack,
    bones: &joints::Bones,
    files: &mut Vec<(String, Vec<u8>)>,
    notes: &mut Vec<String>,
) -> Result<(), RawError> {
    let springs = pack.springs();
    if !springs.constraints.is_empty() {
        notes.push(format!("{} joints that turn with others stay as they are", springs.constraints.len()));
    }
    if springs.springs.is_empty() {
        return Ok(());
    }
    let rig = Rig::from_raw(&bones.rig)?;
    if rig.names() == bones.names.as_slice() {
        let written = springs.moved(pack.rig(), &rig, |place| place).to_toml(rig.names());
        files.push((files::SPRINGS.to_owned(), written.into_bytes()));
    } else {
        notes.push(format!("{} joints that swing stay as they are", springs.springs.len()));
    }
    Ok(())
}

/// The further shapes, of each part those that move something of it and those that were listed for it.
fn further(mut list: FurtherShapes, of_parts: &[Vec<Shape>], files: &mut Vec<(String, Vec<u8>)>) {
    if list == FurtherShapes::default() {
        return;
    }
    let mut bytes = Vec::new();
    for (place, listed) in list.shapes.iter_mut().enumerate() {
        let of_parts = || {
            let named = FACE_PARTS.iter().zip(of_parts);
            named.filter_map(|(spec, shapes)| Some((spec.name, shapes.get(place)?)))
        };
        let moves = |shape: &Shape| {
            shape.moved_vertices() > 0 || shape.normals.as_ref().is_some_and(|n| n.moved_vertices() > 0)
        };
        for (name, _) in of_parts().filter(|(_, shape)| moves(shape)) {
            if !listed.parts.iter().any(|other| other == name) {
                listed.parts.push(name.to_owned());
            }
        }
        let written = listed.parts.iter().filter_map(|part| of_parts().find(|(name, _)| name == part));
        written.for_each(|(_, shape)| raw_shapes::write(shape, &mut bytes));
    }
    files.push((files::SHAPES.to_owned(), list.to_toml().into_bytes()));
    if !list.shapes.is_empty() {
        files.push((files::SHAPES_RAW.to_owned(), bytes));
    }
}

/// The files as they will be read, without a copy of them.
struct Written<'a>(&'a [(String, Vec<u8>)]);

impl Source for Written<'_> {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        let file = self.0.iter().find(|(other, _)| other == name);
        Ok(file.map(|(_, bytes)| Cow::Borrowed(bytes.as_slice())))
    }
}

/// The controls with the names that joints and shapes have in the files, and per control of the pack its
/// place there.
fn controls(
    pack: &Pack,
    bones: &joints::Bones,
    shapes: &shapes::Places,
    notes: &mut Vec<String>,
) -> Result<(ControlTable, Vec<Option<usize>>), RawError> {
    let (mut controls, mut kept, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
    for control in pack.controls().controls() {
        let drives = match &control.drives {
            Drive::Joint { joint, axis, kind } => {
                let turns = |joint: &usize| bones.instead.get(*joint) == Some(&None);
                let joint = pack.rig().joint(joint).map(|joint| joint.index()).filter(turns);
                let name = joint.and_then(|joint| bones.names.get(joint));
                name.map(|name| Drive::Joint { joint: name.clone(), axis: *axis, kind: *kind })
            }
            Drive::Shape { shape } => {
                shapes.driven(shape).map(|name| Drive::Shape { shape: name.to_owned() })
            }
        };
        kept.push(drives.as_ref().map(|_| controls.len()));
        match drives {
            // The pace would otherwise be that of the new names.
            Some(drives) => controls.push(pose_anim::Control { drives, ..control.clone() }),
            None => left_out.push(control.name.as_str()),
        }
    }
    if !left_out.is_empty() {
        notes.push(format!("controls that move nothing are left out: {}", left_out.join(", ")));
    }
    let place = |control: usize| kept.get(control).copied().flatten();
    let couplings = pack.controls().couplings().iter().filter_map(|coupling| {
        Some(Coupling { from: place(coupling.from)?, to: place(coupling.to)?, ..*coupling })
    });
    let couplings = couplings.collect();
    Ok((ControlTable::with_couplings(controls, couplings)?, kept))
}

/// The poses, within the ranges of their controls.
fn poses(pack: &Pack, controls: &ControlTable, kept: &[Option<usize>]) -> PoseSet {
    let place = |control: usize| kept.get(control).copied().flatten();
    let mut set = PoseSet::default();
    for pose in pack.poses().iter() {
        let mut own: Pose = pose.clone();
        own.values = (pose.values.iter())
            .filter_map(|(index, value)| {
                let index = place(*index)?;
                let control = controls.controls().get(index)?;
                Some((index, value.max(control.min).min(control.max)))
            })
            .collect();
        own.timings =
            pose.timings.iter().filter_map(|(index, timing)| Some((place(*index)?, *timing))).collect();
        set.poses.push(own);
    }
    set
}

/// The clips, of those controls that there are.
fn clips(pack: &Pack, kept: &[Option<usize>]) -> ClipSet {
    let place = |control: usize| kept.get(control).copied().flatten();
    let mut set = ClipSet::default();
    for clip in &pack.clips().clips {
        let track = |track: &Track| Track::new(place(track.control())?, track.keys().to_vec()).ok();
        // Tracks of a clip are of different controls, here as there.
        let Ok(mut own) = Clip::new(clip.name.clone(), clip.tracks().iter().filter_map(track).collect())
        else {
            continue;
        };
        (own.key, own.wrap) = (clip.key.clone(), clip.wrap);
        set.clips.push(own);
    }
    set
}
