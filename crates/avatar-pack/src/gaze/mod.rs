//! Where eyes look: control values that turn the eyes, and the head after them, to a point.
//!
//! ```text
//!  values + target ──look_at──────▶ controls of the eyes: both meet at the target
//!                  └─face_toward──▶ head.turn, head.bow: the face turns by a share of the way
//! ```
//!
//! Nothing is assumed about axes and signs of controls: what looks along +Z at bind pose is turned by its
//! joint's bone matrix `X`, and the values are found by steps that try out what each control does.

mod rule;
mod solve;

use crate::{FaceError, FaceState, Pack};
use glam::{Affine3A, Vec3};
use pose_anim::{Control, Drive, JointMotion, face};
use rule::Follower;
use solve::Unknown;

pub use rule::gaze_values;

/// Directions further from straight ahead say nothing about the side.
const WIDEST_RAD: f32 = 0.95 * std::f32::consts::PI;

/// Finds the values of controls that make a face look at a point. Made once for a pack; afterwards nothing
/// allocates.
///
/// The results depend on the values and the target only, not on where the eyes were before: a viewer may
/// smooth them as it likes.
#[derive(Clone, Debug)]
pub struct Gaze {
    state: FaceState,
    /// Control values that are tried out.
    values: Vec<f32>,
    eyes: Vec<Turned>,
    head: Option<Turned>,
    /// Where the file says how eyes look.
    rule: Option<Follower>,
}

/// What one or two controls turn.
#[derive(Clone, Copy, Debug)]
struct Turned {
    controls: [Option<usize>; 2],
    unknowns: [Unknown; 2],
    /// Index of the joint that is turned by both.
    joint: usize,
    /// At bind pose, in world space: the eye's centre, or the middle between the eyes.
    origin: Vec3,
    /// How far the controls can turn away from straight ahead.
    reach_rad: f32,
}

/// A line of sight in world space; the direction is a unit vector.
#[derive(Clone, Copy, Debug)]
struct Sight {
    origin: Vec3,
    direction: Vec3,
}

impl Gaze {
    /// The eyes of this pack, by the names of their controls (`eye.left.ud`, `eye.left.lr` and those of the
    /// right eye), and its head (`head.turn`, `head.bow`). Some of them may be missing; `None` where no
    /// control turns an eye's joint and the file has no expressions that look.
    pub fn new(pack: &Pack) -> Option<Self> {
        let mut eyes: Vec<Turned> = face::EYES.iter().filter_map(|names| Turned::of(pack, *names)).collect();
        let middle = eyes.iter().map(|eye| eye.origin).sum::<Vec3>() / eyes.len().max(1) as f32;
        let rule = Follower::of(pack);
        let middle = rule.and_then(|rule| rule.origin(pack)).unwrap_or(middle);
        let mut head = Turned::of(pack, face::FACING).map(|head| Turned { origin: middle, ..head });
        let (mut state, mut values) = (FaceState::new(pack), pack.controls().defaults());
        for turned in eyes.iter_mut().chain(&mut head) {
            turned.reach_rad = turned.reach(pack, &mut state, &mut values).ok()?;
        }
        (!eyes.is_empty() || rule.is_some()).then_some(Self { state, values, eyes, head, rule })
    }

    /// Whether eyes follow a rule of the file ([`Pack::look_rule`]): then they find the same values each
    /// time, to the last bit.
    pub fn follows_rule(&self) -> bool {
        self.rule.is_some()
    }

    /// The controls that look: those of the eyes, and of the head.
    pub fn controls(&self) -> impl Iterator<Item = usize> {
        let turned = self.eyes.iter().chain(&self.head).flat_map(|turned| turned.controls).flatten();
        turned.chain(self.rule.iter().flat_map(Follower::controls))
    }

    /// Values of the eyes' controls, as pairs of control and value, at which each eye looks at `target` (in
    /// world space) while all other controls are as in `values`. `out` is cleared first; it stays empty for a
    /// target that is not finite.
    ///
    /// Where the target is out of an eye's reach, the eye turns toward it as far as it can: along the way
    /// from straight ahead to the target, and then to the nearest direction within the ranges. Behind the
    /// eyes both take the direction from the middle between them, so that they do not part or cross.
    ///
    /// Where the pack has a [`Pack::look_rule`], the values are those of the rule instead, which need not
    /// meet the target.
    ///
    /// # Errors
    /// As [`FaceState::pose`].
    pub fn look_at(
        &mut self,
        pack: &Pack,
        values: &[f32],
        target: Vec3,
        out: &mut Vec<(usize, f32)>,
    ) -> Result<(), FaceError> {
        out.clear();
        let Self { state, values: tried, eyes, rule, .. } = self;
        take(tried, values)?;
        if !target.is_finite() {
            return Ok(());
        }
        if let Some(rule) = rule {
            state.pose(pack, tried)?;
            rule.look_at(pack, state, target, out);
            return Ok(());
        }
        eyes.iter().for_each(|eye| eye.put(tried, eye.unknowns.map(|unknown| unknown.start)));
        state.pose(pack, tried)?;
        let count = eyes.len().max(1) as f32;
        let sights = || eyes.iter().map(|eye| eye.sight(state));
        let middle = sights().map(|sight| sight.origin).sum::<Vec3>() / count;
        let ahead = sights().map(|sight| sight.direction).sum::<Vec3>();
        let is_behind = ahead.dot(target - middle) <= 0.0;
        for eye in eyes.iter() {
            state.pose(pack, tried)?;
            let rest = eye.sight(state);
            let from = if is_behind { middle } else { rest.origin };
            let Some(wanted) = (target - from).try_normalize() else { continue };
            let aim = eye.within_reach(rest.direction, wanted, 1.0);
            let found = solve::least(eye.unknowns, |at| {
                eye.put(tried, at);
                state.pose(pack, tried)?;
                Ok::<_, FaceError>(turn(eye.sight(state).direction, aim))
            })?;
            eye.put(tried, found);
            eye.report(found, out);
        }
        Ok(())
    }

    /// Values of `head.turn` and `head.bow`, as pairs of control and value, at which the face has gone
    /// `share` of the way from straight ahead, where both are at their defaults, to facing `target` (in world
    /// space), while all other controls are as in `values`. `out` is cleared first; it stays empty for a
    /// target that is not finite and for a face without these controls.
    ///
    /// The face looks from the middle between the eyes, which moves as the head turns. The eyes are to be
    /// found afterwards, with the values of the head that is shown.
    ///
    /// # Errors
    /// As [`FaceState::pose`].
    pub fn face_toward(
        &mut self,
        pack: &Pack,
        values: &[f32],
        target: Vec3,
        share: f32,
        out: &mut Vec<(usize, f32)>,
    ) -> Result<(), FaceError> {
        out.clear();
        let Self { state, values: tried, head, .. } = self;
        take(tried, values)?;
        let Some(head) = head.filter(|_| target.is_finite() && share.is_finite()) else { return Ok(()) };
        head.put(tried, head.unknowns.map(|unknown| unknown.start));
        state.pose(pack, tried)?;
        let rest = head.sight(state).direction;
        let found = solve::least(head.unknowns, |at| {
            head.put(tried, at);
            state.pose(pack, tried)?;
            let sight = head.sight(state);
            let wanted = (target - sight.origin).try_normalize().unwrap_or(rest);
            Ok::<_, FaceError>(turn(sight.direction, head.within_reach(rest, wanted, share)))
        })?;
        head.report(found, out);
        Ok(())
    }
}

/// Metres between the pupils of adults, by which a world without units is measured.
const PUPILS_APART_METRES: f32 = 0.063;

impl Gaze {
    /// The way from world space to where the head sees things with these values: metres from the middle
    /// between the eyes, to the character's left, up, and ahead. Worlds of avatars are in any unit: the
    /// pupils are taken to be 63 mm apart; where no joint turns an eye, the unit is the metre.
    ///
    /// # Errors
    /// As [`FaceState::pose`].
    pub fn head_from_world(&mut self, pack: &Pack, values: &[f32]) -> Result<Affine3A, FaceError> {
        let Self { state, values: tried, eyes, head, rule } = self;
        take(tried, values)?;
        state.pose(pack, tried)?;
        let apart = match eyes.as_slice() {
            [one, other, ..] => one.origin.distance(other.origin),
            _ => 0.0,
        };
        let metres = if apart > 1e-6 { PUPILS_APART_METRES / apart } else { 1.0 };
        let rest = Affine3A::IDENTITY;
        let joint = head.map(|head| head.joint).or(rule.as_ref().map(Follower::head));
        let bones = state.rig_pose().posed_from_bind();
        let posed_from_bind = joint.and_then(|joint| bones.get(joint)).copied().unwrap_or(rest);
        let at_bind = eyes.iter().map(|eye| eye.origin).sum::<Vec3>() / eyes.len().max(1) as f32;
        let at_bind = rule.as_ref().and_then(|rule| rule.origin(pack)).unwrap_or(at_bind);
        let middle = posed_from_bind.transform_point3(at_bind);
        let (_, turned, _) = posed_from_bind.to_scale_rotation_translation();
        let turned_back = Affine3A::from_quat(turned.inverse());
        Ok(Affine3A::from_scale(Vec3::splat(metres)) * turned_back * Affine3A::from_translation(-middle))
    }
}

impl Turned {
    fn of(pack: &Pack, names: [&str; 2]) -> Option<Self> {
        let table = pack.controls().controls();
        let turning = |name: &str| {
            let control = pack.controls().index(name)?;
            match &table.get(control)?.drives {
                Drive::Joint { joint, kind: JointMotion::Rotation, .. } => {
                    Some((control, pack.rig().joint(joint)?.index()))
                }
                _ => None,
            }
        };
        let found = names.map(turning);
        // Parents come first: where each control has a joint of its own, the last one is turned by both.
        let joint = found.iter().flatten().map(|(_, joint)| *joint).max()?;
        let controls = found.map(|found| found.map(|(control, _)| control));
        let unknown = |control: usize| {
            let Control { min, max, default, .. } = table.get(control)?;
            Some(Unknown { min: *min, max: *max, start: *default })
        };
        let unknowns = controls.map(|control| control.and_then(unknown).unwrap_or_default());
        let origin = pack.rig().world_from_bind().get(joint)?.translation.into();
        Some(Self { controls, unknowns, joint, origin, reach_rad: 0.0 })
    }

    /// The largest angle from straight ahead, which is at an end of both ranges.
    fn reach(&self, pack: &Pack, state: &mut FaceState, values: &mut [f32]) -> Result<f32, FaceError> {
        let [first, second] = self.unknowns;
        let rest = [first.start, second.start];
        self.put(values, rest);
        state.pose(pack, values)?;
        let ahead = self.sight(state).direction;
        let mut reach = 0.0f32;
        for corner in [first.min, first.max].into_iter().flat_map(|x| [[x, second.min], [x, second.max]]) {
            self.put(values, corner);
            state.pose(pack, values)?;
            reach = reach.max(turn(ahead, self.sight(state).direction).length());
        }
        self.put(values, rest);
        Ok(reach.min(WIDEST_RAD))
    }

    fn put(&self, values: &mut [f32], at: [f32; 2]) {
        for (control, value) in self.controls.iter().zip(at) {
            if let Some(slot) = control.and_then(|control| values.get_mut(control)) {
                *slot = value;
            }
        }
    }

    fn report(&self, at: [f32; 2], out: &mut Vec<(usize, f32)>) {
        let both = self.controls.iter().zip(at);
        out.extend(both.filter_map(|(control, value)| Some(((*control)?, value))));
    }

    fn sight(&self, state: &FaceState) -> Sight {
        let bones = state.rig_pose().posed_from_bind();
        let posed_from_bind = bones.get(self.joint).copied().unwrap_or(Affine3A::IDENTITY);
        Sight {
            origin: posed_from_bind.transform_point3(self.origin),
            direction: posed_from_bind.transform_vector3(Vec3::Z).normalize_or(Vec3::Z),
        }
    }

    /// The direction that lies `share` of the way from `ahead` to `wanted`, or as far on that way as the
    /// controls reach. Without the limit the nearest direction within the ranges would lie at the top or
    /// bottom for what is far to the side.
    fn within_reach(&self, ahead: Vec3, wanted: Vec3, share: f32) -> Vec3 {
        let way = turn(ahead, wanted);
        let angle = way.length();
        let Some(axis) = way.try_normalize() else { return ahead };
        let turned = (share * angle).clamp(-self.reach_rad, self.reach_rad);
        glam::Quat::from_axis_angle(axis, turned) * ahead
    }
}

/// Control values to start from.
fn take(tried: &mut [f32], values: &[f32]) -> Result<(), FaceError> {
    if tried.len() != values.len() {
        return Err(FaceError::ValueCount { expected: tried.len(), found: values.len() });
    }
    tried.copy_from_slice(values);
    Ok(())
}

/// The shortest turn from one unit vector to another: its axis, as long as its angle in radians.
fn turn(from: Vec3, to: Vec3) -> Vec3 {
    let cross = from.cross(to);
    cross.normalize_or_zero() * cross.length().atan2(from.dot(to))
}
