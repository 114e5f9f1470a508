use crate::look_rule::{EXPRESSION, LookRule};
use crate::{FaceState, Pack};
use avatar_exchange::look_at::{Gaze as Angles, LookAt, LookAtKind};
use glam::{DAffine3, Vec3};
use pose_anim::face;

/// The values of the controls of the eyes for a gaze as the head sees it, through the file's ranges:
/// `eye.left.lr` and so on, in degrees. For look-at by bones; for that by expressions there is
/// [`LookAt::expressions`].
pub fn gaze_values(look_at: &LookAt, gaze: Angles) -> [(&'static str, f32); 4] {
    let turn = look_at.eyes(gaze);
    [
        (face::EYE_LEFT_UD, -turn.left.pitch_deg),
        (face::EYE_LEFT_LR, turn.left.yaw_deg),
        (face::EYE_RIGHT_UD, -turn.right.pitch_deg),
        (face::EYE_RIGHT_LR, turn.right.yaw_deg),
    ]
}

/// Follows a rule with the controls of a pack.
#[derive(Clone, Copy, Debug)]
pub(super) struct Follower {
    rule: LookRule,
    /// Controls with their ranges, in the order of the rule's values.
    controls: [Option<(usize, f32, f32)>; 4],
}

impl Follower {
    /// Nothing where the pack has no rule, or no control that one could move.
    pub(super) fn of(pack: &Pack) -> Option<Self> {
        let rule = *pack.look_rule()?;
        let names = match rule.look_at.kind {
            LookAtKind::Bone => {
                gaze_values(&rule.look_at, Angles::default()).map(|(name, _)| name.to_owned())
            }
            LookAtKind::Expression => {
                let values = rule.look_at.expressions(Angles::default());
                values.map(|(name, _)| format!("{EXPRESSION}{name}"))
            }
        };
        let controls = names.map(|name| {
            let index = pack.controls().index(&name)?;
            let control = pack.controls().controls().get(index)?;
            Some((index, control.min, control.max))
        });
        controls.iter().any(Option::is_some).then_some(Self { rule, controls })
    }

    /// The joint of the head, by its index.
    pub(super) fn head(&self) -> usize {
        self.rule.head.index()
    }

    /// The place between the eyes at bind pose, in world space.
    pub(super) fn origin(&self, pack: &Pack) -> Option<Vec3> {
        let world_from_head = pack.rig().world_from_bind().get(self.rule.head.index())?;
        Some(world_from_head.transform_point3(self.rule.look_at.offset_from_head))
    }

    /// Controls and their values for a target in world space, with the head where the state has it.
    pub(super) fn look_at(&self, pack: &Pack, state: &FaceState, target: Vec3, out: &mut Vec<(usize, f32)>) {
        let LookRule { look_at, head } = &self.rule;
        let at_rest = pack.rig().world_from_bind().get(head.index());
        let now = state.rig_pose().world_from_joint().get(head.index());
        let (Some(at_rest), Some(now)) = (at_rest, now) else { return };
        let wide =
            |affine: &glam::Affine3A| DAffine3::from_cols_array(&affine.to_cols_array().map(f64::from));
        let gaze = look_at.gaze(&wide(at_rest), &wide(now), target.as_dvec3());
        let values = match look_at.kind {
            LookAtKind::Bone => gaze_values(look_at, gaze).map(|(_, value)| value),
            LookAtKind::Expression => look_at.expressions(gaze).map(|(_, value)| value),
        };
        let both = self.controls.iter().zip(values);
        out.extend(both.filter_map(|(control, value)| {
            let (index, min, max) = (*control)?;
            Some((index, value.max(min).min(max)))
        }));
    }

    /// The controls that it moves.
    pub(super) fn controls(&self) -> impl Iterator<Item = usize> + use<> {
        self.controls.into_iter().flatten().map(|(index, ..)| index)
    }
}
