//! Polygons to triangles.

use glam::{DVec2, DVec3, Vec3};
use std::collections::BTreeSet;

/// Comparisons of a corner with an ear that all polygons of a file may take together: a second or so. What
/// hand and exporter make takes a few for each corner; a file made to be slow could take the square of its
/// size.
const MAX_COMPARISONS: u64 = 1 << 28;

/// Cuts the polygons of one file.
#[derive(Debug)]
pub(crate) struct Cutter {
    comparisons_left: u64,
    /// Polygons that cross themselves: some of their triangles overlap.
    pub(crate) crossing: usize,
    /// Polygons that were too intricate: their triangles are a fan, and may overlap.
    pub(crate) fans: usize,
}

impl Default for Cutter {
    fn default() -> Self {
        Self { comparisons_left: MAX_COMPARISONS, crossing: 0, fans: 0 }
    }
}

impl Cutter {
    /// Cuts a polygon into triangles, whose corners are positions in `points`; the direction around stays. A
    /// polygon whose fan around the first corner covers it becomes that fan; of others, ears are cut off (D.
    /// Eberly, *Triangulation by Ear Clipping*, 2002), always the first one there is. A polygon without area
    /// becomes a fan.
    pub(crate) fn cut(&mut self, points: &[Vec3]) -> Vec<[usize; 3]> {
        if points.len() <= 3 || is_fan(points) {
            return fan(points.len());
        }
        let mut ring = Ring::new(points);
        match ring.cut(&mut self.comparisons_left) {
            Some((triangles, crosses)) => {
                self.crossing += usize::from(crosses);
                triangles
            }
            None => {
                self.fans += 1;
                fan(points.len())
            }
        }
    }

    /// What users should know about the polygons so far: whether triangles overlap, and why.
    pub(crate) fn findings(&self) -> impl Iterator<Item = String> {
        let text = |count: usize, what: &str| (count > 0).then(|| format!("{count} polygons {what}"));
        let crossing = text(self.crossing, "cross themselves: some of their triangles overlap");
        let fans = text(self.fans, "are too intricate: they are cut into fans, whose triangles may overlap");
        crossing.into_iter().chain(fans)
    }
}

fn fan(corners: usize) -> Vec<[usize; 3]> {
    (2..corners).map(|k| [0, k - 1, k]).collect()
}

/// Whether the triangles around the first corner all face as the polygon does, to within rounding: convex
/// polygons and many others. True without area.
fn is_fan(points: &[Vec3]) -> bool {
    let Some((first, rest)) = points.split_first() else { return true };
    let origin = first.as_dvec3();
    let side = |pair: &[Vec3]| (pair[0].as_dvec3() - origin).cross(pair[1].as_dvec3() - origin);
    let crosses = || rest.windows(2).map(side);
    // Their sum is twice the area, along the normal of the polygon (Newell).
    let normal = crosses().sum::<DVec3>().normalize_or_zero();
    crosses().all(|cross| cross.dot(normal) >= -1e-6 * cross.length())
}

/// The corners that are left, each with its neighbours.
struct Ring {
    flat: Vec<DVec2>,
    next: Vec<usize>,
    last: Vec<usize>,
    /// Corners that are not convex. A convex corner is an ear unless one of these lies in its triangle.
    reflex: BTreeSet<usize>,
    left: BTreeSet<usize>,
}

impl Ring {
    fn new(points: &[Vec3]) -> Self {
        let count = points.len();
        let flat = project(points);
        let next = (0..count).map(|k| (k + 1) % count).collect();
        let last = (0..count).map(|k| (k + count - 1) % count).collect();
        let mut ring = Self { flat, next, last, reflex: BTreeSet::new(), left: (0..count).collect() };
        ring.reflex = (0..count).filter(|corner| ring.area(*corner) <= 0.0).collect();
        ring
    }

    /// Triangles, and whether the polygon crosses itself; `None` where it takes too many comparisons.
    fn cut(&mut self, comparisons_left: &mut u64) -> Option<(Vec<[usize; 3]>, bool)> {
        let mut ears = BTreeSet::new();
        for corner in 0..self.flat.len() {
            if self.is_ear(corner, comparisons_left)? {
                ears.insert(corner);
            }
        }
        let mut triangles = Vec::with_capacity(self.flat.len() - 2);
        // Twice the area of all triangles, and of those that face the other way than the polygon.
        let (mut all, mut turned) = (0.0, 0.0);
        let mut add = |area: f64| {
            all += area.abs();
            turned += (-area).max(0.0);
        };
        while self.left.len() > 3 {
            let first = *self.left.first()?;
            // From the second corner on, so that triangles lie around the first one where they can.
            let ear = ears.range(first + 1..).next().or(ears.get(&first)).copied();
            // Only corners in one line, or a polygon that crosses itself, have none.
            let ear = ear.unwrap_or(self.next[first]);
            add(self.area(ear));
            let (last, next) = (self.last[ear], self.next[ear]);
            triangles.push([last, ear, next]);
            self.left.remove(&ear);
            self.reflex.remove(&ear);
            ears.remove(&ear);
            (self.next[last], self.last[next]) = (next, last);
            // A cut only changes its two neighbours: any other corner that was not an ear still has a reflex
            // corner in its triangle.
            for corner in [last, next] {
                if self.area(corner) > 0.0 {
                    self.reflex.remove(&corner);
                } else {
                    self.reflex.insert(corner);
                }
                if self.is_ear(corner, comparisons_left)? {
                    ears.insert(corner);
                } else {
                    ears.remove(&corner);
                }
            }
        }
        if let Some(&first) = self.left.first() {
            let second = self.next[first];
            add(self.area(second));
            triangles.push([first, second, self.next[second]]);
        }
        Some((triangles, turned > 1e-6 * all))
    }

    /// Twice the area of the triangle at a corner; negative where the corner is reflex.
    fn area(&self, corner: usize) -> f64 {
        side(self.flat[self.last[corner]], self.flat[corner], self.flat[self.next[corner]])
    }

    fn is_ear(&self, corner: usize, comparisons_left: &mut u64) -> Option<bool> {
        if self.area(corner) <= 0.0 {
            return Some(false);
        }
        let corners = [self.last[corner], corner, self.next[corner]];
        let [a, b, c] = corners.map(|corner| self.flat[corner]);
        for &other in &self.reflex {
            *comparisons_left = comparisons_left.checked_sub(1)?;
            let p = self.flat[other];
            // A corner in the same place as one of the ear's, as polygons with bridges to holes have, is not
            // in the way.
            let apart = !corners.contains(&other) && p != a && p != b && p != c;
            if apart && side(a, b, p) >= 0.0 && side(b, c, p) >= 0.0 && side(c, a, p) >= 0.0 {
                return Some(false);
            }
        }
        Some(true)
    }
}

/// Twice the area of a triangle: positive where it runs counter-clockwise.
fn side(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Drops the coordinate in which the polygon is thinnest; a polygon seen from its front runs
/// counter-clockwise.
fn project(points: &[Vec3]) -> Vec<DVec2> {
    let origin = points.first().copied().unwrap_or_default().as_dvec3();
    let from = |point: &Vec3| point.as_dvec3() - origin;
    let normal: DVec3 = points.windows(2).map(|pair| from(&pair[0]).cross(from(&pair[1]))).sum();
    let [x, y, z] = normal.abs().to_array();
    let flat = |p: DVec3| match (x >= y && x >= z, y >= z) {
        (true, _) => DVec2::new(p.y * normal.x.signum(), p.z),
        (_, true) => DVec2::new(p.z * normal.y.signum(), p.x),
        _ => DVec2::new(p.x * normal.z.signum(), p.y),
    };
    points.iter().map(|point| flat(from(point))).collect()
}

#[cfg(test)]
mod tests {
    use super::{Cutter, MAX_COMPARISONS, fan};
    use glam::Vec3;

    /// Twice the area of all triangles along +Z, and whether each has area and faces there.
    fn covered(points: &[Vec3], triangles: &[[usize; 3]]) -> (f64, bool) {
        let area = |corners: &[usize; 3]| {
            let [a, b, c] = corners.map(|corner| points[corner].as_dvec3());
            (b - a).cross(c - a).z
        };
        (triangles.iter().map(area).sum(), triangles.iter().all(|corners| area(corners) > 0.0))
    }

    fn area(points: &[Vec3]) -> f64 {
        let next = points.iter().cycle().skip(1);
        points.iter().zip(next).map(|(a, b)| a.as_dvec3().cross(b.as_dvec3()).z).sum()
    }

    /// A comb: every tooth needs an ear, no fan covers it.
    fn comb(teeth: usize) -> Vec<Vec3> {
        let along = |k: usize, y: f32| Vec3::new(k as f32, y, 0.0);
        let top = (0..=2 * teeth).rev().map(|k| along(k, if k % 2 == 0 { 1.0 } else { 9.0 }));
        [along(0, 0.0), along(2 * teeth, 0.0)].into_iter().chain(top).collect()
    }

    #[test]
    fn concave_polygons_of_any_size_are_covered_once() {
        for teeth in [1, 2, 7, 100, 2000] {
            let points = comb(teeth);
            let mut cutter = Cutter::default();
            let triangles = cutter.cut(&points);
            assert_eq!((triangles.len(), cutter.crossing, cutter.fans), (points.len() - 2, 0, 0), "{teeth}");
            let (sum, all_face) = covered(&points, &triangles);
            assert!(all_face && (sum - area(&points)).abs() < 1e-6 * sum, "{teeth}: {sum}");
        }
    }

    #[test]
    fn comparisons_grow_with_corners_times_reflex_corners() {
        let mut cutter = Cutter::default();
        let points = comb(1000);
        cutter.cut(&points);
        let spent = MAX_COMPARISONS - cutter.comparisons_left;
        assert!(spent < 3 * (points.len() as u64) * 1000, "{spent}");
    }

    #[test]
    fn what_takes_too_long_is_told() {
        let mut cutter = Cutter { comparisons_left: 100, ..Cutter::default() };
        let points = comb(100);
        assert_eq!(cutter.cut(&points), fan(points.len()));
        assert_eq!((cutter.fans, cutter.findings().count()), (1, 1));
    }

    #[test]
    fn polygons_that_cross_themselves_are_told() {
        let mut cutter = Cutter::default();
        let points = [(0.0, 0.0), (4.0, 3.0), (4.0, 0.0), (0.0, 3.0), (-2.0, 5.0)];
        let points = points.map(|(x, y)| Vec3::new(x, y, 0.0));
        assert_eq!(cutter.cut(&points).len(), 3);
        assert_eq!((cutter.crossing, cutter.fans), (1, 0));
    }

    #[test]
    fn corners_in_one_line_and_bridges_to_holes_do_not_cross() {
        let mut cutter = Cutter::default();
        let square = [(0, 0), (2, 0), (4, 0), (4, 4), (2, 1), (0, 4)];
        let points = square.map(|(x, y)| Vec3::new(x as f32, y as f32, 0.0));
        let triangles = cutter.cut(&points);
        assert_eq!(covered(&points, &triangles).0, area(&points));
        // A square hole in a square, joined by an edge there and back.
        let ring = [(0, 0), (6, 0), (6, 6), (0, 6), (0, 0), (2, 2), (2, 4), (4, 4), (4, 2), (2, 2)];
        let points = ring.map(|(x, y)| Vec3::new(x as f32, y as f32, 0.0));
        let triangles = cutter.cut(&points);
        assert_eq!((covered(&points, &triangles).0, cutter.crossing), (2.0 * (36.0 - 4.0), 0));
    }
}
