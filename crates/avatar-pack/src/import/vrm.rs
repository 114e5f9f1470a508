use super::controls::EyeRanges;
use super::{Import, ImportFailure, Role};
use crate::Pack;
use avatar_exchange::vrm::{Gaze, LookAt, LookAtKind, RangeMap, Vrm, VrmModel, expression_weights};
use pose_anim::{Drive, Pose, face};
use std::collections::{BTreeMap, HashMap};

impl Import {
    /// Makes an avatar of a VRM: as [`Import::from_scene`], with head, jaw and eyes by the file's own word,
    /// and a pose for each expression, which puts the shapes of all others to rest. Where the file lets eye
    /// bones look, the controls of the eyes go as far as it says ([`gaze_values`]); where it lets expressions
    /// look, these are poses as all others.
    ///
    /// # Errors
    /// As [`Import::from_scene`].
    pub fn from_vrm(model: VrmModel) -> Result<Self, ImportFailure> {
        let VrmModel { scene, vrm } = model;
        let bones = [
            (Role::Head, "head"),
            (Role::Jaw, "jaw"),
            (Role::LeftEye, "leftEye"),
            (Role::RightEye, "rightEye"),
        ];
        let known: Vec<_> =
            bones.into_iter().filter_map(|(role, bone)| Some((role, vrm.bone(bone)?))).collect();
        let turning = vrm.look_at.filter(|look_at| look_at.kind == LookAtKind::Bone);
        let mut import = Self::with_roles(scene, &known, turning.map(|look_at| eye_ranges(&look_at)))?;
        let mut control_of = HashMap::new();
        for (index, control) in import.pack.controls().controls().iter().enumerate() {
            if let Drive::Shape { shape } = &control.drives {
                control_of.entry(shape.as_str()).or_insert(index);
            }
        }
        let expressions: Vec<Pose> = (vrm.expressions.iter())
            .map(|expression| pose(&import.pack, &control_of, &vrm, &expression.name))
            .collect();
        let mut poses = import.pack.poses().clone();
        let mut places: HashMap<String, usize> =
            poses.iter().enumerate().rev().map(|(place, pose)| (pose.name.clone(), place)).collect();
        for pose in expressions {
            // The usual pose of that name keeps its place and its key.
            match places.get(&pose.name).and_then(|place| poses.poses.get_mut(*place)) {
                // An expression that moves nothing says no more than the usual face.
                Some(_) if pose.values.is_empty() => {}
                Some(other) => other.values = pose.values,
                None => {
                    places.insert(pose.name.clone(), poses.poses.len());
                    poses.poses.push(pose);
                }
            }
        }
        import.pack.set_poses(poses)?;
        Ok(import)
    }
}

/// The values of the controls of the eyes for a gaze as the head sees it, through the file's ranges:
/// `eye.left.lr` and so on, in degrees. For look-at by bones; for that by expressions there is
/// [`LookAt::expressions`].
pub fn gaze_values(look_at: &LookAt, gaze: Gaze) -> [(&'static str, f32); 4] {
    let turn = look_at.eyes(gaze);
    [
        (face::EYE_LEFT_UD, -turn.left.pitch_deg),
        (face::EYE_LEFT_LR, turn.left.yaw_deg),
        (face::EYE_RIGHT_UD, -turn.right.pitch_deg),
        (face::EYE_RIGHT_LR, turn.right.yaw_deg),
    ]
}

fn eye_ranges(look_at: &LookAt) -> EyeRanges {
    let most = |range: RangeMap| range.map(f32::MAX).max(0.0);
    EyeRanges {
        to_nose: most(look_at.horizontal_inner),
        from_nose: most(look_at.horizontal_outer),
        down: most(look_at.vertical_down),
        up: most(look_at.vertical_up),
    }
}

/// The pose of an expression. `control_of` has the controls of shapes by the shapes' names.
fn pose(pack: &Pack, control_of: &HashMap<&str, usize>, vrm: &Vrm, expression: &str) -> Pose {
    let mut values: BTreeMap<usize, f32> = BTreeMap::new();
    for ((node, shape), weight) in expression_weights(vrm, &[(expression, 1.0)]).by_shape {
        let name = pack.motion().and_then(|motion| pack.shapes().get(motion.shape(node, shape)?));
        let Some(control) = name.and_then(|name| control_of.get(name.as_str())) else { continue };
        // Shapes of one name at several nodes have one control.
        values.entry(*control).and_modify(|value| *value = weight.max(*value)).or_insert(weight);
    }
    Pose::new(expression, values.into_iter().collect())
}
