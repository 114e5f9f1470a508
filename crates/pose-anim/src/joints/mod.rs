mod rotation;

use crate::quintic::Quintic;
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

/// Moves one joint's whole rotation and translation, for rigs that are posed by joints rather than by controls.
///
/// The same promises as [`crate::Player`]'s: rotation, angular velocity and angular acceleration are continuous at every press,
/// and so are the translation and its derivatives; both arrive exactly and at rest; time may be cut in any way.
///
/// A rotation has two quaternions, `q` and `−q`. The one that goes on without a jump is taken, all the way. So a joint arrives at the given
/// quaternion or its negative, to the last bit; [`Self::local`] is the same for both. While it moves, the quaternion has length 1; at
/// the end it has the length that was given, which is 1 up to the rounding of its single precision.
///
/// The rotation is written relative to its target as a rotation vector, `q(t) = exp(ρ(t)/2) · q_target`. At a press, ρ and its first two
/// derivatives follow from those of the running motion, taking the short way round, and each of its components goes to 0 by the
/// move of least jerk. From rest this is the great arc, run through by minimum jerk.
///
/// A move that is much slower than the one that it interrupts would fly far past the target first, and, interrupted again, ever
/// further; a control has a range that forbids it, a joint has none. Then the old speed is first braked in the time of the old
/// move, `b(t)`, and faded into the target meanwhile: `x(t) = (1 − r(t)) · b(t) + r(t) · target`, as controls do.
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
    /// How long the old speed is braked.
    brake_secs: f64,
}

/// The motion of one coordinate.
#[derive(Clone, Copy, Debug)]
enum Way {
    /// To its end by the move of least jerk.
    Direct(Quintic),
    /// To rest by such a move, which is faded into the end meanwhile.
    Braked { brake: Quintic, end: f64 },
}

impl Way {
    fn new(state: Jet, end: f64, duration_secs: f64, brake_secs: f64) -> Self {
        if brake_secs >= duration_secs {
            return Self::Direct(Quintic::new(state, end, duration_secs));
        }
        // The free end of a move of least jerk.
        let stop = state.value + brake_secs * (state.velocity / 2.0 + state.acceleration * brake_secs / 12.0);
        Self::Braked { brake: Quintic::new(state, stop, brake_secs), end }
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
    /// At rest. A rotation without length or with numbers that are not finite counts as none; a component of the translation that
    /// is not finite as 0.
    pub fn new(at: JointTarget) -> Self {
        let (target, end) = unit(at.rotation).unwrap_or((DQuat::IDENTITY, Quat::IDENTITY));
        let rest = |at: f32| Way::Direct(Quintic::rest(if at.is_finite() { at.into() } else { 0.0 }));
        Self {
            elapsed_secs: 0.0,
            duration_secs: 0.0,
            target,
            end,
            offset: [Way::Direct(Quintic::rest(0.0)); 3],
            translation: at.translation.to_array().map(rest),
            brake_secs: 0.0,
        }
    }

    /// Heads for a target, from now on, to arrive after `duration_secs` (0.001 to 3600; NaN counts as 0.001).
    ///
    /// What is no target is passed over: a rotation without length or with numbers that are not finite, a component of the translation that
    /// is not finite. There the former target stays, to be reached in the new time.
    pub fn press(&mut self, target: JointTarget, duration_secs: f64) {
        let duration_secs = if duration_secs.is_nan() { 0.001 } else { duration_secs.clamp(0.001, 3600.0) };
        let rotation = self.rotation_jets();
        let translation = self.translation_jets();
        // The time scale of the running motion; a rest has none.
        let old_secs = match self.elapsed_secs {
            _ if self.is_at_rest() => f64::INFINITY,
            elapsed_secs if elapsed_secs < self.brake_secs => self.brake_secs,
            _ => self.duration_secs,
        };
        // Moves of about the same speed may well be direct.
        let brake_secs = if duration_secs > 1.5 * old_secs { old_secs } else { duration_secs };
        let (mut goal, mut end) = unit(target.rotation).unwrap_or((self.target, self.end));
        // Of the two quaternions of the goal, the one on the short way.
        let here = DQuat::from_array(rotation.map(|jet| jet.value));
        if here.dot(goal) < 0.0 {
            (goal, end) = (-goal, -end);
        }
        self.offset = offset_from(&rotation, goal).map(|jet| Way::new(jet, 0.0, duration_secs, brake_secs));
        for ((way, jet), at) in
            self.translation.iter_mut().zip(translation).zip(target.translation.to_array())
        {
            let end = if at.is_finite() { at.into() } else { way.end() };
            *way = Way::new(jet, end, duration_secs, brake_secs);
        }
        self.brake_secs = brake_secs;
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

    /// Angular velocity and acceleration, as vectors in the frame of the joint's parent, in radians per second and per second
    /// squared.
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

    /// Sets `L` of a joint.
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

/// A rotation at length 1 in double precision, and as it is at rest: as it was given, if it has that length up to the rounding of its
/// single precision. `None` if it is none.
fn unit(rotation: Quat) -> Option<(DQuat, Quat)> {
    let precise = rotation.as_dquat();
    let length = precise.length();
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let end = if (length - 1.0).abs() <= 1e-6 { rotation } else { (precise * (1.0 / length)).as_quat() };
    Some((end.as_dquat().normalize(), end))
}
