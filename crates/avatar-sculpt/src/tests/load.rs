//! The files as another program of the project reads and moves them.

use avatar_pack::{FaceState, MemorySource, Pack};
use glam::DVec3;

use super::{geometry, hit, mesh, sculpture};
use crate::{anatomy::EYE, arkit, surface::half::Patch, weights};

pub(super) fn loaded() -> Pack {
    let files = geometry().files.iter().cloned().collect();
    Pack::load(&MemorySource { files }).unwrap()
}

/// The 52 names.
fn arkit_names() -> Vec<String> {
    let shapes = arkit::moved(sculpture()).into_iter().filter(|m| m.weight == arkit::Weight::Control);
    let mut names: Vec<String> = shapes.map(|m| m.name).collect();
    names.dedup();
    names.retain(|name| !arkit::FURTHER.contains(&name.as_str()));
    names.extend(arkit::BY_BONES.map(str::to_owned));
    names
}

/// Values of all controls, with some set.
pub(super) fn values(pack: &Pack, set: &[(&str, f32)]) -> Vec<f32> {
    let mut values = pack.controls().defaults();
    for (name, value) in set {
        values[pack.controls().index(name).unwrap()] = *value;
    }
    values
}

/// Places of the skin under these controls, couplings included.
pub(super) fn posed(pack: &Pack, set: &[(&str, f32)]) -> Vec<DVec3> {
    let mut face = FaceState::new(pack);
    face.pose(pack, &values(pack, set)).unwrap();
    let skin = pack.parts().iter().position(|part| part.name == "skin").unwrap();
    face.deform(pack, skin).unwrap().positions.iter().map(|p| p.as_dvec3()).collect()
}

#[test]
fn the_pack_loads_without_a_warning() {
    let pack = loaded();
    assert!(pack.warnings().is_empty(), "{:?}", pack.warnings());
    assert_eq!(pack.rig().len(), 9);
}

/// The sounds of speech, by the names of Oculus.
const SOUNDS: [&str; 15] =
    ["sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "I", "O", "U"];

#[test]
fn all_names_of_arkit_and_the_sounds_of_speech_are_controls() {
    let pack = loaded();
    let mut names = arkit_names();
    assert_eq!(names.len(), 52);
    let rest = posed(&pack, &[]);
    names.extend(SOUNDS.map(|sound| format!("viseme_{sound}")));
    for name in names {
        let index = pack.controls().index(&name).unwrap_or_else(|| panic!("no control {name}"));
        let control = &pack.controls().controls()[index];
        assert_eq!((control.min, control.max, control.default), (0.0, 1.0, 0.0), "{name}");
        assert!(control.group.is_some(), "{name} has no group");
        // Each moves some skin, but eyes that look aside; silence and lips that are closed already move by a
        // trace.
        let apart = ["eyeLookIn", "eyeLookOut"].iter().any(|start| name.starts_with(start));
        let least = if name == "viseme_sil" || name == "mouthClose" { 0.005 } else { 0.1 };
        let moved = posed(&pack, &[(&name, 1.0)]);
        let most = moved.iter().zip(&rest).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
        assert!(apart || most > least, "{name} moves the skin by {most}");
    }
}

#[test]
fn what_bones_do_turns_bones() {
    let pack = loaded();
    let same = |name: &str, controls: &[(&str, f32)]| {
        let (by_name, by_bones) = (posed(&pack, &[(name, 1.0)]), posed(&pack, controls));
        for (p, q) in by_name.iter().zip(&by_bones) {
            assert!(p.distance(*q) < 1e-5, "{name}: {p} and {q}");
        }
        assert!(by_bones.iter().zip(&posed(&pack, &[])).any(|(p, q)| p.distance(*q) > 0.1), "{name}");
    };
    same("eyeBlinkLeft", &[("lid.left.upper", 45.0), ("lid.left.lower", 25.0)]);
    same("eyeBlinkRight", &[("lid.right.upper", 45.0), ("lid.right.lower", 25.0)]);
    same("jawOpen", &[("jaw.open", 20.0)]);
    same("jawLeft", &[("jaw.jut", 8.0)]);
    same("jawRight", &[("jaw.jut", -8.0)]);
    // The upper lid follows the gaze, by whatever name it is called.
    same("eyeLookDownLeft", &[("eye.left.ud", -25.0)]);
    same("eyeLookUpRight", &[("eye.right.ud", 25.0)]);
}

#[test]
fn lips_that_are_closed_over_an_open_jaw_meet() {
    let pack = loaded();
    let skin = &sculpture().skin;
    // The rows that touch at rest, from the midline nearly to the corner.
    let row = &skin.loops.mouth;
    let vertex = |node: usize| {
        (0..skin.vertices.len()).find(|&i| skin.vertices[i].source == node && skin.vertices[i].p.x >= 0.0)
    };
    let pairs: Vec<(usize, usize)> = (0..row.len() / 2 - 3)
        .map(|k| (vertex(row[k]).unwrap(), vertex(row[row.len() - 1 - k]).unwrap()))
        .collect();
    let gap = |set: &[(&str, f32)]| {
        let p = posed(&pack, set);
        pairs.iter().map(|(up, low)| p[*up].distance(p[*low])).fold(0.0, f64::max)
    };
    let (open, closed) = (gap(&[("jawOpen", 1.0)]), gap(&[("jawOpen", 1.0), ("mouthClose", 1.0)]));
    let half = gap(&[("jawOpen", 0.5), ("mouthClose", 1.0)]);
    assert!(open > 2.0 && closed < 0.1 && half < 0.25, "open {open}, closed {closed}, half {half}");
}

#[test]
fn closing_lids_keep_their_distance_from_the_eye() {
    // Skin that slides about an axis keeps its distance from it.
    let pack = loaded();
    let radius = |p: DVec3| (p.y - EYE.y).hypot(p.z - EYE.z);
    let rest = posed(&pack, &[]);
    let skin = &sculpture().skin;
    let lid: Vec<usize> = (0..rest.len())
        .filter(|&i| {
            let node = &skin.half.nodes[skin.vertices[i].source];
            let all = weights::of(node);
            let share: f64 = all.iter().filter(|w| w.0 == weights::UPPER_LID).map(|w| w.1).sum();
            node.patch == Patch::Sheet && share > 0.02
        })
        .collect();
    assert!(lid.len() > 200, "{}", lid.len());
    for closed in [-10.0, 11.25, 22.5, 33.75, 45.0] {
        let p = posed(&pack, &[("lid.left.upper", closed), ("lid.right.upper", closed)]);
        let off = lid.iter().map(|&i| (radius(p[i]) - radius(rest[i])).abs()).fold(0.0, f64::max);
        assert!(off < 0.02, "lids closed by {closed} degrees: {off}");
    }
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
