use super::RawError;
use crate::{Pack, PaletteBone};
use avatar_mesh::FACE_BONES;
use glam::{DAffine3, DMat3, DMat4, Mat4};
use pose_anim::{Drive, JointMotion, face};
use rig_core::{RawJoint, RawRig, Rig};

/// The joints of the format that controls of the nine-joint face stand for.
const BY_CONTROL: [(&str, &str); 8] = [
    (face::HEAD_TURN, "HeadJoint"),
    (face::JAW_OPEN, "JawJoint"),
    (face::EYE_LEFT_LR, "LtEyeJoint"),
    (face::EYE_RIGHT_LR, "RtEyeJoint"),
    (face::LID_LEFT_UPPER, "LtUpperLidJoint"),
    (face::LID_RIGHT_UPPER, "RtUpperLidJoint"),
    (face::LID_LEFT_LOWER, "LtLowerLidJoint"),
    (face::LID_RIGHT_LOWER, "RtLowerLidJoint"),
];

/// Bones whose matrix at rest is this near to the identity, as a share of the avatar's size, leave vertices
/// where they are.
const ROUNDING: f64 = 1e-6;

/// How far axes of a driven joint may be from even ones.
const UNEVEN: f64 = 1e-4;

/// An avatar's joints as those of the format.
pub(super) struct Bones {
    pub(super) rig: RawRig,
    /// Per joint of the pack its name in the files.
    pub(super) names: Vec<String>,
    /// Per bone of the palette its place in [`FACE_BONES`].
    pub(super) places: Vec<Option<usize>>,
    /// Per joint of the pack the one that its part follows instead.
    pub(super) instead: Vec<Option<usize>>,
    /// Per bone of the palette `world_from_mesh` at rest; `None` where that is the identity.
    pub(super) rest: Vec<Option<DAffine3>>,
}

impl Bones {
    pub(super) fn of(pack: &Pack, notes: &mut Vec<String>) -> Result<Self, RawError> {
        let mut instead = vec![None; pack.rig().len()];
        let joints = assigned(pack, &mut instead)?;
        let mut names = pack.rig().names().to_vec();
        for (place, joint) in joints.iter().enumerate() {
            let Some(name) = joint.and_then(|joint| names.get_mut(joint)) else { continue };
            if name != FACE_BONES[place] {
                notes.push(format!("joint {name:?} is called {:?}", FACE_BONES[place]));
                FACE_BONES[place].clone_into(name);
            }
        }
        let places = |bone: &PaletteBone| {
            let joint = bone.joint.index();
            let followed = instead.get(joint).copied().flatten().unwrap_or(joint);
            joints.iter().position(|other| *other == Some(followed))
        };
        for (followed, name) in instead.iter().zip(pack.rig().names()) {
            let Some(followed) = followed.and_then(|followed: usize| names.get(followed)) else { continue };
            notes.push(format!("joint {name:?} does not turn by itself: its part follows {followed:?}"));
        }
        let rig = rig(pack, &names, &joints, &instead)?;
        let places = pack.palette().iter().map(places).collect();
        Ok(Self { rig, places, instead, rest: rest(pack), names })
    }
}

/// Per joint of the pack whether a whole part follows it, and whether a vertex does among others.
fn used_joints(pack: &Pack) -> (Vec<bool>, Vec<bool>) {
    let (mut by_parts, mut by_vertices) = (vec![false; pack.rig().len()], vec![false; pack.rig().len()]);
    let mark = |used: &mut Vec<bool>, bone: usize| {
        let joint = pack.palette().get(bone).map(|bone| bone.joint.index());
        if let Some(used) = joint.and_then(|joint| used.get_mut(joint)) {
            *used = true;
        }
    };
    for part in pack.parts().iter().filter(|part| !part.mesh.positions.is_empty()) {
        match (&part.bone, &part.mesh.skinning) {
            (Some(bone), _) => mark(&mut by_parts, *bone),
            (None, Some(skinning)) => {
                let used = skinning.used_bones();
                used.into_iter().for_each(|bone| mark(&mut by_vertices, usize::from(bone)));
            }
            (None, None) => {}
        }
    }
    (by_parts, by_vertices)
}

/// Which joint of the pack each joint of the format is. `instead` gets the known joint above each joint that
/// only holds a part.
fn assigned(
    pack: &Pack,
    instead: &mut [Option<usize>],
) -> Result<[Option<usize>; FACE_BONES.len()], RawError> {
    let (by_parts, by_vertices) = used_joints(pack);
    let mut joints = FACE_BONES.map(|name| pack.rig().joint(name).map(|joint| joint.index()));
    let place_of = |name: &str| FACE_BONES.iter().position(|other| *other == name);
    for (control, name) in BY_CONTROL {
        let driven = pack.controls().index(control).and_then(|index| pack.controls().controls().get(index));
        let Some(Drive::Joint { joint, .. }) = driven.map(|control| &control.drives) else { continue };
        let joint = pack.rig().joint(joint).map(|joint| joint.index());
        if let Some(place) = place_of(name).filter(|place| joints[*place].is_none())
            && !joints.contains(&joint)
        {
            joints[place] = joint;
        }
    }
    let parent =
        |joint: usize| pack.rig().parents().get(joint).copied().flatten().map(|parent| parent.index());
    if let (Some(neck), Some(head)) =
        (place_of("NeckJoint"), place_of("HeadJoint").and_then(|head| joints[head]))
    {
        let above = parent(head).filter(|above| by_vertices[*above] && !joints.contains(&Some(*above)));
        joints[neck] = joints[neck].or(above);
    }
    let is_left = |joint: &usize| !joints.contains(&Some(*joint));
    for joint in (0..by_parts.len()).filter(|joint| by_parts[*joint] && !by_vertices[*joint]).filter(is_left)
    {
        let mut above = std::iter::successors(parent(joint), |joint| parent(*joint));
        instead[joint] = above.find(|above| joints.contains(&Some(*above)));
    }
    let used = |joint: &usize| (by_parts[*joint] || by_vertices[*joint]) && instead[*joint].is_none();
    let used: Vec<usize> = (0..by_parts.len()).filter(used).collect();
    let left: Vec<usize> = used.iter().copied().filter(is_left).collect();
    if left.len() > joints.iter().filter(|joint| joint.is_none()).count() {
        let name = |joint: &usize| pack.rig().names()[*joint].clone();
        return Err(RawError::TooManyJoints { found: used.iter().map(name).collect() });
    }
    let free = joints.iter_mut().filter(|joint| joint.is_none());
    free.zip(left).for_each(|(place, joint)| *place = Some(joint));
    Ok(joints)
}

/// The joints with their new names, and those that were missing, where their parents are.
fn rig(
    pack: &Pack,
    names: &[String],
    joints: &[Option<usize>],
    instead: &[Option<usize>],
) -> Result<RawRig, RawError> {
    let parents = || {
        let parent = |parent: &Option<rig_core::JointId>| parent.and_then(|parent| names.get(parent.index()));
        pack.rig().parents().iter().map(move |of| parent(of).map(String::as_str))
    };
    let raw = |matrices: Vec<Mat4>| {
        let joint =
            |((name, parent), matrix): ((&String, Option<&str>), Mat4)| RawJoint::new(name, parent, matrix);
        RawRig { joints: names.iter().zip(parents()).zip(matrices).map(joint).collect() }
    };
    let own = raw(pack.rig().parent_from_joint().iter().map(|matrix| Mat4::from(*matrix)).collect());
    // To the last bit the same: a rig of this format.
    let is_rigid = Rig::from_raw(&own).is_ok_and(|rig| rig.bind_from_world() == pack.rig().bind_from_world());
    let mut rig = own;
    if !is_rigid {
        rig = raw(rigid(pack)?);
        let kept = kept(pack, joints, instead);
        let mut kept = kept.iter();
        rig.joints.retain(|_| kept.next() == Some(&true));
    }
    for (place, _) in joints.iter().enumerate().filter(|(_, joint)| joint.is_none()) {
        let parent = match place {
            0 => None,
            1 => Some(FACE_BONES[0]),
            _ => Some(FACE_BONES[1]),
        };
        rig.joints.push(RawJoint::new(FACE_BONES[place], parent, Mat4::IDENTITY));
    }
    Ok(rig)
}

/// Per joint of the pack whether it takes a place, turns, or has one below it that does: nodes that only hold
/// meshes are no joints where vertices are in world space.
fn kept(pack: &Pack, joints: &[Option<usize>], instead: &[Option<usize>]) -> Vec<bool> {
    let mut kept = vec![false; pack.rig().len()];
    let driven = pack.controls().controls().iter().filter_map(|control| match &control.drives {
        Drive::Joint { joint, .. } => pack.rig().joint(joint).map(|joint| joint.index()),
        Drive::Shape { .. } => None,
    });
    let driven = driven.filter(|joint| instead[*joint].is_none());
    for joint in joints.iter().copied().flatten().chain(driven) {
        kept[joint] = true;
    }
    // No joint precedes its parent.
    for (joint, parent) in pack.rig().parents().iter().enumerate().rev() {
        if let Some(parent) = parent.filter(|_| kept[joint]) {
            kept[parent.index()] = true;
        }
    }
    kept
}

/// `parent_from_joint` of frames at the places of the joints that have their turns but no scale. A turn of a
/// joint whose scale is the same along all axes does to the world what it does in such a frame.
fn rigid(pack: &Pack) -> Result<Vec<Mat4>, RawError> {
    let mut frames: Vec<DAffine3> = Vec::with_capacity(pack.rig().len());
    for matrix in pack.rig().world_from_bind() {
        let affine = widen(matrix);
        let (_, rotation, translation) = affine.to_scale_rotation_translation();
        let rotation = if rotation.is_finite() { rotation.normalize() } else { glam::DQuat::IDENTITY };
        frames.push(DAffine3::from_rotation_translation(rotation, translation));
    }
    for control in pack.controls().controls() {
        let Drive::Joint { joint, kind, .. } = &control.drives else { continue };
        let Some(id) = pack.rig().joint(joint) else { continue };
        let axes = widen(&pack.rig().world_from_bind()[id.index()]).matrix3;
        let scale = axes.determinant().cbrt();
        let even =
            (axes.transpose() * axes).abs_diff_eq(DMat3::IDENTITY * (scale * scale), UNEVEN * scale * scale);
        let moves_alike = *kind == JointMotion::Rotation || (scale - 1.0).abs() <= UNEVEN;
        if !(scale > 0.0 && even && moves_alike) {
            return Err(RawError::Uneven { joint: joint.clone() });
        }
    }
    let local = |(frame, parent): (&DAffine3, &Option<rig_core::JointId>)| {
        let parent = parent.and_then(|parent| frames.get(parent.index()));
        let parent_from_joint = parent.map_or(*frame, |parent| parent.inverse() * *frame);
        DMat4::from(parent_from_joint).as_mat4()
    };
    Ok(frames.iter().zip(pack.rig().parents()).map(local).collect())
}

fn rest(pack: &Pack) -> Vec<Option<DAffine3>> {
    let size = pack.bounds().map_or(1.0, |bounds| f64::from((bounds.max - bounds.min).max_element()));
    let matrix = |bone: &PaletteBone| {
        let world_from_joint = pack.rig().world_from_bind().get(bone.joint.index())?;
        let rest = widen(world_from_joint) * widen(&bone.joint_from_mesh);
        let is_still = rest.matrix3.abs_diff_eq(DMat3::IDENTITY, ROUNDING)
            && rest.translation.abs().max_element() <= ROUNDING * size;
        let is_own = pack.rig().bind_from_world().get(bone.joint.index()) == Some(&bone.joint_from_mesh);
        (!is_still && !is_own).then_some(rest)
    };
    pack.palette().iter().map(matrix).collect()
}

fn widen(affine: &glam::Affine3A) -> DAffine3 {
    DAffine3::from_cols_array(&affine.to_cols_array().map(f64::from))
}
