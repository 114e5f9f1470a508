use std::collections::BTreeMap;

use glam::DVec3;

use super::{Mesh, RIGID, Turn, deformed, mesh, skin};
use crate::{
    anatomy::{BUST_EDGE_Y, EYE, JAW, LID_RADIUS, MOUTH_HALF_WIDTH, MOUTH_Y, NECK_BASE_Y},
    mesh::weld,
    surface::half::Patch,
};

/// Edges of a welded mesh with how often they are used forward and backward.
fn edges(m: &Mesh) -> BTreeMap<(usize, usize), (u32, u32)> {
    let welded = weld(&m.p);
    let mut edges = BTreeMap::new();
    for t in &m.triangles {
        for k in 0..3 {
            let (a, b) = (welded[t[k]], welded[t[(k + 1) % 3]]);
            let entry: &mut (u32, u32) = edges.entry((a.min(b), a.max(b))).or_default();
            if a < b { entry.0 += 1 } else { entry.1 += 1 }
        }
    }
    edges
}

#[test]
fn the_skin_is_closed_except_at_the_edge_of_the_bust() {
    let m = skin();
    let mut ends: BTreeMap<usize, u32> = BTreeMap::new();
    let skin = &super::sculpture().skin;
    let lash = |i: usize| skin.half.nodes[skin.vertices[i].source].patch == Patch::Lash;
    // Lashes are open where they stand in the edge of a lid.
    let edge: Vec<DVec3> = skin.loops.eye.iter().map(|&i| skin.half.nodes[i].p).collect();
    let in_a_lid = |p: DVec3| {
        let p = DVec3::new(p.x.abs(), p.y, p.z);
        edge.iter().any(|e| e.distance(p) < 0.16) && p.distance(EYE) < LID_RADIUS + 0.1
    };
    let mut roots = 0;
    for ((a, b), uses) in edges(m) {
        if uses == (1, 1) {
            continue;
        }
        assert_eq!(uses.0 + uses.1, 1, "{} {} is used {uses:?}", m.p[a], m.p[b]);
        if lash(a) && lash(b) {
            roots += 1;
            assert!([a, b].iter().all(|&i| in_a_lid(m.p[i])), "a lash stands off the lid at {}", m.p[a]);
            continue;
        }
        for i in [a, b] {
            assert!((m.p[i].y - BUST_EDGE_Y).abs() < 1e-5, "open at {}", m.p[i]);
            *ends.entry(i).or_default() += 1;
        }
    }
    assert_eq!(roots % 8, 0, "four edges at each root, left and right");
    assert!(roots > 4 * 2 * 60, "{roots}");
    assert!(ends.len() > 40);
    assert!(ends.values().all(|n| *n == 2), "the bust's edge is one clean loop");
}

#[test]
fn rigid_parts_are_closed_but_for_the_corneas_edge() {
    for stem in RIGID {
        let m = mesh(stem);
        let open = edges(&m).values().filter(|u| **u != (1, 1)).count();
        if stem.contains("Transp") {
            assert!(edges(&m).values().all(|u| u.0 <= 1 && u.1 <= 1), "{stem}");
            assert!(open > 0, "{stem}");
        } else {
            assert_eq!(open, 0, "{stem}");
        }
    }
}

#[test]
fn triangles_have_area_and_agree_with_their_normals() {
    for stem in RIGID.into_iter().chain(["MarsienneSkin"]) {
        let m = mesh(stem);
        let mut bad = 0;
        for t in &m.triangles {
            let [a, b, c] = t.map(|i| m.p[i]);
            let cross = (b - a).cross(c - a);
            assert!(cross.length() > 1e-7, "{stem}: no area at {a}");
            for &i in t {
                assert!((m.n[i].length() - 1.0).abs() < 1e-5, "{stem}: normal at {a}");
                let cos = m.n[i].dot(cross.normalize_or_zero());
                if cos <= 0.5 {
                    eprintln!("{stem}: normal {:.1} degrees off at {:.2}", cos.acos().to_degrees(), m.p[i]);
                    bad += 1;
                }
            }
        }
        assert_eq!(bad, 0, "{stem}");
    }
}

/// Lids and eyes come in pairs: left at even, right at odd numbers, and the eyes after the jaw.
fn mirrored_bone(bone: u8) -> u8 {
    match bone {
        2 | 4 | 7 => bone + 1,
        3 | 5 | 8 => bone - 1,
        _ => bone,
    }
}

#[test]
fn the_face_is_its_own_mirror_image() {
    let m = skin();
    let cell = |p: DVec3| (p * 50.0).round().to_array().map(|c| c as i64);
    let mut by_place: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    for (i, p) in m.p.iter().enumerate() {
        by_place.entry(cell(*p)).or_default().push(i);
    }
    let flip = |v: DVec3| DVec3::new(-v.x, v.y, v.z);
    let weight = |i: usize, bone: u8| -> f64 {
        (0..4).filter(|&k| m.skin[i].bones[k] == f64::from(bone)).map(|k| m.skin[i].weights[k]).sum()
    };
    for (i, p) in m.p.iter().enumerate() {
        let q = flip(*p);
        let mut near = vec![];
        for d in 0..27 {
            let [x, y, z] = cell(q);
            let key = [x + d % 3 - 1, y + d / 3 % 3 - 1, z + d / 9 - 1];
            near.extend(by_place.get(&key).into_iter().flatten().copied());
        }
        let twin = near.into_iter().find(|&j| {
            m.p[j].distance(q) < 1e-4
                && m.n[j].distance(flip(m.n[i])) < 1e-4
                && (0..2).all(|k| m.skin[j].shapes[k].0.distance(flip(m.skin[i].shapes[k].0)) < 1e-4)
                && (0..9).all(|bone| (weight(j, bone) - weight(i, mirrored_bone(bone))).abs() < 1e-6)
        });
        assert!(twin.is_some(), "no twin for {p}");
    }
}

#[test]
fn weights_are_complete_and_change_gently() {
    let m = skin();
    for s in &m.skin {
        assert!((s.weights.iter().sum::<f64>() - 1.0).abs() < 1e-6);
        assert!(s.weights.iter().all(|w| (0.0..=1.0).contains(w)));
        assert!(s.bones.iter().all(|b| b.fract() == 0.0 && (0.0..9.0).contains(b)));
    }
    let of = |i: usize, bone: f64| -> f64 {
        (0..4).filter(|&k| m.skin[i].bones[k] == bone).map(|k| m.skin[i].weights[k]).sum()
    };
    for t in &m.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            for bone in 0..7 {
                let step = (of(a, f64::from(bone)) - of(b, f64::from(bone))).abs();
                assert!(step < 0.4, "bone {bone} jumps by {step:.2} at {}", m.p[a]);
            }
        }
    }
}

#[test]
fn the_jaw_opens_the_mouth_and_leaves_brow_and_neck() {
    let by = glam::DMat3::from_rotation_x(20_f64.to_radians());
    let moved = deformed(&[Turn { bone: 6.0, about: JAW, by }], [0.0, 0.0]);
    let m = skin();
    for (p, q) in m.p.iter().zip(&moved) {
        if p.y > 0.5 || p.y < NECK_BASE_Y + 1.5 || p.z < -9.0 {
            assert!(p.distance(*q) < 0.02, "{p} moved by {}", p.distance(*q));
        }
    }
    let chin = (0..m.p.len()).filter(|&i| m.p[i].x == 0.0 && m.p[i].z > 3.0 && m.p[i].y < -8.5);
    for i in chin {
        assert!(moved[i].y < m.p[i].y - 2.0, "chin stays at {}", moved[i]);
    }
    // Nothing tears: even with a smile no edge of the outer skin grows beyond what skin could bear.
    for smile in [0.0, 1.0] {
        let moved = deformed(&[Turn { bone: 6.0, about: JAW, by }], [smile, 0.0]);
        for t in &m.triangles {
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                let (before, after) = (m.p[a].distance(m.p[b]), moved[a].distance(moved[b]));
                assert!(after < before + 0.8, "edge at {} grows from {before:.3} to {after:.3}", m.p[a]);
            }
        }
    }
}

#[test]
fn the_lips_meet() {
    let skin = &super::sculpture().skin;
    let (nodes, row) = (&skin.half.nodes, &skin.loops.mouth);
    for k in 0..row.len() / 2 {
        let (up, low) = (nodes[row[k]].p, nodes[row[row.len() - 1 - k]].p);
        assert!((up.y - low.y).abs() < 0.012, "gap of {} at {up}", up.y - low.y);
        assert!((up.z - low.z).abs() < 0.05, "step of {} at {up}", up.z - low.z);
    }
    let corner = nodes[row[row.len() / 2]].p;
    assert!(corner.x == f64::from(MOUTH_HALF_WIDTH as f32) && (corner.y - MOUTH_Y).abs() < 0.1);
}

#[test]
fn no_two_places_share_a_point_of_the_picture() {
    const SIDE: usize = 900;
    let m = skin();
    let mut owner = vec![false; SIDE * SIDE];
    for (number, t) in m.triangles.iter().enumerate() {
        let uv = t.map(|i| m.uv[i] * SIDE as f64);
        let area = (uv[1] - uv[0]).perp_dot(uv[2] - uv[0]);
        // v grows downward, so the outside's counter-clockwise is clockwise here.
        assert!(area < 0.0, "triangle {number} is flipped at {} ({area:e})", m.p[t[0]]);
        let low = uv[0].min(uv[1]).min(uv[2]).floor();
        let high = uv[0].max(uv[1]).max(uv[2]).ceil();
        for y in low.y as usize..=(high.y as usize).min(SIDE - 1) {
            for x in low.x as usize..=(high.x as usize).min(SIDE - 1) {
                let at = glam::DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let b = (at - uv[0]).perp_dot(uv[2] - uv[0]) / area;
                let c = (uv[1] - uv[0]).perp_dot(at - uv[0]) / area;
                if b > 1e-6 && c > 1e-6 && b + c < 1.0 - 1e-6 {
                    assert!(!owner[y * SIDE + x], "two places at {at}, one near {}", m.p[t[0]]);
                    owner[y * SIDE + x] = true;
                }
            }
        }
    }
}
