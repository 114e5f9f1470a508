//! What [`Binding`] does for one face, for many at once.

use crate::bind::Factor;
use crate::{ApplyError, Binding, Coupling, JointMotion};
use lanes::{Lanes, Simd, Wide, Work, steps};
use rig_core::{MotionLanes, RigCrowd};
use std::f32::consts::FRAC_2_PI;

/// The largest angle in degrees whose sine the vectors compute: of half of it, 8192 in radians, quarter
/// turns are taken off without loss. A caller may go beyond; then sines are computed one by one.
const LARGEST_DEG: f32 = 900_000.0;

impl Binding {
    /// [`Self::couple`] for many faces: slices have, by block of [`lanes::LANES`] faces, one value per
    /// control. Blocks beyond the slices' common length are left alone.
    pub fn couple_crowd(&self, values: &[Lanes], out: &mut [Lanes]) {
        lanes::run(Couple { binding: self, values, out });
    }

    /// [`Self::apply`] for many faces: sets the local transforms of all driven joints and the weights of
    /// all driven shapes. `values` have, by block of [`lanes::LANES`] faces, one value per control,
    /// `weights` one weight per shape. Allocates nothing.
    ///
    /// # Errors
    /// A slice of another length than the blocks of `rigs` times what is bound, rigs with another number of
    /// joints, or a value that is not finite; then nothing has been changed.
    pub fn apply_crowd(
        &self,
        values: &[Lanes],
        rigs: &mut RigCrowd,
        weights: &mut [Lanes],
    ) -> Result<(), ApplyError> {
        let blocks = rigs.blocks();
        let lengths = [
            ("local transforms", self.joint_count, rigs.joint_count()),
            ("blocks of control values", self.controls.len() * blocks, values.len()),
            ("blocks of shape weights", self.shape_count * blocks, weights.len()),
        ];
        for (what, expected, found) in lengths {
            if expected != found {
                return Err(ApplyError::Length { what, expected, found });
            }
        }
        let is_exact = match lanes::run(Largest(values)) {
            square if square.is_finite() => square > LARGEST_DEG * LARGEST_DEG,
            _ => true,
        };
        if is_exact && let Some(error) = self.first_not_finite(values) {
            return Err(error);
        }
        lanes::run(Apply { binding: self, values, rigs, is_exact });
        if self.shape_count > 0 && !self.controls.is_empty() {
            let values = values.chunks_exact(self.controls.len());
            for (values, weights) in values.zip(weights.chunks_exact_mut(self.shape_count)) {
                self.shapes.iter().for_each(|(control, shape)| weights[*shape] = values[*control]);
            }
        }
        Ok(())
    }

    fn first_not_finite(&self, values: &[Lanes]) -> Option<ApplyError> {
        let found = values.iter().enumerate().find_map(|(place, lanes)| {
            lanes.iter().find(|value| !value.is_finite()).map(|value| (place, *value))
        });
        found.map(|(place, value)| ApplyError::NotFinite {
            control: place % self.controls.len().max(1),
            value,
        })
    }
}

/// The largest square of all values; NaN if one is not finite.
struct Largest<'a>(&'a [Lanes]);

impl Work for Largest<'_> {
    type Output = f32;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f32 {
        let (mut squares, mut rests) = (Lanes::splat(0.0), Lanes::splat(0.0));
        for step in 0..steps::<S>() {
            // What is not finite leaves NaN, and NaN stays.
            let (mut rest, mut largest) = (Wide::splat(simd, 0.0), Wide::splat(simd, 0.0));
            for lanes in self.0 {
                let value = Wide::load(simd, lanes, step);
                let square = value * value;
                rest = rest + value * Wide::splat(simd, 0.0);
                largest = largest.below(square, square, largest);
            }
            largest.store(&mut squares, step);
            rest.store(&mut rests, step);
        }
        squares.iter().copied().fold(0.0, f32::max) + rests.iter().sum::<f32>()
    }
}

struct Couple<'a> {
    binding: &'a Binding,
    values: &'a [Lanes],
    out: &'a mut [Lanes],
}

impl Work for Couple<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let count = self.binding.controls.len().max(1);
        for (values, out) in self.values.chunks_exact(count).zip(self.out.chunks_exact_mut(count)) {
            out.copy_from_slice(values);
            for coupling in &self.binding.couplings {
                couple(simd, self.binding, coupling, values, out);
            }
        }
    }
}

/// One coupling, in the order of operations of [`Binding::couple`].
#[inline(always)]
fn couple<S: Simd>(simd: S, binding: &Binding, coupling: &Coupling, values: &[Lanes], out: &mut [Lanes]) {
    let (Some(leader), Some(follower)) =
        (binding.controls.get(coupling.from), binding.controls.get(coupling.to))
    else {
        return;
    };
    let splat = |value| Wide::splat(simd, value);
    // An end without a way to it is infinitely far: there the follower is free.
    let way = |end: f32| match end - follower.default {
        0.0 => f32::INFINITY,
        way => way,
    };
    let (up, down, rest) = (splat(way(follower.max)), splat(way(follower.min)), splat(follower.default));
    let (zero, one, factor, start) = (splat(0.0), splat(1.0), splat(coupling.factor), splat(leader.default));
    let (min, max) = (splat(follower.min), splat(follower.max));
    for step in 0..steps::<S>() {
        let from = Wide::load(simd, &values[coupling.from], step);
        let to = Wide::load(simd, &values[coupling.to], step);
        let u = ((to - rest) / to.below(rest, down, up)).clamp(zero, one);
        let fade = one - u * u * u * (splat(10.0) + u * (splat(6.0) * u - splat(15.0)));
        let slot = &mut out[coupling.to];
        let coupled = Wide::load(simd, slot, step) + factor * (from - start) * fade;
        coupled.clamp(min, max).store(slot, step);
    }
}

struct Apply<'a> {
    binding: &'a Binding,
    values: &'a [Lanes],
    rigs: &'a mut RigCrowd,
    /// Whether sines are computed one by one.
    is_exact: bool,
}

impl Work for Apply<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let count = self.binding.controls.len().max(1);
        for (block, values) in self.values.chunks_exact(count).enumerate() {
            let motions = self.rigs.motions_mut(block);
            for (joint, range) in &self.binding.joints {
                let factors = &self.binding.factors[range.clone()];
                compose(simd, factors, values, self.is_exact, &mut motions[joint.index()]);
            }
        }
    }
}

/// `L = M₀ · M₁ · …` of one joint.
#[inline(always)]
fn compose<S: Simd>(simd: S, factors: &[Factor], values: &[Lanes], is_exact: bool, motion: &mut MotionLanes) {
    let splat = |value| Wide::splat(simd, value);
    for step in 0..steps::<S>() {
        let mut rotation = [splat(0.0), splat(0.0), splat(0.0), splat(1.0)];
        let mut translation = [splat(0.0); 3];
        let mut is_turned = false;
        for factor in factors {
            let value = Wide::load(simd, &values[factor.control], step);
            match factor.kind {
                JointMotion::Rotation => {
                    // Without a length, the axis turns nothing.
                    let Some(axis) = factor.axis.try_normalize() else { continue };
                    let (sin, cos) = half_sin_cos(simd, value, is_exact, step);
                    let turn = [axis.x, axis.y, axis.z].map(|part| splat(part) * sin);
                    let turn = [turn[0], turn[1], turn[2], cos];
                    rotation = if is_turned { product(rotation, turn) } else { turn };
                    is_turned = true;
                }
                JointMotion::Translation => {
                    let offset =
                        [factor.axis.x, factor.axis.y, factor.axis.z].map(|part| splat(part) * value);
                    let offset = if is_turned { rotated(rotation, offset) } else { offset };
                    translation = [0, 1, 2].map(|i| translation[i] + offset[i]);
                }
            }
        }
        rotation.iter().zip(&mut motion.rotation).for_each(|(number, slot)| number.store(slot, step));
        translation.iter().zip(&mut motion.translation).for_each(|(number, slot)| number.store(slot, step));
    }
}

/// The product of two quaternions x, y, z, w.
#[inline(always)]
fn product<S: Simd>([ax, ay, az, aw]: [Wide<S>; 4], [bx, by, bz, bw]: [Wide<S>; 4]) -> [Wide<S>; 4] {
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// A vector, turned by a unit quaternion: `v + 2w (u × v) + 2 u × (u × v)`.
#[inline(always)]
fn rotated<S: Simd>([x, y, z, w]: [Wide<S>; 4], v: [Wide<S>; 3]) -> [Wide<S>; 3] {
    let cross = |v: [Wide<S>; 3]| [y * v[2] - z * v[1], z * v[0] - x * v[2], x * v[1] - y * v[0]];
    let once = cross(v).map(|part| part + part);
    let twice = cross(once);
    [0, 1, 2].map(|i| v[i] + w * once[i] + twice[i])
}

/// Sine and cosine of half an angle in degrees.
#[inline(always)]
fn half_sin_cos<S: Simd>(simd: S, degrees: Wide<S>, is_exact: bool, step: usize) -> (Wide<S>, Wide<S>) {
    let half_rad = degrees * Wide::splat(simd, 1f32.to_radians()) * Wide::splat(simd, 0.5);
    if !is_exact {
        return sin_cos(simd, half_rad);
    }
    let (mut sines, mut cosines) = (Lanes::splat(0.0), Lanes::splat(0.0));
    half_rad.store(&mut sines, step);
    for (sin, cos) in sines.iter_mut().zip(cosines.iter_mut()) {
        (*sin, *cos) = sin.sin_cos();
    }
    (Wide::load(simd, &sines, step), Wide::load(simd, &cosines, step))
}

/// Sine and cosine of an angle in radians, up to half of [`LARGEST_DEG`], to the last bit or two: quarter
/// turns are taken off by the method of Cody and Waite (*Software Manual for the Elementary Functions*,
/// 1980), what remains goes through the polynomials of Cephes' `sinf` and `cosf` (S. L. Moshier).
#[inline(always)]
fn sin_cos<S: Simd>(simd: S, angle: Wide<S>) -> (Wide<S>, Wide<S>) {
    let splat = |value| Wide::splat(simd, value);
    // Adding 1.5 · 2²³ rounds to a whole number, which is then in the lowest bits.
    let magic = splat(12_582_912.0);
    let quarters = angle * splat(FRAC_2_PI) + magic;
    let turns = quarters - magic;
    // π/2 in three parts; products of the first two with small whole numbers are exact.
    let x = angle - turns * splat(1.570_312_5) - turns * splat(4.837_513e-4) - turns * splat(7.549_79e-8);
    let z = x * x;
    let sin = splat(-1.951_529_6e-4) * z + splat(8.332_161e-3);
    let sin = x + x * z * (sin * z - splat(1.666_665_5e-1));
    let cos = splat(2.443_315_7e-5) * z - splat(1.388_731_6e-3);
    let cos = splat(1.0) - splat(0.5) * z + z * z * (cos * z + splat(4.166_664_6e-2));
    let (s, c) = (quarters.bit(0, cos, sin), quarters.bit(0, sin, cos));
    let (zero, next) = (splat(0.0), quarters + splat(1.0));
    (quarters.bit(1, zero - s, s), next.bit(1, zero - c, c))
}
