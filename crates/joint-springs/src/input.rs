//! Where the skeleton was between frames.

use glam::{Affine3A, Mat3A, Vec3A};

/// The matrices of the last frames.
#[derive(Clone, Debug)]
pub(crate) struct Input {
    /// The last frame, the one before it and the one before that.
    frames: [Vec<Affine3A>; 3],
    /// How long before the last frame the other two were, in seconds; 0 where there was none.
    ago: [f64; 2],
    /// Whether there was a frame.
    any: bool,
}

/// Beside a step of 1, an older one below this says more about rounding than about the motion.
const SHORTEST: f64 = 0.01;

impl Input {
    pub(crate) fn new(joints: usize) -> Self {
        let none = || vec![Affine3A::IDENTITY; joints];
        Self { frames: [none(), none(), none()], ago: [0.0; 2], any: false }
    }

    /// Forgets every frame.
    pub(crate) fn reset(&mut self) {
        (self.any, self.ago) = (false, [0.0; 2]);
    }

    /// Whether there was a frame.
    pub(crate) fn any(&self) -> bool {
        self.any
    }

    /// Takes the next frame, `secs` after the last.
    pub(crate) fn push(&mut self, secs: f64, world: &[Affine3A]) {
        if self.any && secs > 0.0 {
            self.frames.rotate_right(1);
            let before = if self.ago[0] > 0.0 { secs + self.ago[0] } else { 0.0 };
            self.ago = [secs, before];
        }
        self.frames[0].copy_from_slice(world);
        self.any = true;
    }

    /// Writes where the joints were `ago` seconds before the last frame.
    pub(crate) fn at(&self, ago: f64, joints: &[usize], world: &mut [Affine3A]) {
        let weights = self.weights(ago).map(|weight| weight as f32);
        for joint in joints {
            let [now, before, older] = self.frames.each_ref().map(|frame| frame[*joint]);
            world[*joint] = mean([now, before, older], weights);
        }
    }

    /// Lagrange's parabola through three moments, or the line through two.
    fn weights(&self, ago: f64) -> [f64; 3] {
        let [b, c] = self.ago;
        if b <= 0.0 {
            return [1.0, 0.0, 0.0];
        }
        if c - b <= SHORTEST * b {
            return [1.0 - ago / b, ago / b, 0.0];
        }
        [(ago - b) * (ago - c) / (b * c), ago * (ago - c) / (b * (b - c)), ago * (ago - b) / (c * (c - b))]
    }
}

/// Weights of number 1, 0, 0 give the first matrix bit for bit.
fn mean([a, b, c]: [Affine3A; 3], [u, v, w]: [f32; 3]) -> Affine3A {
    if v == 0.0 && w == 0.0 {
        return a;
    }
    let mix = |a: Vec3A, b: Vec3A, c: Vec3A| a * u + b * v + c * w;
    // A mean of rotations is a little shorter than a rotation: it gets its lengths back.
    let axis = |a: Vec3A, b: Vec3A, c: Vec3A| {
        let length = a.length() * u + b.length() * v + c.length() * w;
        mix(a, b, c).normalize_or_zero() * length
    };
    let (x, y, z) = (a.matrix3, b.matrix3, c.matrix3);
    Affine3A {
        matrix3: Mat3A::from_cols(
            axis(x.x_axis, y.x_axis, z.x_axis),
            axis(x.y_axis, y.y_axis, z.y_axis),
            axis(x.z_axis, y.z_axis, z.z_axis),
        ),
        translation: mix(a.translation, b.translation, c.translation),
    }
}
