use glam::Vec3;

/// Which bones move a vertex, and how much: up to eight for each. The arrays are as long as the mesh has
/// vertices, but for those that may be empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skinning {
    /// Four positions in the palette of bone matrices.
    pub bones: Vec<[u16; 4]>,
    /// Their weights; with [`Skinning::more_weights`], the sum is 1.
    pub weights: Vec<[f32; 4]>,
    /// The fifth to eighth bone of each vertex; empty where no vertex has more than four.
    pub more_bones: Vec<[u16; 4]>,
    /// Their weights; as long as [`Skinning::more_bones`].
    pub more_weights: Vec<[f32; 4]>,
    /// A column of the raw format without a known meaning, kept for writing it back; may be empty.
    pub blend_index: Vec<Vec3>,
}

impl Skinning {
    /// The bones of a vertex and their weights, four or eight, those of weight 0 as well; none for a vertex
    /// that does not exist.
    pub fn influences(&self, vertex: usize) -> impl Iterator<Item = (u16, f32)> + Clone + use<> {
        let four = |bones: &[[u16; 4]], weights: &[[f32; 4]]| {
            let four = bones.get(vertex).copied().zip(weights.get(vertex).copied());
            four.into_iter().flat_map(|(bones, weights)| bones.into_iter().zip(weights))
        };
        four(&self.bones, &self.weights).chain(four(&self.more_bones, &self.more_weights))
    }

    /// The bones that have a weight other than 0 at any vertex, ascending, each once.
    pub fn used_bones(&self) -> Vec<u16> {
        let mut is_used = Vec::new();
        let sets = [(&self.bones, &self.weights), (&self.more_bones, &self.more_weights)];
        for (bones, weights) in sets {
            for (bone, weight) in bones.as_flattened().iter().zip(weights.as_flattened()) {
                if *weight != 0.0 {
                    let bone = usize::from(*bone);
                    if bone >= is_used.len() {
                        is_used.resize(bone + 1, false);
                    }
                    is_used[bone] = true;
                }
            }
        }
        (0..=u16::MAX).zip(is_used).filter(|(_, used)| *used).map(|(bone, _)| bone).collect()
    }

    /// For what holds only four bones a vertex: the four of the largest weights, divided by their sum. A
    /// vertex that has no more than four keeps its numbers to the bit.
    pub fn largest_four(&self, vertex: usize) -> ([u16; 4], [f32; 4]) {
        let first = self.bones.get(vertex).copied().unwrap_or_default();
        let first = (first, self.weights.get(vertex).copied().unwrap_or_default());
        if !self.has_more_than_four(vertex) {
            return first;
        }
        let mut all: Vec<(u16, f32)> = self.influences(vertex).collect();
        // Stable: among equals the first.
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        all.truncate(4);
        let sum: f64 = all.iter().map(|(_, weight)| f64::from(*weight)).sum();
        let (mut bones, mut weights) = ([0; 4], [0.0; 4]);
        for (slot, (bone, weight)) in all.into_iter().enumerate() {
            (bones[slot], weights[slot]) = (bone, (f64::from(weight) / sum) as f32);
        }
        if weights.iter().all(|weight| weight.is_finite()) { (bones, weights) } else { first }
    }

    /// Whether more than the first four bones of a vertex move it.
    pub fn has_more_than_four(&self, vertex: usize) -> bool {
        self.more_weights.get(vertex).is_some_and(|weights| weights.iter().any(|weight| *weight != 0.0))
    }
}
