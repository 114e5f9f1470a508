use glam::{Vec2, Vec3};

/// Polygons of more corners are cut into fans: looking for ears takes time that grows with the square.
const MAX_EAR_CORNERS: usize = 256;

/// Cuts a polygon into triangles: concave ones, too, by cutting off ears; one without area into a fan. Corners are
/// positions in `points`, and the direction around stays.
pub(super) fn triangulate(points: &[Vec3]) -> Vec<[usize; 3]> {
    let fan = |corners: usize| (2..corners).map(|k| [0, k - 1, k]).collect();
    let normal = newell(points);
    if points.len() <= 3 || points.len() > MAX_EAR_CORNERS || normal == Vec3::ZERO || !normal.is_finite() {
        return fan(points.len());
    }
    let flat = project(points, normal);
    let mut left: Vec<usize> = (0..points.len()).collect();
    let mut triangles = Vec::with_capacity(points.len() - 2);
    while left.len() > 3 {
        let count = left.len();
        let corner = |k: usize| [left[(k + count - 1) % count], left[k], left[(k + 1) % count]];
        // From the second on, so that convex polygons become fans around their first corner.
        let ear = (1..=count).map(|k| k % count).find(|k| is_ear(corner(*k), &left, &flat));
        // Polygons that cross themselves may have none.
        let ear = ear.unwrap_or(1);
        triangles.push(corner(ear));
        left.remove(ear);
    }
    triangles.extend(<[usize; 3]>::try_from(left).ok());
    triangles
}

/// Twice the area along the normal, summed over the corners.
fn newell(points: &[Vec3]) -> Vec3 {
    let next = points.iter().cycle().skip(1);
    let first = points.first().copied().unwrap_or_default();
    points.iter().zip(next).map(|(a, b)| (*a - first).cross(*b - first)).sum()
}

/// Drops the coordinate in which the polygon is thinnest; counter-clockwise stays so.
fn project(points: &[Vec3], normal: Vec3) -> Vec<Vec2> {
    let [x, y, z] = normal.abs().to_array();
    let flat = |p: &Vec3| match (x >= y && x >= z, y >= z) {
        (true, _) => Vec2::new(p.y, p.z) * Vec2::new(normal.x.signum(), 1.0),
        (_, true) => Vec2::new(p.z, p.x) * Vec2::new(normal.y.signum(), 1.0),
        _ => Vec2::new(p.x, p.y) * Vec2::new(normal.z.signum(), 1.0),
    };
    points.iter().map(flat).collect()
}

fn is_ear(corners: [usize; 3], left: &[usize], flat: &[Vec2]) -> bool {
    let [a, b, c] = corners.map(|corner| flat[corner]);
    let side = |a: Vec2, b: Vec2, p: Vec2| (b - a).perp_dot(p - a);
    let convex = side(a, b, c) > 0.0;
    let inside = |p: Vec2| side(a, b, p) >= 0.0 && side(b, c, p) >= 0.0 && side(c, a, p) >= 0.0;
    // A corner in the same place as one of the ear's, as polygons with bridges to holes have, is not in the way.
    let in_the_way = |other: &&usize| {
        let p = flat[**other];
        !corners.contains(*other) && p != a && p != b && p != c && inside(p)
    };
    convex && !left.iter().any(|other| in_the_way(&other))
}
