//! How far points are from a mesh, exactly: a tree of boxes over its triangles.

use glam::{Mat2, Vec2, Vec3};

pub(crate) struct Nearest<'a> {
    positions: &'a [Vec3],
    triangles: Vec<[u32; 3]>,
    nodes: Vec<Node>,
}

struct Node {
    min: Vec3,
    max: Vec3,
    /// Triangles of a leaf, else the two children.
    first: usize,
    count: usize,
}

const LEAF: usize = 6;

impl<'a> Nearest<'a> {
    pub(crate) fn new(positions: &'a [Vec3], triangles: &[[u32; 3]]) -> Self {
        let mut tree = Self { positions, triangles: triangles.to_vec(), nodes: Vec::new() };
        tree.nodes.push(Node { min: Vec3::ZERO, max: Vec3::ZERO, first: 0, count: 0 });
        tree.split(0, 0, triangles.len());
        tree
    }

    fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|i| self.positions[i as usize])
    }

    fn split(&mut self, node: usize, from: usize, to: usize) {
        let mut min = Vec3::INFINITY;
        let mut max = Vec3::NEG_INFINITY;
        for triangle in from..to {
            for p in self.corners(triangle) {
                (min, max) = (min.min(p), max.max(p));
            }
        }
        self.nodes[node] = Node { min, max, first: from, count: to - from };
        if to - from <= LEAF {
            return;
        }
        let size = max - min;
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let positions = self.positions;
        let middle = |t: &[u32; 3]| t.iter().map(|i| positions[*i as usize][axis]).sum::<f32>();
        self.triangles[from..to].sort_by(|a, b| middle(a).total_cmp(&middle(b)));
        let children = self.nodes.len();
        let empty = || Node { min: Vec3::ZERO, max: Vec3::ZERO, first: 0, count: 0 };
        self.nodes.extend([empty(), empty()]);
        self.nodes[node].first = children;
        self.nodes[node].count = 0;
        let half = from + (to - from) / 2;
        self.split(children, from, half);
        self.split(children + 1, half, to);
    }

    /// How deep a point is inside, 0 outside. Two rays that both cross the mesh an odd number of times say
    /// inside; they go up, because heads are open below.
    pub(crate) fn depth(&self, p: Vec3) -> f32 {
        let rays = [Vec3::new(0.013, 1.0, 0.007), Vec3::new(-0.21, 1.0, -0.17)];
        if rays.iter().any(|ray| self.crossings(0, p, *ray).is_multiple_of(2)) {
            return 0.0;
        }
        let mut best = f32::INFINITY;
        self.visit(0, p, &mut best);
        best.sqrt()
    }

    fn crossings(&self, node: usize, p: Vec3, ray: Vec3) -> usize {
        let Node { min, max, first, count } = self.nodes[node];
        let (a, b) = ((min - p) / ray, (max - p) / ray);
        let (enters, leaves) = (a.min(b).max_element(), a.max(b).min_element());
        if leaves < enters.max(0.0) {
            return 0;
        }
        let crosses = |triangle: usize| {
            // T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
            let [a, b, c] = self.corners(triangle);
            let (u_edge, v_edge, from) = (b - a, c - a, p - a);
            let across = ray.cross(v_edge);
            let determinant = u_edge.dot(across);
            let u = from.dot(across) / determinant;
            let other = from.cross(u_edge);
            let v = ray.dot(other) / determinant;
            u >= 0.0 && v >= 0.0 && u + v <= 1.0 && v_edge.dot(other) / determinant > 0.0
        };
        match count {
            0 => self.crossings(first, p, ray) + self.crossings(first + 1, p, ray),
            _ => (first..first + count).filter(|triangle| crosses(*triangle)).count(),
        }
    }

    fn visit(&self, node: usize, p: Vec3, best: &mut f32) {
        let Node { min, max, first, count } = self.nodes[node];
        if p.clamp(min, max).distance_squared(p) >= *best {
            return;
        }
        for triangle in first..first + count {
            let corners = self.corners(triangle);
            let weights = nearest_weights(p, corners);
            let point: Vec3 = (0..3).map(|i| corners[i] * weights[i]).sum();
            *best = best.min(point.distance_squared(p));
        }
        if count == 0 {
            let gap =
                |child: usize| p.clamp(self.nodes[child].min, self.nodes[child].max).distance_squared(p);
            let order = if gap(first) <= gap(first + 1) { [first, first + 1] } else { [first + 1, first] };
            order.into_iter().for_each(|child| self.visit(child, p, best));
        }
    }
}

/// By the plane's own coordinates, then the edges: slower and simpler than the usual case by case.
fn nearest_weights(p: Vec3, [a, b, c]: [Vec3; 3]) -> [f32; 3] {
    let (u, v) = (b - a, c - a);
    let gram = Mat2::from_cols(Vec2::new(u.dot(u), u.dot(v)), Vec2::new(u.dot(v), v.dot(v)));
    if gram.determinant() > 0.0 {
        let w = gram.inverse() * Vec2::new((p - a).dot(u), (p - a).dot(v));
        if w.x >= 0.0 && w.y >= 0.0 && w.x + w.y <= 1.0 {
            return [1.0 - w.x - w.y, w.x, w.y];
        }
    }
    let on_edge = |from: Vec3, to: Vec3| {
        let d = to - from;
        let t = ((p - from).dot(d) / d.dot(d).max(1e-30)).clamp(0.0, 1.0);
        (t, (from + d * t).distance_squared(p))
    };
    let (ab, bc, ca) = (on_edge(a, b), on_edge(b, c), on_edge(c, a));
    if ab.1 <= bc.1 && ab.1 <= ca.1 {
        [1.0 - ab.0, ab.0, 0.0]
    } else if bc.1 <= ca.1 {
        [0.0, 1.0 - bc.0, bc.0]
    } else {
        [ca.0, 0.0, 1.0 - ca.0]
    }
}
