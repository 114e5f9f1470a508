use glam::{DMat3, DVec3};

use super::{deformed, hit, lids, mesh, skin};
use crate::{anatomy::EYE, layout};

/// Triangles of the outer skin around the left eye: not the socket, whose uv lies in the strip below the face.
fn lid_triangles() -> Vec<[usize; 3]> {
    let m = skin();
    let near = |t: &&[usize; 3]| {
        t.iter()
            .all(|&i| m.p[i].distance(EYE) < 5.5 && m.p[i].z > EYE.z - 3.0 && m.uv[i].y < layout::STRIP_TOP)
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

#[test]
fn the_eye_never_comes_through_the_lids() {
    let triangles = lid_triangles();
    assert!(triangles.len() > 1500);
    let parts = [mesh("LtEyeBall_smtt"), mesh("LtEyeTransp_smtt")];
    for upper in [-10.0, 0.0, 10.0, 22.5, 35.0, 45.0] {
        for lower in [-5.0, 0.0, 12.5, 25.0] {
            for shapes in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
                if shapes != [0.0, 0.0] && (upper < 0.0 || upper == 10.0) {
                    continue;
                }
                let lid = bounded(&triangles, &deformed(&lids(upper, lower), shapes));
                for (ud, lr) in
                    [(0.0, 0.0), (25.0, 0.0), (-25.0, 0.0), (0.0, 30.0), (0.0, -30.0), (25.0, 30.0)]
                {
                    let gaze = DMat3::from_rotation_y(f64::to_radians(lr))
                        * DMat3::from_rotation_x(-f64::to_radians(ud));
                    for p in parts.iter().flat_map(|part| part.p.iter().step_by(2)) {
                        let rel = gaze * (*p - EYE);
                        if rel.z < 0.2 {
                            continue;
                        }
                        let direction = rel.normalize_or_zero();
                        if let Some(s) = first_hit(&lid, EYE, direction) {
                            assert!(
                                s > rel.length(),
                                "lids {upper}/{lower}, shapes {shapes:?}, gaze {ud}/{lr}: eye at {:.4}, lid at {s:.4}, toward {direction:.2}",
                                rel.length()
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn closed_lids_leave_no_line_of_sight() {
    let triangles = lid_triangles();
    let closed = bounded(&triangles, &deformed(&lids(45.0, 25.0), [0.0, 0.0]));
    let open = bounded(&triangles, &deformed(&lids(0.0, 0.0), [0.0, 0.0]));
    let mut seen_when_open = 0;
    for p in mesh("LtEyeBall_smtt").p.iter().chain(&mesh("LtEyeTransp_smtt").p) {
        let rel = *p - EYE;
        if rel.z < 0.25 {
            continue;
        }
        for view in [
            DVec3::Z,
            DVec3::new(0.5, 0.0, 1.0),
            DVec3::new(-0.4, 0.0, 1.0),
            DVec3::new(0.0, 0.5, 1.0),
            DVec3::new(0.0, -0.5, 1.0),
            DVec3::new(0.4, -0.7, 1.0),
        ] {
            let view = view.normalize_or_zero();
            if rel.normalize_or_zero().dot(view) < 0.15 {
                continue;
            }
            let from = *p + rel.normalize_or_zero() * 1e-4;
            assert!(first_hit(&closed, from, view).is_some(), "{rel:.3} is seen from {view:.2}");
            seen_when_open += usize::from(first_hit(&open, from, view).is_none());
        }
    }
    assert!(seen_when_open > 300, "the test must be able to fail: {seen_when_open}");
}
