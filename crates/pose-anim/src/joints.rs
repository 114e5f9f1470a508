use crate::quintic::Quintic;
use crate::{AdvanceError, Jet};
use glam::{Affine3A, DQuat, DVec3, Quat, Vec3};
use rig_core::{JointId, Locals, UnknownJoint};

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
    target: DQuat,
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
    /// At rest. A rotation without length or with numbers that are not finite counts as none; so does such a translation.
    pub fn new(at: JointTarget) -> Self {
        let translation = finite(at.translation);
        Self {
            elapsed_secs: 0.0,
            duration_secs: 0.0,
            target: unit(at.rotation),
            offset: [Way::Direct(Quintic::rest(0.0)); 3],
            translation: translation.to_array().map(|at| Way::Direct(Quintic::rest(at))),
            brake_secs: 0.0,
        }
    }

    /// Heads for a target, from now on, to arrive after `duration_secs` (0.001 to 3600; NaN counts as 0.001).
    pub fn press(&mut self, target: JointTarget, duration_secs: f32) {
        let secs = f64::from(duration_secs);
        let duration_secs = if secs.is_nan() { 0.001 } else { secs.clamp(0.001, 3600.0) };
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
        let end = unit(target.rotation);
        self.offset = offset_from(&rotation, end).map(|jet| Way::new(jet, 0.0, duration_secs, brake_secs));
        let ends = finite(target.translation).to_array();
        for ((way, jet), end) in self.translation.iter_mut().zip(translation).zip(ends) {
            *way = Way::new(jet, end, duration_secs, brake_secs);
        }
        self.brake_secs = brake_secs;
        self.target = end;
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

    /// The present rotation, of length 1; at the end the target to the last bit.
    pub fn rotation(&self) -> DQuat {
        if self.is_at_rest() {
            return self.target;
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
        let rotation = self.rotation();
        Affine3A::from_rotation_translation(rotation.as_quat(), self.translation().as_vec3())
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

/// `cos(θ/2)` and `sin(θ/2)/θ` as functions of `θ²`. Both are analytic, so the rotation vector may pass 0.
fn half_angle(square: Jet) -> (Jet, Jet) {
    let q = square.value;
    let (cosine, sine) = if q < 1e-4 {
        // Series in θ²: exact to rounding here.
        let c = [1.0, -1.0 / 8.0, 1.0 / 384.0, -1.0 / 46_080.0];
        let s = [0.5, -1.0 / 48.0, 1.0 / 3_840.0, -1.0 / 645_120.0];
        (series(c, q), series(s, q))
    } else {
        let t = q.sqrt();
        let (sin, cos) = (0.5 * t).sin_cos();
        // d/dq = 1/(2t) · d/dt
        let s0 = sin / t;
        let c1 = -0.25 * s0;
        let s1 = (0.5 * cos - s0) / (2.0 * q);
        let s2 = (-0.125 * s0 - 3.0 * s1) / (2.0 * q);
        (
            Jet { value: cos, velocity: c1, acceleration: -0.25 * s1 },
            Jet { value: s0, velocity: s1, acceleration: s2 },
        )
    };
    (square.through(cosine), square.through(sine))
}

/// `angle / sin(angle/2)` as a function of `w = cos(angle/2)` in 0…1.
fn angle_by_sine(w: Jet) -> Jet {
    let c = w.value.clamp(0.0, 1.0);
    let left = 1.0 - c;
    // 2·acos(c)/√(1 − c²) is analytic at c = 1; with y its value, (1 − c²)·y' = c·y − 2.
    let f = if left < 1e-3 {
        // In powers of (1 − c): 2·Σ (n!)²·2ⁿ/(2n + 1)! (1 − c)ⁿ.
        let a = [2.0, 2.0 / 3.0, 4.0 / 15.0, 4.0 / 35.0, 16.0 / 315.0];
        let value = a[0] + left * (a[1] + left * (a[2] + left * (a[3] + left * a[4])));
        let slope = a[1] + left * (2.0 * a[2] + left * (3.0 * a[3] + left * 4.0 * a[4]));
        let curve = 2.0 * a[2] + left * (6.0 * a[3] + left * 12.0 * a[4]);
        Jet { value, velocity: -slope, acceleration: curve }
    } else {
        let square = 1.0 - c * c;
        let value = 2.0 * c.acos() / square.sqrt();
        let slope = (c * value - 2.0) / square;
        Jet { value, velocity: slope, acceleration: (value + 3.0 * c * slope) / square }
    };
    w.through(f)
}

/// The rotation vector from `end` to `rotation`, the short way.
fn offset_from(rotation: &[Jet; 4], end: DQuat) -> [Jet; 3] {
    let mut way = multiply(*rotation, end.conjugate());
    if way[3].value < 0.0 {
        way = way.map(|jet| Jet::rest(0.0) - jet);
    }
    let scale = angle_by_sine(way[3]);
    [scale * way[0], scale * way[1], scale * way[2]]
}

/// `left · right` with a constant right factor.
fn multiply([x, y, z, w]: [Jet; 4], right: DQuat) -> [Jet; 4] {
    let by = |a: f64, b: f64, c: f64, d: f64| {
        Jet::rest(a) * x + Jet::rest(b) * y + Jet::rest(c) * z + Jet::rest(d) * w
    };
    let DQuat { x: rx, y: ry, z: rz, w: rw } = right;
    [by(rw, rz, -ry, rx), by(-rz, rw, rx, ry), by(ry, -rx, rw, rz), by(-rx, -ry, -rz, rw)]
}

/// The vector part of a product of quaternions of any length.
fn raw_product(a: DQuat, b: DQuat) -> DVec3 {
    let (av, bv) = (DVec3::new(a.x, a.y, a.z), DVec3::new(b.x, b.y, b.z));
    a.w * bv + b.w * av + av.cross(bv)
}

fn series([a, b, c, d]: [f64; 4], x: f64) -> Jet {
    Jet {
        value: a + x * (b + x * (c + x * d)),
        velocity: b + x * (2.0 * c + x * 3.0 * d),
        acceleration: 2.0 * c + 6.0 * d * x,
    }
}

fn unit(rotation: Quat) -> DQuat {
    let rotation = rotation.as_dquat();
    let length = rotation.length();
    if length > 0.0 && length.is_finite() { rotation * (1.0 / length) } else { DQuat::IDENTITY }
}

fn finite(translation: Vec3) -> DVec3 {
    if translation.is_finite() { translation.as_dvec3() } else { DVec3::ZERO }
}
