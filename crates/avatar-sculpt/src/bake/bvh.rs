//! Which ray meets a mesh: a tree of boxes over triangles, halved at the median of its longest side.

use glam::DVec3;

/// Triangles per leaf.
const LEAF: usize = 4;

#[derive(Clone, Copy, Debug)]
struct Branch {
    low: DVec3,
    high: DVec3,
    /// First triangle of a leaf, or the second child of an inner branch; the first child is the next branch.
    at: usize,
    /// Triangles of a leaf; 0 marks an inner branch.
    count: usize,
}

/// A tree over triangles.
#[derive(Clone, Debug)]
pub struct Bvh {
    triangles: Vec<[DVec3; 3]>,
    branches: Vec<Branch>,
}

impl Bvh {
    /// Builds the tree. The order of equal triangles is that of the list: no chance decides anything.
    #[must_use]
    pub fn new(mut triangles: Vec<[DVec3; 3]>) -> Self {
        let mut branches = Vec::new();
        let count = triangles.len();
        grow(&mut triangles, 0, count, &mut branches);
        Self { triangles, branches }
    }

    /// Distance to the nearest triangle along a ray (unit direction), if there is one nearer than `reach`.
    #[must_use]
    pub fn nearest(&self, from: DVec3, direction: DVec3, reach: f64) -> Option<f64> {
        let inverse = direction.recip();
        let mut best = reach;
        let mut stack = [0; 64];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let number = stack[height];
            let Some(branch) = self.branches.get(number) else { continue };
            let (a, b) = ((branch.low - from) * inverse, (branch.high - from) * inverse);
            let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
            if leave < enter.max(0.0) || enter > best {
                continue;
            }
            if branch.count == 0 {
                stack[height] = branch.at;
                stack[height + 1] = number + 1;
                height += 2;
                continue;
            }
            for t in &self.triangles[branch.at..branch.at + branch.count] {
                if let Some(s) = hit(from, direction, t) {
                    best = best.min(s);
                }
            }
        }
        (best < reach).then_some(best)
    }
}

fn grow(triangles: &mut [[DVec3; 3]], first: usize, end: usize, branches: &mut Vec<Branch>) {
    let mut low = DVec3::INFINITY;
    let mut high = DVec3::NEG_INFINITY;
    for p in triangles[first..end].iter().flatten() {
        (low, high) = (low.min(*p), high.max(*p));
    }
    let number = branches.len();
    // A hair of room: rays along an axis would divide 0 by 0 on flat boxes.
    let room = DVec3::splat(1e-9);
    branches.push(Branch { low: low - room, high: high + room, at: first, count: end - first });
    if end - first <= LEAF {
        return;
    }
    let side = (high - low).to_array();
    let axis = if side[0] >= side[1] && side[0] >= side[2] { 0 } else { 1 + usize::from(side[2] > side[1]) };
    let middle = |t: &[DVec3; 3]| t[0][axis] + t[1][axis] + t[2][axis];
    triangles[first..end].sort_by(|a, b| middle(a).total_cmp(&middle(b)));
    let half = usize::midpoint(first, end);
    grow(triangles, first, half, branches);
    let second = branches.len();
    grow(triangles, half, end, branches);
    branches[number].at = second;
    branches[number].count = 0;
}

/// Möller and Trumbore's test, from either side.
fn hit(from: DVec3, direction: DVec3, t: &[DVec3; 3]) -> Option<f64> {
    let (e1, e2) = (t[1] - t[0], t[2] - t[0]);
    let cross = direction.cross(e2);
    let det = e1.dot(cross);
    if det.abs() < 1e-14 {
        return None;
    }
    let rel = from - t[0];
    let u = rel.dot(cross) / det;
    let q = rel.cross(e1);
    let v = direction.dot(q) / det;
    let s = e2.dot(q) / det;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && s > 1e-9).then_some(s)
}
