//! A smooth map between two heads that takes landmarks to landmarks.

use glam::DVec3;

/// Points of MakeHuman's base mesh (decimetres) and of this head that mean the same. Those beside the midline
/// stand for their mirror images, too.
const LANDMARKS: [(&str, [f64; 3], [f64; 3]); 27] = [
    ("centre of the eye", [0.308, 7.284, 1.245], [3.27, 0.25, 1.447]),
    ("inner corner of the eye", [0.180, 7.267, 1.380], [1.73, 0.05, 2.88]),
    ("outer corner of the eye", [0.466, 7.285, 1.335], [4.91, 0.47, 2.62]),
    ("margin of the upper lid", [0.308, 7.350, 1.435], [3.38, 0.84, 3.38]),
    ("margin of the lower lid", [0.308, 7.204, 1.425], [3.38, -0.31, 3.39]),
    ("brow, inner end", [0.120, 7.450, 1.500], [1.25, 2.22, 4.05]),
    ("brow, peak", [0.337, 7.502, 1.423], [3.90, 2.80, 3.10]),
    ("brow, tail", [0.500, 7.420, 1.310], [5.75, 2.22, 0.90]),
    ("crown", [0.0, 8.491, 0.696], [0.0, 12.3, -5.0]),
    ("hairline", [0.0, 7.919, 1.445], [0.0, 6.6, 3.57]),
    ("between the brows", [0.0, 7.466, 1.524], [0.0, 2.21, 4.19]),
    ("root of the nose", [0.0, 7.323, 1.506], [0.0, 1.26, 4.12]),
    ("tip of the nose", [0.0, 6.925, 1.681], [0.0, -2.75, 5.95]),
    ("wing of the nose", [0.135, 6.860, 1.520], [1.22, -3.10, 4.30]),
    ("below the nose", [0.0, 6.789, 1.563], [0.0, -4.00, 4.45]),
    ("upper border of the red", [0.0, 6.683, 1.602], [0.0, -5.06, 4.57]),
    ("line between the lips", [0.0, 6.604, 1.530], [0.0, -5.67, 4.50]),
    ("lower border of the red", [0.0, 6.489, 1.556], [0.0, -6.60, 4.20]),
    ("corner of the mouth", [0.250, 6.609, 1.418], [2.20, -5.56, 3.62]),
    ("hollow under the lip", [0.0, 6.388, 1.498], [0.0, -7.10, 3.87]),
    ("chin", [0.0, 6.300, 1.495], [0.0, -8.76, 4.42]),
    ("under the chin", [0.0, 6.170, 1.380], [0.0, -9.65, 3.50]),
    ("angle of the jaw", [0.560, 6.550, 0.700], [5.00, -6.00, -3.60]),
    ("cheek", [0.666, 6.874, 0.831], [6.20, -3.10, -2.90]),
    ("tip of the tongue", [0.0, 6.584, 1.394], [0.0, -6.42, 2.80]),
    ("root of the tongue", [0.0, 6.503, 0.629], [0.0, -6.42, -0.90]),
    ("temple", [0.696, 7.295, 0.816], [6.80, 0.30, -3.00]),
];

/// The map: an affine part and a sum over landmarks of their distance times a vector (the thin plate of three
/// dimensions).
pub(super) struct Warp {
    centres: Vec<DVec3>,
    weights: Vec<DVec3>,
    affine: [DVec3; 4],
}

impl Warp {
    pub(super) fn new() -> Self {
        let mut pairs = Vec::new();
        for (_, from, to) in LANDMARKS {
            let (from, to) = (DVec3::from_array(from), DVec3::from_array(to));
            pairs.push((from, to));
            if from.x > 0.0 {
                let flip = DVec3::new(-1.0, 1.0, 1.0);
                pairs.push((from * flip, to * flip));
            }
        }
        let n = pairs.len();
        // Rows: what each landmark must become, then the four side conditions of the thin plate.
        let mut rows = vec![vec![0.0; n + 4 + 3]; n + 4];
        for (i, (from, to)) in pairs.iter().enumerate() {
            for (j, (other, _)) in pairs.iter().enumerate() {
                rows[i][j] = from.distance(*other);
            }
            for (k, x) in [1.0, from.x, from.y, from.z].into_iter().enumerate() {
                rows[i][n + k] = x;
                rows[n + k][i] = x;
            }
            rows[i][n + 4..].copy_from_slice(&to.to_array());
        }
        let solved = solve(rows);
        let at = |i: usize| DVec3::from_array(solved[i]);
        Self {
            centres: pairs.iter().map(|p| p.0).collect(),
            weights: (0..n).map(at).collect(),
            affine: [at(n), at(n + 1), at(n + 2), at(n + 3)],
        }
    }

    /// Where a point of the other head lies on this one.
    pub(super) fn at(&self, p: DVec3) -> DVec3 {
        let [shift, x, y, z] = self.affine;
        let far = self.centres.iter().zip(&self.weights).map(|(c, w)| *w * p.distance(*c)).sum::<DVec3>();
        shift + x * p.x + y * p.y + z * p.z + far
    }
}

/// Solves linear equations with three right sides, by elimination with the largest pivot.
fn solve(mut rows: Vec<Vec<f64>>) -> Vec<[f64; 3]> {
    let n = rows.len();
    for k in 0..n {
        let best = (k..n).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs())).unwrap();
        rows.swap(k, best);
        let pivot = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            let factor = if i == k { 0.0 } else { row[k] / pivot[k] };
            if factor != 0.0 {
                row.iter_mut().zip(&pivot).for_each(|(a, b)| *a -= factor * b);
            }
        }
    }
    (0..n).map(|i| [0, 1, 2].map(|c| rows[i][n + c] / rows[i][i])).collect()
}
