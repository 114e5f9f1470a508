//! Rotations of head and eyes, and the angles that the controls of a face have for them.
//!
//! Matrices act on columns in the frame of a face: +X is the character's left, +Y up, +Z forward. In the
//! rig's own frames ([`pose_anim::face`]) the head turns about +Y, bows about +X and bends about −Z, in this
//! order from the left; an eye turns up about −X and then aside about +Y.

use crate::Frame;
use crate::channel::{EYE_LEFT_LR, EYE_LEFT_UD, EYE_RIGHT_LR, EYE_RIGHT_UD, HEAD_BEND, HEAD_BOW, HEAD_TURN};

/// Rows of a rotation.
pub(crate) type Matrix = [[f64; 3]; 3];

/// A rotation as a quaternion: x, y, z, w.
pub(crate) type Quaternion = [f64; 4];

/// The product: the second one acts first.
pub(crate) fn times(a: Quaternion, b: Quaternion) -> Quaternion {
    let ([ax, ay, az, aw], [bx, by, bz, bw]) = (a, b);
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// The same rotation where +X is the other side: what Unity's left-handed frame is to ours.
pub(crate) fn other_handed([x, y, z, w]: Quaternion) -> Quaternion {
    [x, -y, -z, w]
}

/// A quaternion about an axis of the frame.
pub(crate) fn about(axis: usize, degrees: f64) -> Quaternion {
    let (sin, cos) = libm::sincos(degrees.to_radians() / 2.0);
    let mut turned = [0.0, 0.0, 0.0, cos];
    if let Some(slot) = turned.get_mut(axis) {
        *slot = sin;
    }
    turned
}

/// The matrix of a quaternion of any length but 0.
pub(crate) fn matrix(q: Quaternion) -> Option<Matrix> {
    let length = q.iter().map(|x| x * x).sum::<f64>();
    if !(length.is_finite() && length > 1e-12) {
        return None;
    }
    let s = 2.0 / length;
    let [x, y, z, w] = q;
    Some([
        [1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)],
    ])
}

fn degrees(radians: f64) -> f32 {
    radians.to_degrees() as f32
}

/// Gives a frame the head's angles. With `M = Ry(turn) Rx(bow) Rz(−bend)`: `M₁₂ = −sin(bow)`,
/// `M₀₂ / M₂₂ = tan(turn)`, `M₁₀ / M₁₁ = tan(−bend)`.
pub(crate) fn set_head(frame: &mut Frame, [r0, r1, r2]: &Matrix) {
    frame.set(HEAD_TURN, degrees(libm::atan2(r0[2], r2[2])));
    frame.set(HEAD_BOW, degrees(libm::asin((-r1[2]).clamp(-1.0, 1.0))));
    frame.set(HEAD_BEND, degrees(-libm::atan2(r1[0], r1[1])));
}

/// The head's rotation in a frame, without which it is straight.
pub(crate) fn head(frame: &Frame) -> Quaternion {
    let angle = |channel| f64::from(frame.get(channel).unwrap_or_default());
    let turned = times(about(1, angle(HEAD_TURN)), about(0, angle(HEAD_BOW)));
    times(turned, about(2, -angle(HEAD_BEND)))
}

/// An eye: left or right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Eye {
    Left,
    Right,
}

impl Eye {
    /// Its channels: aside, and up.
    fn channels(self) -> [usize; 2] {
        match self {
            Self::Left => [EYE_LEFT_LR, EYE_LEFT_UD],
            Self::Right => [EYE_RIGHT_LR, EYE_RIGHT_UD],
        }
    }

    /// Gives a frame the eye's angles. With `M = Rx(−up) Ry(aside)`: `M₀₂ = sin(aside)`,
    /// `−M₁₂ / M₂₂ = tan(−up)`.
    pub(crate) fn set(self, frame: &mut Frame, [r0, r1, r2]: &Matrix) {
        self.set_angles(
            frame,
            degrees(libm::asin(r0[2].clamp(-1.0, 1.0))),
            degrees(-libm::atan2(-r1[2], r2[2])),
        );
    }

    /// Gives a frame the eye's angles, to the character's left and up.
    pub(crate) fn set_angles(self, frame: &mut Frame, aside: f32, up: f32) {
        let [aside_channel, up_channel] = self.channels();
        frame.set(aside_channel, aside);
        frame.set(up_channel, up);
    }

    /// The eye's angles in a frame, to the character's left and up.
    pub(crate) fn angles(self, frame: &Frame) -> Option<[f32; 2]> {
        let [aside, up] = self.channels();
        Some([frame.get(aside)?, frame.get(up)?])
    }

    /// The eye's rotation in a frame.
    pub(crate) fn turned(self, frame: &Frame) -> Option<Quaternion> {
        let [aside, up] = self.angles(frame)?;
        Some(times(about(0, (-up).into()), about(1, aside.into())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_come_back() {
        for turn in [-60.0f32, -5.0, 0.0, 40.0] {
            for bow in [-35.0f32, 0.0, 10.0] {
                for bend in [-20.0f32, 0.0, 33.0] {
                    let mut frame = Frame::default();
                    frame.set(HEAD_TURN, turn);
                    frame.set(HEAD_BOW, bow);
                    frame.set(HEAD_BEND, bend);
                    Eye::Left.set_angles(&mut frame, turn / 3.0, bow / 2.0);
                    let mut back = Frame::default();
                    set_head(&mut back, &matrix(head(&frame)).unwrap());
                    Eye::Left.set(&mut back, &matrix(Eye::Left.turned(&frame).unwrap()).unwrap());
                    for (channel, value) in frame.iter() {
                        assert!((back.get(channel).unwrap() - value).abs() < 1e-4, "{frame:?} {back:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn directions_are_those_of_the_face() {
        // Where the nose points, and the left ear, after a turn to the left, a nod down, and a bend to the
        // left.
        let column = |channel, at: usize| {
            let mut frame = Frame::default();
            frame.set(channel, 30.0);
            matrix(head(&frame)).unwrap().map(|row| row[at])
        };
        assert!((column(HEAD_TURN, 2)[0] - 0.5).abs() < 1e-9);
        assert!((column(HEAD_BOW, 2)[1] + 0.5).abs() < 1e-9);
        assert!((column(HEAD_BEND, 0)[1] + 0.5).abs() < 1e-9);
        let mut frame = Frame::default();
        Eye::Right.set_angles(&mut frame, 0.0, 30.0);
        let up = matrix(Eye::Right.turned(&frame).unwrap()).unwrap().map(|row| row[2]);
        assert!((up[1] - 0.5).abs() < 1e-9, "{up:?}");
    }

    #[test]
    fn what_is_no_rotation_is_none() {
        assert_eq!(matrix([0.0; 4]), None);
        assert_eq!(matrix([f64::NAN, 0.0, 0.0, 1.0]), None);
        assert_eq!(matrix([f64::MAX, 0.0, 0.0, 1.0]), None);
    }
}
