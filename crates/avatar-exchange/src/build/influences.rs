use avatar_mesh::{Skinning, WEIGHT_SUM_TOLERANCE};

/// Four bones of one point or vertex and their weights; unused slots have bone 0 and weight 0.
pub(crate) type Four = ([u16; 4], [f32; 4]);

const NONE: Four = ([0; 4], [0.0; 4]);

/// How many bones a point keeps.
const MOST: usize = 8;

/// Bones and weights of points or vertices, eight at most.
#[derive(Debug, Default)]
pub(crate) struct Influences {
    of_point: Vec<Four>,
    /// The fifth to eighth bone; empty as long as no point has more than four.
    further: Vec<Four>,
    /// Points that had more than eight bones.
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

    /// Adds a point: the eight largest of its weights, divided by their sum unless that is 1 already. Weights
    /// that are not above 0 or not finite do not count. A point without any follows `otherwise`. Sorts
    /// `bones` by weight where there are more than four, so that programs that know only four have the
    /// largest.
    pub(crate) fn push(&mut self, bones: &mut [(u16, f64)], otherwise: u16) {
        let counts = |weight: f64| weight > 0.0 && weight.is_finite();
        if bones.len() > 4 {
            // Stable, so that among equals the file's order counts. What does not count comes last.
            let size = |weight: f64| if counts(weight) { weight } else { 0.0 };
            bones.sort_by(|a, b| size(b.1).total_cmp(&size(a.1)));
            self.reduced += usize::from(bones.get(MOST).is_some_and(|(_, weight)| counts(*weight)));
        }
        let kept = || bones.iter().take(MOST).enumerate().filter(|(_, (_, weight))| counts(*weight));
        let sum: f64 = kept().map(|(_, (_, weight))| weight).sum();
        let scale = if (sum - 1.0).abs() > WEIGHT_SUM_TOLERANCE { 1.0 / sum } else { 1.0 };
        let (mut first, mut further) = (NONE, NONE);
        if sum > 0.0 && sum.is_finite() && scale.is_finite() {
            for (slot, (bone, weight)) in kept() {
                let four = if slot < 4 { &mut first } else { &mut further };
                (four.0[slot % 4], four.1[slot % 4]) = (*bone, (weight * scale) as f32);
            }
        } else {
            self.unweighted += 1;
            (first.0[0], first.1[0]) = (otherwise, 1.0);
        }
        if further != NONE || !self.further.is_empty() {
            self.further.resize(self.of_point.len(), NONE);
            self.further.push(further);
        }
        self.of_point.push(first);
    }

    /// What a note says of points that had more bones than are kept; `what` names the points.
    pub(crate) fn note(&self, what: &str) -> Option<String> {
        let text =
            || format!("{} {what} have more than eight bones: the eight largest are kept", self.reduced);
        (self.reduced > 0).then(text)
    }

    /// The skinning of vertices, each of which is one of the points. Points that were not added follow bone
    /// 0.
    #[cfg(any(feature = "collada", feature = "fbx"))]
    pub(crate) fn of_points(&self, points: impl Iterator<Item = usize> + Clone) -> Skinning {
        const FIRST: Four = ([0; 4], [1.0, 0.0, 0.0, 0.0]);
        let first = points.clone().map(|point| self.of_point.get(point).copied().unwrap_or(FIRST));
        let further = |point: usize| self.further.get(point).copied().unwrap_or(NONE);
        let has_further = points.clone().any(|point| further(point) != NONE);
        skinning(first, points.filter(|_| has_further).map(further))
    }

    /// The skinning where points are vertices.
    #[cfg(any(feature = "gltf", feature = "md5"))]
    pub(crate) fn into_skinning(self) -> Skinning {
        skinning(self.of_point.into_iter(), self.further.into_iter())
    }
}

fn skinning(first: impl Iterator<Item = Four>, further: impl Iterator<Item = Four>) -> Skinning {
    let ((bones, weights), (more_bones, more_weights)) = (first.unzip(), further.unzip());
    Skinning { bones, weights, more_bones, more_weights, blend_index: Vec::new() }
}
