#[cfg(any(feature = "gltf", feature = "md5"))]
use avatar_mesh::Skinning;
use avatar_mesh::WEIGHT_SUM_TOLERANCE;

/// Bones of one point or vertex and their weights; unused slots have bone 0 and weight 0.
pub(crate) type Four = ([u16; 4], [f32; 4]);

/// Bones and weights of points or vertices, four at most.
#[derive(Debug, Default)]
pub(crate) struct Influences {
    of_point: Vec<Four>,
    /// Points that had more than four bones.
    pub(crate) reduced: usize,
    /// Points without any weight.
    pub(crate) unweighted: usize,
}

impl Influences {
    /// Room for so many points.
    #[cfg(feature = "gltf")]
    pub(crate) fn with_capacity(points: usize) -> Self {
        Self { of_point: Vec::with_capacity(points), ..Self::default() }
    }

    /// Adds a point: the four largest of its weights, divided by their sum unless that is 1 already. Weights
    /// that are not above 0 or not finite do not count. A point without any follows `otherwise`. Reorders
    /// `bones` where there are more than four.
    pub(crate) fn push(&mut self, bones: &mut [(u16, f64)], otherwise: u16) {
        let counts = |weight: f64| weight > 0.0 && weight.is_finite();
        if bones.len() > 4 {
            // Stable, so that among equals the file's order counts. What does not count comes last.
            let size = |weight: f64| if counts(weight) { weight } else { 0.0 };
            bones.sort_by(|a, b| size(b.1).total_cmp(&size(a.1)));
            self.reduced += usize::from(counts(bones[4].1));
        }
        let four = || bones.iter().take(4).enumerate().filter(|(_, (_, weight))| counts(*weight));
        let sum: f64 = four().map(|(_, (_, weight))| weight).sum();
        let scale = if (sum - 1.0).abs() > WEIGHT_SUM_TOLERANCE { 1.0 / sum } else { 1.0 };
        let (mut indices, mut weights) = ([0; 4], [0.0; 4]);
        if sum > 0.0 && sum.is_finite() && scale.is_finite() {
            for (slot, (bone, weight)) in four() {
                (indices[slot], weights[slot]) = (*bone, (weight * scale) as f32);
            }
        } else {
            self.unweighted += 1;
            (indices[0], weights[0]) = (otherwise, 1.0);
        }
        self.of_point.push((indices, weights));
    }

    /// The bones of a point; bone 0 for points that were not added.
    #[cfg(any(feature = "collada", feature = "fbx"))]
    pub(crate) fn of(&self, point: usize) -> Four {
        self.of_point.get(point).copied().unwrap_or(([0; 4], [1.0, 0.0, 0.0, 0.0]))
    }

    /// All of them, where points are vertices.
    #[cfg(any(feature = "gltf", feature = "md5"))]
    pub(crate) fn into_skinning(self) -> Skinning {
        let (bones, weights) = self.of_point.into_iter().unzip();
        Skinning { bones, weights, ..Skinning::default() }
    }
}
