//! Closed lids, seen near: they meet from corner to corner, and no lash goes through the upper lid.

use glam::DVec3;

use super::super::{eye, mesh, sculpture, skin};
use super::face::{Weights, deformed, face};
use crate::{
    anatomy::{EYE, EYE_REACH, lid_margin},
    bake::Bvh,
    lids,
    surface::half::{Node, Patch},
};

/// From where closed lids are looked at: from ahead, both sides, above and below.
const VIEWS: [DVec3; 7] = [
    DVec3::Z,
    DVec3::new(0.7, 0.0, 1.0),
    DVec3::new(2.5, 0.0, 1.0),
    DVec3::new(-0.35, 0.0, 1.0),
    DVec3::new(0.0, 0.6, 1.0),
    DVec3::new(0.0, -0.6, 1.0),
    DVec3::new(0.5, -0.5, 1.0),
];

/// Where the rim of a lid ends and its inner side begins.
const PAST_RIM: f64 = -0.24;

/// Distance between rays: a fiftieth of the opening's height at rest.
const STEP: f64 = 0.02;

fn node(vertex: usize) -> &'static Node {
    let skin = &sculpture().skin;
    &skin.half.nodes[skin.vertices[vertex].source]
}

/// Triangles near an eye under these weights whose corners are all such nodes.
fn near(side: f64, p: &[DVec3], is: impl Fn(&Node) -> bool) -> Vec<[DVec3; 3]> {
    let here = |t: &&[usize; 3]| t.iter().all(|&i| skin().p[i].distance(eye(side)) < 3.5 && is(node(i)));
    skin().triangles.iter().filter(here).map(|t| t.map(|i| p[i])).collect()
}

/// How many rays from outside come to the eye, or behind the outer skin of the lids, and where the first one
/// does, relative to the eye's centre.
fn slits(side: f64, with: &Weights) -> (usize, DVec3) {
    let p = deformed(face(), with);
    let rim = |n: &Node| n.patch == Patch::Sheet || n.patch == Patch::Socket && n.lid > PAST_RIM;
    let lids = Bvh::new(near(side, &p, |n| rim(n) && (n.patch == Patch::Sheet || !n.lower)));
    let name = if side > 0.0 { "LtEyeBall_smtt" } else { "RtEyeBall_smtt" };
    let ball = mesh(name);
    let mut behind = near(side, &p, |n| n.lid <= 0.0 && n.patch != Patch::Lash && (n.lower || !rim(n)));
    behind.extend(ball.triangles.iter().map(|t| t.map(|i| ball.p[i])));
    let behind = Bvh::new(behind);
    let (mut count, mut first) = (0, DVec3::ZERO);
    for view in VIEWS {
        let view = (view * DVec3::new(side, 1.0, 1.0)).normalize_or_zero();
        for (i, j) in (-85..=85).flat_map(|i| (-45..=45).map(move |j| (i, j))) {
            let flat = DVec3::new(f64::from(i) * STEP, f64::from(j) * STEP, 0.0);
            // Through a place of the opening on the ball that the lids lie on.
            let depth = (EYE_REACH * EYE_REACH - flat.length_squared()).max(0.0).sqrt();
            let at = eye(side) + DVec3::new(flat.x * side, flat.y, depth.max(1.0));
            // Where the lids are open at rest; at the inner corner flesh stands between them.
            let s = lids::along(flat);
            let within = |upper| lid_margin(s.clamp(0.0, 1.0), upper).y;
            if !(0.04..1.0).contains(&s) || flat.y > within(true) || flat.y < within(false) {
                continue;
            }
            let from = at + view * 3.0;
            let seen = behind.nearest(from, -view, 6.0).unwrap_or(6.0);
            if lids.nearest(from, -view, 6.0).unwrap_or(7.0) > seen + 1e-6 {
                count += 1;
                first = if count == 1 { from - view * seen - eye(side) } else { first };
            }
        }
    }
    (count, first)
}

fn closed_with(others: &[(&str, f64)]) -> Weights {
    let all = [("eyeBlinkLeft", 1.0), ("eyeBlinkRight", 1.0)].iter().chain(others);
    all.map(|(name, weight)| ((*name).to_owned(), *weight)).collect()
}

#[test]
fn closed_lids_meet_from_corner_to_corner() {
    for side in [1.0, -1.0] {
        let (open, _) = slits(side, &Weights::new());
        assert!(open > 3000, "the test must be able to fail: {open}");
        let (count, first) = slits(side, &closed_with(&[]));
        assert_eq!(count, 0, "side {side}: seen through closed lids at {first:.3}");
    }
}

#[test]
fn brows_and_cheeks_do_not_part_closed_lids() {
    let others: [&[(&str, f64)]; 6] = [
        &[("browInnerUp", 1.0)],
        &[("browOuterUpLeft", 1.0), ("browOuterUpRight", 1.0)],
        &[("browDownLeft", 1.0), ("browDownRight", 1.0)],
        &[("eyeSquintLeft", 1.0), ("eyeSquintRight", 1.0)],
        &[("cheekSquintLeft", 1.0), ("cheekSquintRight", 1.0)],
        &[("mouthSmileLeft", 1.0), ("noseSneerLeft", 1.0)],
    ];
    for with in others {
        let (count, first) = slits(1.0, &closed_with(with));
        assert_eq!(count, 0, "{with:?}: seen through closed lids at {first:.3}");
    }
}

#[test]
fn no_lash_goes_through_the_closed_upper_lid() {
    let skin = &sculpture().skin;
    // Along each lash, from where it has left the lid that it stands on.
    let crossings = |p: &[DVec3], from: f64| {
        let upper = Bvh::new(near(1.0, p, |n| n.patch == Patch::Sheet && n.lid <= 1.0 && !n.lower));
        let mut through = Vec::new();
        for t in skin.triangles.iter().map(|t| t.map(|i| i as usize)) {
            if t.iter().any(|&i| node(i).patch != Patch::Lash || skin.vertices[i].p.x < 0.0) {
                continue;
            }
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                let root = skin.half.mover(skin.vertices[a].source).p;
                let apart = |i: usize| skin.vertices[i].p.distance(root);
                let way = p[b] - p[a];
                if apart(a).min(apart(b)) < from || way.length() < 1e-9 {
                    continue;
                }
                if upper.nearest(p[a], way.normalize_or_zero(), way.length()).is_some() {
                    through.push((p[a] - EYE, node(a).lower));
                }
            }
        }
        through
    };
    let others: [&[(&str, f64)]; 4] = [
        &[],
        &[("eyeSquintLeft", 1.0)],
        &[("cheekSquintLeft", 0.7)],
        &[("mouthSmileLeft", 1.0), ("cheekSquintLeft", 0.5), ("eyeSquintLeft", 0.5)],
    ];
    for with in others {
        let through = crossings(&deformed(face(), &closed_with(with)), 0.1);
        assert!(
            through.is_empty(),
            "{with:?}: {} edges of lashes go through: {:.3?}",
            through.len(),
            through
        );
    }
    let unmoved = crossings(&deformed(face(), &Weights::new()), 0.0);
    assert!(!unmoved.is_empty(), "roots stand in the lids");
}
