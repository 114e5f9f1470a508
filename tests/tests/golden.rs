//! Rig and meshes together, against results of independent float64 programs: the small pack of `tests/golden`
//! (always), and a real face in the same format (where its data lies beside the repository).
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use avatar_mesh::{
    Bounds, Deformed, FACE_BONES, FACE_PARTS, FACE_SHAPES, Follows, Mesh, PartSpec, Winding, deform, raw,
};
use glam::{Affine3A, Mat4, Vec3};
use rig_core::{Axis, Elementary, JointId, Rig, RigPose};
use serde_json::Value;
use std::path::{Path, PathBuf};

const TOLERANCE: f64 = 1e-4;

fn golden() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("golden")
}

struct Pack {
    rig: Rig,
    parts: Vec<(PartSpec, Mesh)>,
}

fn read(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn load(folder: &Path, xml: &str) -> Pack {
    let rig = Rig::from_xml(&read(&folder.join(xml))).unwrap();
    let part = |spec: PartSpec| {
        let buffer = |kind: &str| read(&folder.join(format!("{}_{kind}.raw", spec.stem)));
        let mut mesh = match spec.follows {
            Follows::Bones => raw::read_skin(&buffer("VB"), &buffer("IB")),
            Follows::Joint(_) => raw::read_rigid(&buffer("VB"), &buffer("IB")),
        }
        .unwrap();
        assert_eq!(mesh.validate(FACE_BONES.len()), Ok(vec![]), "{}", spec.name);
        (spec, mesh)
    };
    Pack { rig, parts: FACE_PARTS.map(part).into() }
}

/// Compares numbers and counts them, so that a test that compares nothing fails.
#[derive(Default)]
struct Check {
    compared: usize,
}

impl Check {
    fn close(&mut self, what: &str, found: &[f32], expected: &Value, tolerance: f64) {
        let expected = expected.as_array().unwrap_or_else(|| panic!("{what} is missing"));
        assert_eq!(found.len(), expected.len(), "{what}");
        for (found, expected) in found.iter().zip(expected) {
            let expected = expected.as_f64().unwrap();
            let good = (f64::from(*found) - expected).abs() <= tolerance;
            assert!(good, "{what}: expected {expected}, found {found}");
            self.compared += 1;
        }
    }

    fn sum(&mut self, what: &str, points: &[Vec3], expected: &Value) {
        for (k, expected) in expected.as_array().unwrap().iter().enumerate() {
            let found: f64 = points.iter().map(|p| f64::from(p[k])).sum();
            let expected = expected.as_f64().unwrap();
            // A tenth of what one vertex may be off, for each: a bone matrix is the product of some five
            // matrices in f32, whose steps at these coordinates are 1e-6, and its error moves all its
            // vertices alike.
            let tolerance = 0.1 * TOLERANCE * points.len() as f64;
            assert!((found - expected).abs() <= tolerance, "{what}: sum: expected {expected}, found {found}");
            self.compared += 1;
        }
    }

    fn bounds(&mut self, what: &str, points: &[Vec3], min: &Value, max: &Value) {
        let bounds = Bounds::of(points).unwrap();
        self.close(&format!("{what}: min"), &bounds.min.to_array(), min, TOLERANCE);
        self.close(&format!("{what}: max"), &bounds.max.to_array(), max, TOLERANCE);
    }
}

/// `"JawJoint": [["z", -20.0]]`: axes and degrees, left to right.
fn factors(listed: &Value) -> Vec<Elementary> {
    let factor = |entry: &Value| {
        let axis = match entry[0].as_str().unwrap() {
            "x" => Axis::X,
            "y" => Axis::Y,
            "z" => Axis::Z,
            other => panic!("axis {other}"),
        };
        Elementary::rotation(axis, (entry[1].as_f64().unwrap() as f32).to_radians())
    };
    listed.as_array().unwrap().iter().map(factor).collect()
}

fn posed(rig: &Rig, case: &Value) -> RigPose {
    let mut locals = rig.locals();
    for (joint, listed) in case["rotations"].as_object().unwrap() {
        locals.set_product(rig.joint(joint).unwrap(), &factors(listed)).unwrap();
    }
    let mut pose = rig.pose();
    rig.update(locals.as_slice(), &mut pose).unwrap();
    pose
}

fn deformed(mesh: &Mesh, bones: &[Affine3A], weights: &[f32]) -> Deformed {
    let mut out = mesh.deformed();
    deform(mesh, bones, weights, &mut out).unwrap();
    out
}

/// All that a case lists; returns how many numbers that was.
fn compare(pack: &Pack, case: &Value) -> usize {
    let mut check = Check::default();
    let name = case["pose"].as_str().unwrap();
    let pose = posed(&pack.rig, case);
    let id = |joint: &str| pack.rig.joint(joint).unwrap();
    for joint in FACE_BONES {
        let i = id(joint).index();
        let what = format!("{name}: {joint}");
        let t = pose.world_from_joint()[i].translation.to_array();
        check.close(&what, &t, &case["joint_world_translation"][joint], TOLERANCE);
        let x = Mat4::from(pose.posed_from_bind()[i]).transpose().to_cols_array();
        check.close(&what, &x, &case["skin_matrices_rowmajor"][joint], TOLERANCE);
    }

    let palette: Vec<JointId> = FACE_BONES.map(id).into();
    let mut bones = [Affine3A::IDENTITY; FACE_BONES.len()];
    pose.gather(&palette, &mut bones).unwrap();
    let weights = FACE_SHAPES.map(|shape| case[shape].as_f64().unwrap() as f32);
    for (spec, mesh) in &pack.parts {
        let what = format!("{name}: {}", spec.name);
        let Follows::Joint(joint) = spec.follows else {
            let out = deformed(mesh, &bones, &weights);
            check.bounds(&what, &out.positions, &case["skin_min"], &case["skin_max"]);
            check.sum(&what, &out.positions, &case["skin_sum"]);
            let moved =
                out.positions.iter().zip(&mesh.positions).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
            assert!(
                (f64::from(moved) - case["max_move"].as_f64().unwrap()).abs() <= TOLERANCE,
                "{what}: {moved}"
            );
            for (vertex, expected) in case["vertices"].as_object().unwrap() {
                let i: usize = vertex.parse().unwrap();
                let what = format!("{what}: vertex {vertex}");
                check.close(&what, &out.positions[i].to_array(), &expected["p"], TOLERANCE);
                check.close(&what, &out.normals[i].to_array(), &expected["n"], TOLERANCE);
            }
            continue;
        };
        // The larger set of expectations has no rigid parts.
        let Some(expected) = case["parts"].get(spec.stem) else { continue };
        let out = deformed(mesh, &[pose.posed_from_bind()[id(joint).index()]], &[]);
        check.bounds(&what, &out.positions, &expected["min"], &expected["max"]);
        check.sum(&what, &out.positions, &expected["sum"]);
        check.sum(&what, &out.normals, &expected["normal_sum"]);
    }
    check.compared
}

fn compare_all(pack: &Pack, expected: &Path) -> (usize, usize) {
    let expected: Value = serde_json::from_slice(&read(expected)).unwrap();
    let cases = expected["cases"].as_array().unwrap();
    (cases.len(), cases.iter().map(|case| compare(pack, case)).sum())
}

#[test]
fn the_small_pack_agrees_in_every_pose() {
    let pack = load(&golden().join("pack"), "Transformations.xml");
    // Per pose: 9 joints × 19, the skin's box and sum, 48 vertices × 6, six parts × (box, sum, sum of
    // normals).
    let numbers = 9 * 19 + 9 + 48 * 6 + 6 * 12;
    assert_eq!(compare_all(&pack, &golden().join("expected.json")), (9, 9 * numbers));
}

#[test]
fn a_real_face_agrees_in_every_pose() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    if !data.is_dir() {
        let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
        assert!(!required, "expected data in {} (MIMIK_REQUIRE_DATA=1), found no folder", data.display());
        // Past the harness, which keeps the output of tests that pass to itself.
        let skipped = format_args!("SKIPPED: {} is not there\n", data.display());
        let _ = std::io::Write::write_fmt(&mut std::io::stderr(), skipped);
        return;
    }
    let pack = load(&data.join("avatar-course-format-makehuman"), "Transformationen.xml");
    let numbers = 9 * 19 + 9 + 8 * 6;
    assert_eq!(compare_all(&pack, &data.join("expected/makehuman.expected.json")), (6, 6 * numbers));
}

/// What the small pack is there for: mirror copies with the left one's triangles, an order of joints of its
/// own.
#[test]
fn the_small_pack_has_the_quirks_of_the_original() {
    let pack = load(&golden().join("pack"), "Transformations.xml");
    for (spec, mesh) in &pack.parts {
        let inside_out = matches!(spec.name, "right-eyeball" | "right-cornea");
        assert_eq!(Winding::of(mesh).is_inside_out(), inside_out, "{}: {:?}", spec.name, Winding::of(mesh));
    }
    let triangles = |name: &str| &pack.parts.iter().find(|(spec, _)| spec.name == name).unwrap().1.triangles;
    assert_eq!(triangles("right-eyeball"), triangles("left-eyeball"));
    assert_eq!(triangles("right-cornea"), triangles("left-cornea"));
    assert_eq!(pack.rig.len(), 9);
    assert_ne!(pack.rig.names(), FACE_BONES);
}

/// What the conventions of the nine-joint rig state about its frames, seen on a point in front of each joint.
#[test]
fn the_frames_turn_the_face_as_the_controls_expect() {
    let pack = load(&golden().join("pack"), "Transformations.xml");
    let moved = |joint: &str, axis: Axis, offset: Vec3| {
        let id = pack.rig.joint(joint).unwrap();
        let mut locals = pack.rig.locals();
        locals.set_product(id, &[Elementary::rotation(axis, 10f32.to_radians())]).unwrap();
        let mut pose = pack.rig.pose();
        pack.rig.update(locals.as_slice(), &mut pose).unwrap();
        let point = Vec3::from(pack.rig.world_from_bind()[id.index()].translation) + offset;
        pose.posed_from_bind()[id.index()].transform_point3(point) - point
    };
    assert!(moved("HeadJoint", Axis::X, Vec3::Z).x > 0.1, "head +x: the nose goes to the character's left");
    assert!(moved("HeadJoint", Axis::Y, Vec3::Z).y < -0.1, "head +y: the nose goes down");
    assert!(moved("HeadJoint", Axis::Z, Vec3::Y).x > 0.1, "head +z: the crown goes to the left shoulder");
    assert!(moved("JawJoint", Axis::Z, Vec3::Z).y > 0.1, "jaw −z opens");
    for eye in ["LtEyeJoint", "RtEyeJoint"] {
        assert!(moved(eye, Axis::Z, Vec3::Z).y > 0.1, "{eye} +z: looks up");
        assert!(moved(eye, Axis::Y, Vec3::Z).x > 0.1, "{eye} +y: looks to the character's left");
    }
    for side in ["Lt", "Rt"] {
        assert!(
            moved(&format!("{side}UpperLidJoint"), Axis::Z, Vec3::Z).y > 0.1,
            "{side} upper lid −z closes"
        );
        assert!(
            moved(&format!("{side}LowerLidJoint"), Axis::Z, Vec3::Z).y > 0.1,
            "{side} lower lid +z closes"
        );
    }
}
