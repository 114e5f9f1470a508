//! How eyes follow things: the ranges of VRM, as functions from angles to turns of eyes and to values of
//! expressions. Angles are in degrees, as in the files.

use glam::{DAffine3, DVec3, EulerRot, Quat, Vec3};

/// How eyes look at things.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LookAt {
    /// What moves.
    pub kind: LookAtKind,
    /// The place between the eyes, in the space of the head's node.
    pub offset_from_head: Vec3,
    /// Towards the nose.
    pub horizontal_inner: RangeMap,
    /// Away from the nose; of expressions, both ways.
    pub horizontal_outer: RangeMap,
    /// Down.
    pub vertical_down: RangeMap,
    /// Up.
    pub vertical_up: RangeMap,
}

impl Default for LookAt {
    /// The values of the standard's example.
    fn default() -> Self {
        let range = RangeMap::default();
        Self {
            kind: LookAtKind::Bone,
            offset_from_head: Vec3::new(0.0, 0.06, 0.0),
            horizontal_inner: range,
            horizontal_outer: range,
            vertical_down: range,
            vertical_up: range,
        }
    }
}

/// What moves when an avatar looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LookAtKind {
    /// The bones `leftEye` and `rightEye`.
    #[default]
    Bone,
    /// The expressions `lookUp`, `lookDown`, `lookLeft` and `lookRight`.
    Expression,
}

/// How far eyes follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeMap {
    /// Angle beyond which eyes do not follow, in degrees.
    pub input_max_deg: f32,
    /// What they do there: degrees of bones, or the value of an expression.
    pub output_scale: f32,
}

impl Default for RangeMap {
    fn default() -> Self {
        Self { input_max_deg: 90.0, output_scale: 10.0 }
    }
}

impl RangeMap {
    /// `min(|angle|, max) / max · scale` with the sign of the angle. With a maximum of 0 every angle counts
    /// as the maximum.
    pub fn map(&self, angle_deg: f32) -> f32 {
        let most = self.input_max_deg.max(0.0);
        let share = if most > 0.0 { angle_deg.abs().min(most) / most } else { 1.0 };
        if angle_deg == 0.0 || angle_deg.is_nan() {
            0.0
        } else {
            share * self.output_scale * angle_deg.signum()
        }
    }
}

/// A direction as seen from the head.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gaze {
    /// To the character's left, in degrees.
    pub yaw_deg: f32,
    /// Down, in degrees.
    pub pitch_deg: f32,
}

/// Turns of both eyes relative to rest, in the axes of the model: +Y up, +Z forward.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EyeTurn {
    /// Of the character's left eye.
    pub left: Gaze,
    /// Of the right one.
    pub right: Gaze,
}

impl Gaze {
    /// As a rotation in the axes of the model: pitch about x, then yaw about y. An eye whose rest pose is
    /// turned by `r` in the model turns by `r⁻¹ · rotation · r` after its own rotation at rest.
    pub fn rotation(self) -> Quat {
        let (yaw, pitch) = (self.yaw_deg.to_radians(), self.pitch_deg.to_radians());
        Quat::from_euler(EulerRot::YXZ, yaw, pitch, 0.0)
    }
}

impl LookAt {
    /// Where a target in world space is as seen by the character: yaw = atan2(x, z), pitch = atan2(−y, √(x² +
    /// z²)) in the space that follows the head and has the axes of the model at rest. `head_at_rest` and
    /// `head` are `world_from_node` of the head.
    pub fn gaze(&self, head_at_rest: &DAffine3, head: &DAffine3, target: DVec3) -> Gaze {
        let eyes = head.transform_point3(self.offset_from_head.as_dvec3());
        let (_, rest, _) = head_at_rest.to_scale_rotation_translation();
        let (_, now, _) = head.to_scale_rotation_translation();
        let seen = rest * (now.inverse() * (target - eyes));
        if !seen.is_finite() {
            return Gaze::default();
        }
        let yaw = seen.x.atan2(seen.z);
        let pitch = (-seen.y).atan2(seen.x.hypot(seen.z));
        Gaze { yaw_deg: yaw.to_degrees() as f32, pitch_deg: pitch.to_degrees() as f32 }
    }

    /// How the eye bones turn for a gaze, within their ranges.
    pub fn eyes(&self, gaze: Gaze) -> EyeTurn {
        let (towards_left, towards_right) = if gaze.yaw_deg > 0.0 {
            (self.horizontal_outer, self.horizontal_inner)
        } else {
            (self.horizontal_inner, self.horizontal_outer)
        };
        let pitch_deg = self.vertical(gaze.pitch_deg).map(gaze.pitch_deg);
        EyeTurn {
            left: Gaze { yaw_deg: towards_left.map(gaze.yaw_deg), pitch_deg },
            right: Gaze { yaw_deg: towards_right.map(gaze.yaw_deg), pitch_deg },
        }
    }

    /// The values of the four looking expressions for a gaze.
    pub fn expressions(&self, gaze: Gaze) -> [(&'static str, f32); 4] {
        let yaw = self.horizontal_outer.map(gaze.yaw_deg);
        let pitch = self.vertical(gaze.pitch_deg).map(gaze.pitch_deg);
        [
            ("lookLeft", yaw.max(0.0)),
            ("lookRight", (-yaw).max(0.0)),
            ("lookDown", pitch.max(0.0)),
            ("lookUp", (-pitch).max(0.0)),
        ]
    }

    fn vertical(&self, pitch_deg: f32) -> RangeMap {
        if pitch_deg > 0.0 { self.vertical_down } else { self.vertical_up }
    }
}
