//! 4×4 matrices in f64, by the school book: the independent half of comparisons.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use glam::Affine3A;

/// Rows of columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct M(pub(crate) [[f64; 4]; 4]);

impl M {
    pub(crate) const IDENTITY: Self =
        Self([[1., 0., 0., 0.], [0., 1., 0., 0.], [0., 0., 1., 0.], [0., 0., 0., 1.]]);

    pub(crate) fn of(affine: &Affine3A) -> Self {
        let (m, t) = (affine.matrix3.to_cols_array_2d(), affine.translation.to_array());
        let row = |r: usize| [m[0][r], m[1][r], m[2][r], t[r]].map(f64::from);
        Self([row(0), row(1), row(2), [0., 0., 0., 1.]])
    }

    pub(crate) fn times(&self, right: &Self) -> Self {
        let element = |r: usize, c: usize| (0..4).map(|k| self.0[r][k] * right.0[k][c]).sum();
        Self(std::array::from_fn(|r| std::array::from_fn(|c| element(r, c))))
    }

    /// Gauss and Jordan, with the largest pivot.
    pub(crate) fn inverse(&self) -> Self {
        let (mut a, mut b) = (self.0, Self::IDENTITY.0);
        for column in 0..4 {
            let pivot =
                (column..4).max_by(|&i, &j| a[i][column].abs().total_cmp(&a[j][column].abs())).unwrap();
            a.swap(column, pivot);
            b.swap(column, pivot);
            let by = a[column][column];
            a[column].iter_mut().chain(&mut b[column]).for_each(|x| *x /= by);
            for row in (0..4).filter(|&row| row != column) {
                let factor = a[row][column];
                for k in 0..4 {
                    a[row][k] -= factor * a[column][k];
                    b[row][k] -= factor * b[column][k];
                }
            }
        }
        Self(b)
    }
}

pub(crate) fn translation([x, y, z]: [f64; 3]) -> M {
    M([[1., 0., 0., x], [0., 1., 0., y], [0., 0., 1., z], [0., 0., 0., 1.]])
}

/// Rodrigues' formula: R = cos·1 + sin·[k]× + (1 − cos)·k kᵀ.
pub(crate) fn rotation(axis: [f64; 3], angle: f64) -> M {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [x, y, z] = axis.map(|component| component / length);
    let (sin, cos) = angle.sin_cos();
    let c = 1.0 - cos;
    M([
        [cos + c * x * x, c * x * y - sin * z, c * x * z + sin * y, 0.],
        [c * y * x + sin * z, cos + c * y * y, c * y * z - sin * x, 0.],
        [c * z * x - sin * y, c * z * y + sin * x, cos + c * z * z, 0.],
        [0., 0., 0., 1.],
    ])
}

/// The largest difference of any element, relative to the largest element (at least 1).
pub(crate) fn relative_difference(found: &Affine3A, expected: &M) -> f64 {
    let found = M::of(found);
    let pairs = || found.0.iter().flatten().zip(expected.0.iter().flatten());
    let scale = pairs().fold(1.0f64, |most, (_, e)| most.max(e.abs()));
    pairs().fold(0.0f64, |most, (f, e)| {
        let difference = (f - e).abs() / scale;
        // `max` alone would lose NaN.
        if difference.is_nan() { f64::INFINITY } else { most.max(difference) }
    })
}
