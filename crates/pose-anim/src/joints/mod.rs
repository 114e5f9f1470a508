mod rotation;
#[cfg(test)]
mod tests;

use crate::brake::brake;
use crate::quintic::Quintic;
use crate::range::Range;
use crate::{AdvanceError, Jet};
use glam::{Affine3A, DQuat, DVec3, Quat, Vec3};
use rig_core::{JointId, Locals, UnknownJoint};
use rotation::{half_angle, multiply, offset_from, raw_product};

/// Where a joint is to go: its whole local transform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointTarget {
    /// Local rotation; any length but 0.
    pub rotation: Quat,
    /// Local translation in the rig's units.
    pub translation: Vec3,
}

/// Moves one joint's whole rotation and translation, for rigs that are posed by joints rather than by
/// controls.
///
/// The same promises as [`crate::Player`]'s: rotation, angular velocity and angular acceleration are
/// continuous at every press, and so are the translation and its derivatives; both arrive exactly and at
/// rest; time may be cut in any way.
///
/// A rotation has two quaternions, `q` and `−q`. The one that goes on without a jump is taken, all the way.
/// So a joint arrives at the given quaternion or its negative, to the last bit; [`Self::local`] is the same
/// for both. While it moves, the quaternion has length 1; at the end it has the length that was given, which
/// is 1 up to the rounding of its single precision.
///
/// The rotation is written relative to its target as a rotation vector, `q(t) = exp(ρ(t)/2) · q_target`. At a
/// press, ρ and its first two derivatives follow from those of the running motion, taking the short way
/// round, and each of its components goes to 0 by the move of least jerk. From rest this is the great arc,
/// run through by minimum jerk.
///
/// # Overshoot
///
/// A move that is much slower than the one that it interrupts would fly far past its target first. A control
/// has a range that forbids it; a joint has none. So it keeps the time scale in which its speed arose, and a
/// move that is more than 1.5 times slower than that first brakes the old speed within the old time, `b(t)`,
/// and fades into the target meanwhile: `x(t) = (1 − r(t)) · b(t) + r(t) · target`, as controls do. Presses
/// in quick succession keep the shortest time scale among them.
///
/// There is a bound for any number of presses at any moments. Take all targets since the joint last rested,
/// and the place where it rested. A coordinate of the translation leaves their span by no more than half its
/// width, on either side. A component of the rotation vector, which is 0 at the target, stays within 1.5
/// times the largest angle that a target was away when it was pressed, which is π at most. The reason: a
/// direct move is only taken if it stays in that range; otherwise `b(t)` is chosen to stay in it, and a
/// weighted mean of two values in a range is in the range. (That such a `b(t)` is always found is tested, not
/// proven.)
#[derive(Clone, Debug)]
pub struct JointPlayer {
    elapsed_secs: f64,
    duration_secs: f64,
    /// Of length 1.
    target: DQuat,
    /// As it was given, but for its sign.
    end: Quat,
    /// The way that is left, as a rotation vector.
    offset: [Way; 3],
    translation: [Way; 3],
    /// Time scale of the present speed, until it has passed.
    scale_secs: f64,
    /// Largest angle of a target at its press since the joint last rested.
    widest_rad: f64,
    /// Span of the targets since the joint last rested, and of the place where it rested.
    span: [Range; 3],
}

/// Moves that are slower by no more than this factor may be direct.
const DIRECT: f64 = 1.5;

/// How far the span of the targets may be left, as a share of its width.
const MARGIN: f64 = 0.5;

/// The motion of one coordinate.
#[derive(Clone, Copy, Debug)]
enum Way {
    /// To its end by the move of least jerk.
    Direct(Quintic),
    /// To rest by such a move, which is faded into the end meanwhile.
    Braked { brake: Quintic, end: f64 },
}

impl Way {
    /// From `state` to `end`, both in the range, in `duration_secs`; `old_secs` is the time scale of the
    /// state's speed.
    fn new(state: Jet, end: f64, duration_secs: f64, old_secs: f64, range: Range) -> Self {
        let direct = Quintic::new(state, end, duration_secs);
        if duration_secs <= DIRECT * old_secs && direct.stays_within(range.min, range.max) {
            return Self::Direct(direct);
        }
        let secs = old_secs.min(duration_secs);
        // The free end of a move of least jerk.
        let stop = state.value + secs * (state.velocity / 2.0 + state.acceleration * secs / 12.0);
        Self::Braked { brake: brake(state, stop, secs, range), end }
    }

    fn end(&self) -> f64 {
        match self {
            Self::Direct(quintic) => quintic.target,
            Self::Braked { end, .. } => *end,
        }
    }

    fn at(&self, age_secs: f64, duration_secs: f64) -> Jet {
        match self {
            Self::Direct(quintic) => quintic.at(age_secs),
            Self::Braked { end, .. } if age_secs >= duration_secs => Jet::rest(*end),
            Self::Braked { brake, end } => {
                brake.at(age_secs).mix(Jet::rest(*end), Jet::step(age_secs, duration_secs))
            }
        }
    }
}

impl JointPlayer {
    /// At rest. A rotation of length 0 or with numbers that are not finite counts as no rotation; a component
    /// of the translation that is not finite counts as 0.
    pub fn new(at: JointTarget) -> Self {
        let (target, end) = unit(at.rotation).unwrap_or((DQuat::IDENTITY, Quat::IDENTITY));
        let place = at.translation.to_array().map(|at| if at.is_finite() { at.into() } else { 0.0 });
        Self {
            elapsed_secs: 0.0,
            duration_secs: 0.0,
            target,
            end,
            offset: [Way::Direct(Quintic::rest(0.0)); 3],
            translation: place.map(|at| Way::Direct(Quintic::rest(at))),
            scale_secs: 0.0,
            widest_rad: 0.0,
            span: place.map(|at| Range { min: at, max: at }),
        }
    }

    /// Heads for a target, from now on, to arrive after `duration_secs` (0.001 to 3600; NaN counts as 0.001).
    ///
    /// A rotation of length 0 or with numbers that are not finite is ignored, and so is a component of the
    /// translation that is not finite. The former target stays in its place, to be reached in the new time.
    pub fn press(&mut self, target: JointTarget, duration_secs: f64) {
        let duration_secs = if duration_secs.is_nan() { 0.001 } else { duration_secs.clamp(0.001, 3600.0) };
        let rotation = self.rotation_jets();
        let translation = self.translation_jets();
        let rests = self.is_at_rest();
        // A rest has no time scale.
        let old_secs = match self.elapsed_secs {
            _ if rests => f64::INFINITY,
            elapsed_secs if elapsed_secs < self.scale_secs => self.scale_secs,
            _ => self.duration_secs,
        };
        let (mut goal, mut end) = unit(target.rotation).unwrap_or((self.target, self.end));
        // Of the two quaternions of the goal, the one on the short way.
        let here = DQuat::from_array(rotation.map(|jet| jet.value));
        if here.dot(goal) < 0.0 {
            (goal, end) = (-goal, -end);
        }
        let offset = offset_from(&rotation, goal);
        let angle_rad = DVec3::from_array(offset.map(|jet| jet.value)).length();
        self.widest_rad = if rests { angle_rad } else { self.widest_rad.max(angle_rad) };
        let within = Range { min: -self.widest_rad, max: self.widest_rad }.widened(MARGIN / 2.0);
        self.offset = offset.map(|jet| Way::new(jet, 0.0, duration_secs, old_secs, within));
        let ways = self.translation.iter_mut().zip(&mut self.span).zip(translation);
        for (((way, span), jet), at) in ways.zip(target.translation.to_array()) {
            let end = if at.is_finite() { at.into() } else { way.end() };
            if rests {
                *span = Range { min: jet.value, max: jet.value };
            }
            *span = Range { min: span.min.min(end), max: span.max.max(end) };
            *way = Way::new(jet, end, duration_secs, old_secs, span.widened(MARGIN));
        }
        self.scale_secs = old_secs.min(duration_secs);
        self.target = goal;
        self.end = end;
        self.elapsed_secs = 0.0;
        self.duration_secs = duration_secs;
    }

    /// Lets time pass.
    ///
    /// # Errors
    /// A negative time step or NaN; then nothing changes.
    pub fn advance(&mut self, dt_secs: f64) -> Result<(), AdvanceError> {
        AdvanceError::check(dt_secs)?;
        self.elapsed_secs += dt_secs;
        Ok(())
    }

    /// The present rotation, of length 1; at the end the target or its negative, to the last bit.
    pub fn rotation(&self) -> DQuat {
        if self.is_at_rest() {
            return self.end.as_dquat();
        }
        let [x, y, z, w] = self.rotation_jets().map(|jet| jet.value);
        DQuat::from_xyzw(x, y, z, w)
    }

    /// The present translation.
    pub fn translation(&self) -> DVec3 {
        DVec3::from_array(self.translation_jets().map(|jet| jet.value))
    }

    /// Angular velocity and acceleration, as vectors in the frame of the joint's parent, in radians per
    /// second and per second squared.
    pub fn angular_rates(&self) -> (DVec3, DVec3) {
        let jets = self.rotation_jets();
        let quat = |part: fn(&Jet) -> f64| {
            DQuat::from_xyzw(part(&jets[0]), part(&jets[1]), part(&jets[2]), part(&jets[3]))
        };
        let (q, dq, ddq) = (quat(|jet| jet.value), quat(|jet| jet.velocity), quat(|jet| jet.acceleration));
        // ω = 2 q' q̄; the derivative of q̄ is the conjugate of q'. (q' q̄' is a real number.)
        let back = q.conjugate();
        (2.0 * raw_product(dq, back), 2.0 * raw_product(ddq, back))
    }

    /// First and second derivative of the translation.
    pub fn linear_rates(&self) -> (DVec3, DVec3) {
        let jets = self.translation_jets();
        (DVec3::from_array(jets.map(|jet| jet.velocity)), DVec3::from_array(jets.map(|jet| jet.acceleration)))
    }

    /// Whether the joint has arrived.
    pub fn is_at_rest(&self) -> bool {
        self.elapsed_secs >= self.duration_secs
    }

    /// The present local transform `L`.
    pub fn local(&self) -> Affine3A {
        Affine3A::from_rotation_translation(self.rotation().as_quat(), self.translation().as_vec3())
    }

    /// Sets `L` of a joint to the present transform.
    ///
    /// # Errors
    /// The joint belongs to a larger rig.
    pub fn apply(&self, joint: JointId, locals: &mut Locals) -> Result<(), UnknownJoint> {
        locals.set(joint, self.local())
    }

    fn translation_jets(&self) -> [Jet; 3] {
        self.translation.map(|way| way.at(self.elapsed_secs, self.duration_secs))
    }

    /// x, y, z and w of the rotation.
    fn rotation_jets(&self) -> [Jet; 4] {
        let [x, y, z] = self.offset.map(|way| way.at(self.elapsed_secs, self.duration_secs));
        let square = x * x + y * y + z * z;
        let (cosine, sine) = half_angle(square);
        multiply([sine * x, sine * y, sine * z, cosine], self.target)
    }
}

/// A rotation at length 1 in double precision, and as it is at rest: as it was given, if it has that length
/// up to the rounding of its single precision. `None` if it has no direction.
fn unit(rotation: Quat) -> Option<(DQuat, Quat)> {
    let precise = rotation.as_dquat();
    let length = precise.length();
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let end = if (length - 1.0).abs() <= 1e-6 { rotation } else { (precise * (1.0 / length)).as_quat() };
    Some((end.as_dquat().normalize(), end))
}
