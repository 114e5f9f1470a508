//! Values of channels between keys: glTF 2.0, appendix C. Computed in f64.

use super::raw::{Channel, ChannelTarget, Interpolation};
use glam::DQuat;

/// Below this sine of the angle between two rotations, a straight line replaces the arc: it differs by less
/// than rounding, and the arc's quotient would be 0/0.
const MIN_SINE: f64 = 1e-9;

/// The value of a checked channel at a time, into as many numbers as one value has. A time outside of the
/// keys is clamped to them; NaN counts as the time of the first key.
pub(crate) fn sample(channel: &Channel, time_secs: f64, out: &mut [f32]) {
    let times = &channel.times;
    let width = out.len();
    let spline = channel.interpolation == Interpolation::CubicSpline;
    // The tangents' part of key `key`: 0 in, 1 value, 2 out.
    let at = |key: usize, slot: usize| {
        let start = if spline { (3 * key + slot) * width } else { key * width };
        channel.values.get(start..start + width).unwrap_or(&[])
    };
    // The last key that is not after the time.
    let after = times.partition_point(|&key| key <= time_secs);
    let (a, b) = (after.saturating_sub(1), after.min(times.len().saturating_sub(1)));
    let start = at(a, 1);
    let span = times.get(b).copied().unwrap_or(0.0) - times.get(a).copied().unwrap_or(0.0);
    if after == 0 || a == b || span <= 0.0 || channel.interpolation == Interpolation::Step {
        copy(start, out);
    } else {
        let s = (time_secs - times[a]) / span;
        match (channel.interpolation, channel.target) {
            (Interpolation::CubicSpline, _) => hermite(s, span, start, at(a, 2), at(b, 1), at(b, 0), out),
            (_, ChannelTarget::Rotation) => arc(s, start, at(b, 1), out),
            _ => {
                for ((out, &a), &b) in out.iter_mut().zip(start).zip(at(b, 1)) {
                    *out = (f64::from(a) * (1.0 - s) + f64::from(b) * s) as f32;
                }
            }
        }
    }
    if channel.target == ChannelTarget::Rotation {
        unit(out);
    }
}

fn copy(value: &[f32], out: &mut [f32]) {
    for (out, value) in out.iter_mut().zip(value) {
        *out = *value;
    }
}

/// `p(s) = (2s³−3s²+1) v_a + Δ (s³−2s²+s) b_a + (3s²−2s³) v_b + Δ (s³−s²) a_b` with the out-tangent `b_a` of
/// the earlier key, the in-tangent `a_b` of the later one and Δ seconds between them.
fn hermite(s: f64, span: f64, v_a: &[f32], b_a: &[f32], v_b: &[f32], a_b: &[f32], out: &mut [f32]) {
    let (s2, s3) = (s * s, s * s * s);
    let [va, ba] = [2.0 * s3 - 3.0 * s2 + 1.0, span * (s3 - 2.0 * s2 + s)];
    let [vb, ab] = [3.0 * s2 - 2.0 * s3, span * (s3 - s2)];
    for (i, out) in out.iter_mut().enumerate() {
        let of = |values: &[f32]| values.get(i).map_or(0.0, |value| f64::from(*value));
        *out = (va * of(v_a) + ba * of(b_a) + vb * of(v_b) + ab * of(a_b)) as f32;
    }
}

/// The shorter arc from one rotation to another at constant speed. Not glam's: that one takes an approximate
/// arc cosine, which is felt at the end of a long limb.
fn arc(s: f64, from: &[f32], to: &[f32], out: &mut [f32]) {
    let (Some(a), Some(b)) = (quaternion(from), quaternion(to)) else { return copy(from, out) };
    let cosine = a.dot(b);
    let b = if cosine < 0.0 { -b } else { b };
    let angle = cosine.abs().min(1.0).acos();
    let sine = angle.sin();
    let mixed = if sine < MIN_SINE {
        a * (1.0 - s) + b * s
    } else {
        a * (((1.0 - s) * angle).sin() / sine) + b * ((s * angle).sin() / sine)
    };
    copy(&mixed.to_array().map(|x| x as f32), out);
}

fn quaternion(values: &[f32]) -> Option<DQuat> {
    let &[x, y, z, w] = values else { return None };
    let q = DQuat::from_array([x, y, z, w].map(f64::from));
    let length = q.length();
    (length > 0.0).then(|| q / length)
}

/// Gives a rotation unit length; one of length 0 becomes the identity.
fn unit(values: &mut [f32]) {
    let unit = quaternion(values).unwrap_or(DQuat::IDENTITY);
    copy(&unit.to_array().map(|x| x as f32), values);
}
