use super::{Import, ImportFailure, Role};
use crate::Pack;
use avatar_exchange::vrm::{Vrm, VrmModel, expression_weights};
use pose_anim::{Drive, Pose};

impl Import {
    /// Makes an avatar of a VRM: as [`Import::from_scene`], with head, jaw and eyes by the file's own word, and a pose for each
    /// expression, which puts the shapes of all others to rest.
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
        let mut import = Self::with_roles(scene, &known)?;
        let poses: Vec<Pose> =
            vrm.expressions.iter().map(|expression| pose(&import.pack, &vrm, &expression.name)).collect();
        for pose in poses {
            import.pack.poses.poses.retain(|other| other.name != pose.name);
            import.pack.poses.poses.push(pose);
        }
        Ok(import)
    }
}

fn pose(pack: &Pack, vrm: &Vrm, expression: &str) -> Pose {
    let mut values = Vec::new();
    for ((node, shape), weight) in expression_weights(vrm, &[(expression, 1.0)]).by_shape {
        let name = pack.motion.as_ref().and_then(|motion| pack.shapes.get(motion.shape(node, shape)?));
        let drives =
            |drives: &Drive| matches!((drives, name), (Drive::Shape { shape }, Some(name)) if shape == name);
        let Some(control) = pack.controls.controls().iter().position(|control| drives(&control.drives))
        else {
            continue;
        };
        match values.iter_mut().find(|(other, _)| *other == control) {
            // Shapes of one name at several nodes have one control.
            Some((_, value)) => *value = weight.max(*value),
            None => values.push((control, weight)),
        }
    }
    Pose::new(expression, values)
}
