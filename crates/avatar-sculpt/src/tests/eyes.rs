use glam::{DMat3, DVec3};

use super::{deformed, eye, hit, lids, mesh, skin};
use crate::layout;

/// Triangles of the outer skin around an eye: not the socket, whose uv lies in the strip below the face.
fn lid_triangles(side: f64) -> Vec<[usize; 3]> {
    let m = skin();
    let near = |t: &&[usize; 3]| {
        t.iter().all(|&i| {
            m.p[i].distance(eye(side)) < 5.5 && m.p[i].z > eye(side).z - 3.0 && m.uv[i].y < layout::STRIP_TOP
        })
    };
    m.triangles.iter().filter(near).copied().collect()
}

/// First crossing of a ray with a set of triangles, ordered by bounding cones for speed.
fn first_hit(triangles: &[([DVec3; 3], DVec3, f64)], from: DVec3, direction: DVec3) -> Option<f64> {
    let mut best: Option<f64> = None;
    for (t, middle, radius) in triangles {
        let rel = *middle - from;
        let off = rel - direction * rel.dot(direction);
        if off.length_squared() > radius * radius {
            continue;
        }
        if let Some(s) = hit(from, direction, *t) {
            best = Some(best.map_or(s, |b: f64| b.min(s)));
        }
    }
    best
}

fn bounded(triangles: &[[usize; 3]], p: &[DVec3]) -> Vec<([DVec3; 3], DVec3, f64)> {
    triangles
        .iter()
        .map(|t| {
            let t = t.map(|i| p[i]);
            let middle = (t[0] + t[1] + t[2]) / 3.0;
            (t, middle, t.iter().map(|c| c.distance(middle)).fold(0.0, f64::max))
        })
        .collect()
}

/// Eyeball and cornea of one side.
fn eye_parts(side: f64) -> [super::Mesh; 2] {
    let name = if side > 0.0 { "Lt" } else { "Rt" };
    [mesh(&format!("{name}EyeBall_smtt")), mesh(&format!("{name}EyeTransp_smtt"))]
}

fn gaze(ud: f64, lr: f64) -> DMat3 {
    DMat3::from_rotation_y(lr.to_radians()) * DMat3::from_rotation_x(-ud.to_radians())
}

/// Ahead, and all ends and corners of the eyes' range.
const GAZES: [(f64, f64); 9] = [
    (0.0, 0.0),
    (25.0, 0.0),
    (-25.0, 0.0),
    (0.0, 30.0),
    (0.0, -30.0),
    (25.0, 30.0),
    (25.0, -30.0),
    (-25.0, 30.0),
    (-25.0, -30.0),
];

/// Fails where a ray from the eye's centre meets the lid before it leaves the eye.
fn assert_clear(side: f64, uppers: &[f64], lowers: &[f64], shapes: &[[f64; 2]]) {
    let triangles = lid_triangles(side);
    assert!(triangles.len() > 1500);
    let parts = eye_parts(side);
    for (&upper, &lower) in uppers.iter().flat_map(|u| lowers.iter().map(move |l| (u, l))) {
        for &shapes in shapes {
            let lid = bounded(&triangles, &deformed(&lids(side, upper, lower), shapes));
            for (ud, lr) in GAZES {
                for p in parts.iter().flat_map(|part| part.p.iter().step_by(2)) {
                    let rel = gaze(ud, lr) * (*p - eye(side));
                    if rel.z < 0.2 {
                        continue;
                    }
                    let direction = rel.normalize_or_zero();
                    if let Some(s) = first_hit(&lid, eye(side), direction) {
                        assert!(
                            s > rel.length(),
                            "side {side}, lids {upper}/{lower}, shapes {shapes:?}, gaze {ud}/{lr}: \
                             eye at {:.4}, lid at {s:.4}, toward {direction:.2}",
                            rel.length()
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn the_left_eye_never_comes_through_the_lids() {
    assert_clear(1.0, &[-10.0, 0.0, 10.0, 22.5, 35.0, 45.0], &[-5.0, 0.0, 12.5, 25.0], &[[0.0, 0.0]]);
}

#[test]
fn the_right_eye_never_comes_through_the_lids() {
    assert_clear(-1.0, &[-10.0, 0.0, 22.5, 45.0], &[-5.0, 12.5, 25.0], &[[0.0, 0.0]]);
}

#[test]
fn shapes_do_not_push_the_lids_into_the_eyes() {
    let shapes = [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.5]];
    assert_clear(1.0, &[-10.0, 0.0, 22.5, 45.0], &[0.0, 25.0], &shapes);
    assert_clear(-1.0, &[0.0, 45.0], &[0.0, 25.0], &shapes[..3]);
}

#[test]
fn closed_lids_leave_no_line_of_sight() {
    let views = [
        DVec3::Z,
        DVec3::new(0.5, 0.0, 1.0),
        DVec3::new(-0.4, 0.0, 1.0),
        DVec3::new(0.0, 0.5, 1.0),
        DVec3::new(0.0, -0.5, 1.0),
        DVec3::new(0.4, -0.7, 1.0),
    ];
    for side in [1.0, -1.0] {
        let triangles = lid_triangles(side);
        let closed = bounded(&triangles, &deformed(&lids(side, 45.0, 25.0), [0.0, 0.0]));
        let open = bounded(&triangles, &deformed(&lids(side, 0.0, 0.0), [0.0, 0.0]));
        let parts = eye_parts(side);
        let mut seen_when_open = 0;
        for ((ud, lr), p) in
            GAZES.into_iter().flat_map(|g| parts.iter().flat_map(move |m| m.p.iter().map(move |p| (g, p))))
        {
            let rel = gaze(ud, lr) * (*p - eye(side));
            if rel.z < 0.25 {
                continue;
            }
            for view in views {
                let view = (view * DVec3::new(side, 1.0, 1.0)).normalize_or_zero();
                if rel.normalize_or_zero().dot(view) < 0.15 {
                    continue;
                }
                let from = eye(side) + rel + rel.normalize_or_zero() * 1e-4;
                assert!(
                    first_hit(&closed, from, view).is_some(),
                    "gaze {ud}/{lr}: {rel:.3} is seen from {view:.2}"
                );
                seen_when_open +=
                    usize::from((ud, lr) == (0.0, 0.0) && first_hit(&open, from, view).is_none());
            }
        }
        assert!(seen_when_open > 300, "the test must be able to fail: {seen_when_open}");
    }
}
