//! The files as another program of the project reads and moves them.

use avatar_pack::{FaceState, MemorySource, Pack};
use glam::DVec3;

use super::{geometry, hit, mesh, sculpture};

fn loaded() -> Pack {
    let files = geometry().files.iter().cloned().collect();
    Pack::load(&MemorySource { files }).unwrap()
}

/// Values of all controls, with some set.
fn values(pack: &Pack, set: &[(&str, f32)]) -> Vec<f32> {
    let mut values = pack.controls().defaults();
    for (name, value) in set {
        values[pack.controls().index(name).unwrap()] = *value;
    }
    values
}

/// Places of the skin under these controls, couplings included.
fn posed(pack: &Pack, set: &[(&str, f32)]) -> Vec<DVec3> {
    let mut face = FaceState::new(pack);
    face.pose(pack, &values(pack, set)).unwrap();
    let skin = &pack.part("skin").unwrap().mesh;
    let mut out = skin.deformed();
    avatar_mesh::deform(skin, face.bones(), face.weights(), &mut out).unwrap();
    out.positions.iter().map(|p| p.as_dvec3()).collect()
}

#[test]
fn the_pack_loads_without_a_warning() {
    let pack = loaded();
    assert!(pack.warnings().is_empty(), "{:?}", pack.warnings());
    assert_eq!(pack.rig().len(), 9);
}

#[test]
fn upper_lids_follow_the_gaze() {
    let pack = loaded();
    let rest = posed(&pack, &[]);
    let skin = &sculpture().skin;
    // The middle of the upper lids' margin, left and right.
    for side in [1.0, -1.0] {
        let margin = (0..rest.len())
            .filter(|&i| {
                let node = &skin.half.nodes[skin.vertices[i].source];
                node.lid == 0.0 && !node.lower && skin.vertices[i].p.x * side > 0.0
            })
            .max_by(|&a, &b| rest[a].y.total_cmp(&rest[b].y))
            .unwrap();
        let name = if side > 0.0 { "eye.left.ud" } else { "eye.right.ud" };
        let up = posed(&pack, &[(name, 20.0)])[margin].y - rest[margin].y;
        let down = posed(&pack, &[(name, -20.0)])[margin].y - rest[margin].y;
        assert!(up > 0.05 && down < -0.05, "side {side}: {up} up, {down} down");
    }
}

#[test]
fn lips_at_rest_hide_the_teeth() {
    let pack = loaded();
    let skin = pack.part("skin").unwrap();
    // Only what lies about the mouth can hide teeth.
    let about_mouth = |places: &[DVec3]| -> Vec<[DVec3; 3]> {
        let all = skin.mesh.triangles.iter().map(|t| t.map(|i| places[i as usize]));
        all.filter(|t| t.iter().all(|p| p.z > 2.5 && p.y > -9.0 && p.y < -3.0 && p.x.abs() < 3.5)).collect()
    };
    let (shut, open) = (about_mouth(&posed(&pack, &[])), about_mouth(&posed(&pack, &[("smile", 1.0)])));
    let hidden = |triangles: &[[DVec3; 3]], from: DVec3, view: DVec3| {
        triangles.iter().any(|t| {
            let low = t[0].min(t[1]).min(t[2]);
            let high = t[0].max(t[1]).max(t[2]);
            // Views lie within 45 degrees of straight ahead.
            let reach = DVec3::splat(6.0 - from.z) * DVec3::new(1.0, 1.0, 0.0);
            (low - reach).truncate().cmple(from.truncate()).all()
                && (high + reach).truncate().cmpge(from.truncate()).all()
                && hit(from, view, *t).is_some()
        })
    };
    let mut seen_smiling = 0;
    for stem in ["UpperJaw", "LowerJaw"] {
        for p in mesh(stem).p.iter().filter(|p| p.z > 2.4).step_by(3) {
            for view in
                [DVec3::Z, DVec3::new(0.35, 0.0, 1.0), DVec3::new(0.0, 0.3, 1.0), DVec3::new(0.0, -0.3, 1.0)]
            {
                let view = view.normalize_or_zero();
                assert!(hidden(&shut, *p, view), "{stem} at {p:.2} is seen from {view:.2}");
                seen_smiling += usize::from(!hidden(&open, *p, view));
            }
        }
    }
    assert!(seen_smiling > 20, "a smile shows teeth, and the test can fail: {seen_smiling}");
}
