use glam::{Vec2, Vec3};

/// A triangle has at most 4 to this power.
const MAX_LEVEL: u32 = 9;

/// A triangle, cut into 4^level alike ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pieces {
    level: u32,
}

/// One of them: barycentric coordinates of its corners in the whole triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) corners: [Vec3; 3],
}

impl Pieces {
    /// Pieces about as large as the values of a map of this size.
    pub(crate) fn of([a, b, c]: [Vec2; 3], size: Vec2) -> Self {
        let longest =
            [b - a, c - b, a - c].map(|edge| (edge * size).length()).into_iter().fold(0.0, f32::max);
        let level = longest.log2().ceil().clamp(1.0, MAX_LEVEL as f32) as u32;
        Self { level }
    }

    /// Coarser pieces: the number of pieces along an edge is halved this many times.
    pub(crate) fn coarser(self, times: u32) -> Self {
        Self { level: self.level.saturating_sub(times) }
    }

    pub(crate) fn count(self) -> u64 {
        1 << (2 * self.level)
    }

    /// Visits all pieces, mostly each after a neighbour, so that even steps along this order are spread
    /// evenly over the triangle (K. Basu and A. Owen, "Low discrepancy constructions in the
    /// triangle", 2015).
    pub(crate) fn visit(self, seen: &mut impl FnMut(Piece)) {
        visit(Piece { corners: [Vec3::X, Vec3::Y, Vec3::Z] }, self.level, seen);
    }
}

fn visit(piece: Piece, level: u32, seen: &mut impl FnMut(Piece)) {
    if level == 0 {
        return seen(piece);
    }
    let [a, b, c] = piece.corners;
    // Halves of halves: exact.
    let (ab, bc, ca) = ((a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5);
    for corners in [[a, ab, ca], [bc, ca, ab], [ab, b, bc], [ca, bc, c]] {
        visit(Piece { corners }, level - 1, seen);
    }
}

impl Piece {
    pub(crate) fn middle(self) -> Vec3 {
        (self.corners[0] + self.corners[1] + self.corners[2]) / 3.0
    }

    /// A place in it, evenly for even `a` and `b` from 0 to 1: the root spreads what would crowd at a corner
    /// (G. Turk, Graphics Gems, 1990).
    pub(crate) fn place(self, a: f32, b: f32) -> Vec3 {
        let root = a.sqrt();
        self.corners[0] * (1.0 - root) + self.corners[1] * (root * (1.0 - b)) + self.corners[2] * (root * b)
    }
}

/// The sum of three places by barycentric weights.
pub(crate) fn weighted(uvs: [Vec2; 3], weights: Vec3) -> Vec2 {
    uvs[0] * weights.x + uvs[1] * weights.y + uvs[2] * weights.z
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(values: f32) -> Vec<Piece> {
        let mut all = Vec::new();
        let pieces = Pieces::of([Vec2::ZERO, Vec2::X, Vec2::Y], Vec2::splat(values));
        pieces.visit(&mut |piece| all.push(piece));
        assert_eq!(all.len() as u64, pieces.count());
        all
    }

    #[test]
    fn pieces_are_as_large_as_values_and_cover_the_triangle() {
        for (values, count) in [(0.0, 4), (1.0, 4), (2.5, 16), (20.0, 1024), (1e9, 1 << 18), (f32::NAN, 4)] {
            let pieces = pieces(values);
            assert_eq!(pieces.len(), count, "{values}");
            let area = |piece: &Piece| {
                let [a, b, c] =
                    piece.corners.map(|corner| glam::DVec2::new(corner.y.into(), corner.z.into()));
                (b - a).perp_dot(c - a)
            };
            // All turn alike, so that they lie side by side if their areas come to the whole.
            assert!(pieces.iter().all(|piece| area(piece) == 1.0 / count as f64), "{values}");
            let mean: Vec3 = pieces.iter().map(|piece| piece.middle()).sum::<Vec3>() / count as f32;
            assert!(mean.distance(Vec3::splat(1.0 / 3.0)) < 1e-3);
            assert!(pieces.iter().all(|piece| piece.middle().min_element() > 0.0));
        }
        let halved = Pieces::of([Vec2::ZERO, Vec2::X, Vec2::Y], Vec2::splat(20.0));
        assert_eq!((halved.coarser(2).count(), halved.coarser(99).count()), (64, 1));
    }

    #[test]
    fn the_way_leads_from_neighbour_to_neighbour() {
        let pieces = pieces(30.0);
        let touching = |a: &Piece, b: &Piece| a.corners.iter().any(|corner| b.corners.contains(corner));
        let jumps = pieces.windows(2).filter(|pair| !touching(&pair[0], &pair[1])).count();
        assert!(jumps * 5 < pieces.len(), "{jumps} of {}", pieces.len());
    }
}
