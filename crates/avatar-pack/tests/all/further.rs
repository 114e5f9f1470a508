//! Shapes beside the two of the raw format, and mixtures of controls.
#![allow(clippy::expect_used, clippy::panic, reason = "a test: it may panic")]

use crate::common::golden;
use avatar_exchange::{glb, gltf};
use avatar_mesh::{FACE_PARTS, Shape, raw_shapes};
use avatar_pack::{
    FaceCrowd, FaceState, FurtherShapes, Import, MemorySource, Pack, ShapeWeight, Side, Textures, export,
    raw_files,
};
use glam::Vec3;
use pose_anim::{ControlTable, PlayerCrowd};

pub(crate) const TOML: &str = r#"
[[shape]]
name = "browInnerUp"
group = "brows"
[[shape]]
name = "tongueOut"
group = "tongue"
parts = ["skin", "lower-jaw"]
[[shape]]
name = "half a brow"
follows = "browInnerUp"
at = 0.5
[[shape]]
name = "open with brows"
product = ["jaw.open", "browInnerUp", "smile"]
[[mixture]]
name = "eyeBlinkLeft"
group = "eyes"
side = "left"
of = { "lid.left.upper" = 45, "lid.left.lower" = 25 }
[[mixture]]
name = "oh"
of = { browInnerUp = 0.5, "jaw.open" = 4 }
[[mixture]]
name = "loud"
of = { oh = 2, "jaw.open" = 1 }
[[wrinkle]]
center = [0, 4.5, 2]
radius = 3.25
of = { browInnerUp = 1, SSmile = 0.5 }
"#;

/// What the shapes of [`TOML`] move: their part, a vertex, its position and its normal.
const MOVED: [(&str, &str, u32, Vec3, Vec3); 5] = [
    ("browInnerUp", "skin", 1, Vec3::new(0.0, 1.0, 0.5), Vec3::new(0.0, 0.25, 0.0)),
    ("tongueOut", "skin", 2, Vec3::Z, Vec3::ZERO),
    ("tongueOut", "lower-jaw", 0, Vec3::new(0.0, 0.0, 2.0), Vec3::ZERO),
    ("half a brow", "skin", 1, Vec3::X, Vec3::ZERO),
    ("open with brows", "skin", 3, Vec3::Y, Vec3::X),
];

/// The golden pack with further shapes, and the bytes of these.
pub(crate) fn source() -> MemorySource {
    let mut source = golden();
    let pack = Pack::load(&source).expect("the golden pack");
    let mut bytes = Vec::new();
    for (name, part, vertex, position, normal) in MOVED {
        let vertices = pack.part(part).expect("a part").mesh.positions.len();
        let normals = Shape::from_pairs("", vertices, [(vertex, normal)]).expect("a vertex").positions;
        let shape = Shape::from_pairs(name, vertices, [(vertex, position)]).expect("a vertex");
        raw_shapes::write(&shape.with_normals(normals), &mut bytes);
    }
    source.files.insert("shapes.toml".to_owned(), TOML.into());
    source.files.insert("shapes.raw".to_owned(), bytes);
    source
}

fn values(pack: &Pack, set: &[(&str, f32)]) -> Vec<f32> {
    let mut values = pack.controls().defaults();
    for (name, value) in set {
        values[pack.controls().index(name).unwrap_or_else(|| panic!("the control {name}"))] = *value;
    }
    values
}

/// Weights of all shapes by their names.
fn weights(pack: &Pack, set: &[(&str, f32)]) -> Vec<(String, f32)> {
    let mut state = FaceState::new(pack);
    state.pose(pack, &values(pack, set)).expect("a pose");
    pack.shapes().iter().cloned().zip(state.weights().iter().copied()).filter(|(_, w)| *w != 0.0).collect()
}

fn named(list: &[(&str, f32)]) -> Vec<(String, f32)> {
    list.iter().map(|(name, weight)| ((*name).to_owned(), *weight)).collect()
}

#[test]
fn shapes_and_mixtures_are_controls_behind_those_of_the_face() {
    let pack = Pack::load(&source()).expect("a pack");
    let names: Vec<_> = pack.controls().names().skip(15).collect();
    assert_eq!(names, ["browInnerUp", "tongueOut", "eyeBlinkLeft", "oh", "loud"]);
    let plain = Pack::load(&golden()).expect("a pack");
    assert_eq!(pack.controls().controls()[..15], plain.controls().controls()[..]);
    let groups: Vec<_> = pack.controls().controls().iter().skip(15).map(|one| one.group.as_deref()).collect();
    assert_eq!(groups, [Some("brows"), Some("tongue"), Some("eyes"), None, None]);
    let list = pack.further_shapes().expect("a list");
    assert_eq!(list.mixtures[0].side, Some(Side::Left));
    assert_eq!(list.shapes[2].weight, ShapeWeight::Follows { input: "browInnerUp".to_owned(), at: 0.5 });
    let shape = |name: &str| pack.shapes().iter().position(|shape| shape == name).expect("a shape");
    let [wrinkle] = &pack.wrinkles()[..] else { panic!("one place of wrinkles") };
    assert_eq!((wrinkle.center, wrinkle.radius), (Vec3::new(0.0, 4.5, 2.0), 3.25));
    assert_eq!(wrinkle.shapes, [(shape("browInnerUp"), 1.0), (shape("SSmile"), 0.5)]);
    assert_eq!(plain.wrinkles(), []);
    let skin = pack.part("skin").expect("a skin");
    assert_eq!(skin.bytes, plain.part("skin").expect("a skin").bytes + 4 * 32);
}

#[test]
fn weights_are_those_of_the_rules() {
    let pack = Pack::load(&source()).expect("a pack");
    assert_eq!(weights(&pack, &[]), []);
    assert_eq!(weights(&pack, &[("smile", 0.5)]), named(&[("SSmile", 0.5)]));
    // Half way from half a brow to the whole one.
    let brow = named(&[("browInnerUp", 0.5), ("half a brow", 0.5)]);
    assert_eq!(weights(&pack, &[("browInnerUp", 0.75)]), brow);
    // The shape of each part.
    assert_eq!(weights(&pack, &[("tongueOut", 0.25)]), named(&[("tongueOut", 0.25), ("tongueOut", 0.25)]));
    // The jaw opens by up to 20 degrees: 0.25 · 1 · 0.5.
    let open = weights(&pack, &[("jaw.open", 5.0), ("browInnerUp", 1.0), ("smile", 0.5)]);
    assert_eq!(open, named(&[("SSmile", 0.5), ("browInnerUp", 1.0), ("open with brows", 0.125)]));
}

#[test]
fn a_mixture_is_as_good_as_its_controls() {
    let pack = Pack::load(&source()).expect("a pack");
    let posed = |set: &[(&str, f32)]| {
        let mut state = FaceState::new(&pack);
        state.pose(&pack, &values(&pack, set)).expect("a pose");
        (state.bones().to_vec(), state.weights().to_vec())
    };
    let lids = [("lid.left.upper", 45.0), ("lid.left.lower", 25.0)];
    assert_eq!(posed(&[("eyeBlinkLeft", 1.0)]), posed(&lids));
    let half = [("lid.left.upper", 22.5), ("lid.left.lower", 12.5)];
    assert_eq!(posed(&[("eyeBlinkLeft", 0.5)]), posed(&half));
    assert_eq!(posed(&[("loud", 0.5)]), posed(&[("jaw.open", 4.5), ("browInnerUp", 0.5)]));
    // Set by itself, behind the couplings, as `--set` does.
    let mut state = FaceState::new(&pack);
    let blink = pack.controls().index("eyeBlinkLeft").expect("a control");
    state.pose_with(&pack, &pack.controls().defaults(), |set| set[blink] = 1.0, &[]).expect("a pose");
    assert_eq!(state.bones(), posed(&lids).0);
    // Closed lids close no further.
    assert_eq!(posed(&[lids[0], lids[1], ("eyeBlinkLeft", 1.0)]), posed(&lids));
}

#[test]
fn the_vertices_of_every_part_move() {
    let pack = Pack::load(&source()).expect("a pack");
    let rest = FaceState::new(&pack);
    let mut state = FaceState::new(&pack);
    for (name, part, vertex, position, _) in MOVED {
        let set: &[(&str, f32)] = match name {
            "half a brow" => &[("browInnerUp", 0.5)],
            "open with brows" => &[("jaw.open", 20.0), ("browInnerUp", 1.0), ("smile", 1.0)],
            name => &[(name, 1.0)],
        };
        // Without what bones do.
        state.pose(&pack, &values(&pack, set)).expect("a pose");
        let mut bones = FaceState::new(&pack);
        bones.set_weights(&state.weights().iter().copied().enumerate().collect::<Vec<_>>());
        let index = pack.parts().iter().position(|other| other.name == part).expect("a part");
        let at = |state: &FaceState| state.deform(&pack, index).expect("a part").positions[vertex as usize];
        let moved = at(&bones) - at(&rest);
        let smile = if vertex == 3 { pack.parts()[0].mesh.shapes[0].positions.get(3) } else { None };
        let expected = position + smile.unwrap_or_default();
        assert!(moved.distance(expected) < 1e-5, "{name} of {part}: {moved}, expected {expected}");
    }
}

#[test]
fn a_crowd_has_the_same_weights() {
    let pack = Pack::load(&source()).expect("a pack");
    let mut players = PlayerCrowd::new(pack.controls(), 19);
    let mut crowd = FaceCrowd::new(&pack, 19);
    let mut state = FaceState::new(&pack);
    for (face, set) in
        [(3, &[("oh", 0.75)][..]), (18, &[("browInnerUp", 0.3), ("jaw.open", 7.0)]), (7, &[("loud", 1.0)])]
    {
        players.jump_to(face, &values(&pack, set)).expect("a face of the crowd");
    }
    players.advance(1.0 / 30.0).expect("time");
    crowd.pose(&pack, &players).expect("a crowd of the pack");
    let mut weights = vec![0.0; pack.shapes().len()];
    let mut own = vec![0.0; pack.controls().len()];
    let mut moved = 0;
    for face in 0..19 {
        players.copy_values(face, &mut own).expect("a face of the crowd");
        state.pose(&pack, &own).expect("a pose");
        crowd.copy_weights(face, &mut weights);
        assert_eq!(weights, state.weights(), "face {face}");
        moved += usize::from(weights.iter().any(|weight| *weight != 0.0));
    }
    assert_eq!(moved, 3);
}

#[test]
fn mistakes_are_told_with_their_places() {
    let told = |text: &str| {
        let mut source = source();
        source.files.insert("shapes.toml".to_owned(), text.into());
        Pack::load(&source).expect_err("a mistake").to_string()
    };
    let shape = "[[shape]]\nname = 'a'\n";
    for (text, expected) in [
        (
            "[[shapes]]\nname = 'a'\n",
            r#"one of the keys shape, mixture, wrinkle, found "shapes"; did you mean "shape"?"#,
        ),
        ("[[shape]]\n", "line 1, column 1: shape.name: expected the name of a shape, found none"),
        (
            "[[shape]]\nname = 'Frown'\n",
            r#"line 2, column 8: shape.name: expected names that no other shape or mixture has, found "Frown" again"#,
        ),
        (
            "[[shape]]\nname = 'head.turn'\n",
            r#"expected a name that no control of anything else has, found "head.turn", the control of "HeadJoint""#,
        ),
        (
            "[[shape]]\nname = 'a'\nparts = ['skn']\n",
            r#"line 3, column 10: shape.parts: expected one of the parts skin, "#,
        ),
        (
            "[[shape]]\nname = 'a'\nat = 0.5\n",
            "line 3, column 6: shape.at: expected at only beside follows, found it without",
        ),
        (
            "[[shape]]\nname = 'a'\nfollows = 'smile'\nat = 0\n",
            "line 4, column 6: shape.at: expected a number up to 1e9 that is not 0, found 0",
        ),
        (
            "[[shape]]\nname = 'a'\nfollows = 'smile'\n",
            "line 3, column 11: shape.follows: expected another value of `at` than that of other shapes of this input, found 1 again",
        ),
        ("[[shape]]\nname = 'a'\nproduct = ['smlie']\n", r#"found "smlie"; did you mean "smile"?"#),
        (
            "[[shape]]\nname = 'a'\nproduct = []\n",
            "line 3, column 11: shape.product: expected at least one input, found an array of 0",
        ),
        (
            "[[shape]]\nname = 'a'\nside = 'up'\n",
            r#"line 3, column 8: shape.side: expected one of left, right, found "up""#,
        ),
        (
            "[[mixture]]\nname = 'm'\nof = { n = 1 }\n[[mixture]]\nname = 'n'\nof = { smile = 1 }\n",
            r#"line 3, column 8: mixture.of.n: expected a control, a shape or an earlier mixture"#,
        ),
        (
            "[[mixture]]\nname = 'm'\nof = { smile = 1e9 }\n[[mixture]]\nname = 'n'\nof = { m = 2 }\n",
            "line 6, column 6: mixture.of: expected moves of at most 1e9 in all, found 2e9",
        ),
        (
            "[[mixture]]\nname = 'm'\nof = { smile = nan }\n",
            "mixture.of.smile: expected a finite number up to 1e9, found nan",
        ),
        ("[[wrinkle]]\n", "line 1, column 1: wrinkle.center: expected an array of three numbers"),
        (
            "[[wrinkle]]\ncenter = [0, 1]\nradius = 1\nof = {}\n",
            "line 2, column 10: wrinkle.center: expected an array of three numbers up to 1e9, found an array of 2",
        ),
        (
            "[[wrinkle]]\ncenter = [0, 1, 2]\nradius = 0\nof = {}\n",
            "line 3, column 10: wrinkle.radius: expected a number above 0 and up to 1e9, found 0",
        ),
        (
            "[[wrinkle]]\ncenter = [0, 1, 2]\nradius = 1\nof = { SSmlie = 1 }\n",
            r#"line 4, column 8: wrinkle.of.SSmlie: expected a shape, of SSmile, Frown, found "SSmlie"; did you mean "SSmile"?"#,
        ),
        (
            "[[wrinkle]]\ncenter = [0, 1, 2]\nradius = 1\nof = { SSmile = -1 }\n",
            "line 4, column 17: wrinkle.of.SSmile: expected a number from 0 to 10, found -1",
        ),
        (
            &"[[wrinkle]]\ncenter = [0, 1, 2]\nradius = 1\nof = {}\n".repeat(17),
            "line 66, column 10: wrinkle.center: expected at most 16 tables wrinkle, found another one",
        ),
    ] {
        let found = told(text);
        assert!(found.starts_with("shapes.toml: ") && found.contains(expected), "{text}: {found}");
    }
    let found = told(shape);
    let rest =
        "shapes.raw: byte 32: expected the end of the file behind the last shape, found 128 more bytes";
    assert_eq!(found, rest);
    let mut source = source();
    source.files.remove("shapes.raw");
    let missing = Pack::load(&source).expect_err("a missing file").to_string();
    assert_eq!(missing, "shapes.raw: expected the file shapes.raw, found none");
    source.files.insert("shapes.raw".to_owned(), vec![1, 0, 0, 0, 255, 255, 0, 0]);
    let cut = Pack::load(&source).expect_err("a cut file").to_string();
    let text =
        r#"shapes.raw: byte 4, shape "browInnerUp": expected 28 more bytes for its moved vertices, found 4"#;
    assert_eq!(cut, text);
}

/// Multiplied out, each of these moves all controls of the face.
#[test]
fn mixtures_of_mixtures_do_not_grow_without_bounds() {
    let mut text = String::new();
    let controls = ControlTable::default_face();
    let first: Vec<_> = controls.names().map(|name| format!("{name:?} = 1")).collect();
    text += &format!("[[mixture]]\nname = 'm0'\nof = {{ {} }}\n", first.join(", "));
    for number in 1..6000 {
        text += &format!("[[mixture]]\nname = 'm{number}'\nof = {{ m{} = 1 }}\n", number - 1);
    }
    let error = FurtherShapes::from_toml(&text, &controls).expect_err("too much").to_string();
    let expected = "mixture.of: expected mixtures that move at most 65536 controls in all, found ";
    assert!(error.contains(expected), "{error}");
}

#[test]
fn a_text_that_is_written_says_the_same() {
    let controls = ControlTable::default_face();
    let list = FurtherShapes::from_toml(TOML, &controls).expect("a list");
    assert_eq!(FurtherShapes::from_toml(&list.to_toml(), &controls).as_ref(), Ok(&list));
    let without = FurtherShapes::from_toml("", &controls).expect("an empty list");
    assert_eq!(FurtherShapes::from_toml(&without.to_toml(), &controls), Ok(without));
    assert_eq!(FACE_PARTS[0].name, "skin", "the part that shapes move where nothing is said");
}

#[test]
fn a_pack_with_further_shapes_comes_back_to_the_bit() {
    let own = source();
    let (pack, textures) = (Pack::load(&own).expect("a pack"), Textures::load(&own));
    let written = raw_files(&pack, &textures).expect("files");
    let source = MemorySource { files: written.files.into_iter().collect() };
    let again = Pack::load(&source).expect("what was written");
    assert_eq!(source.files["shapes.raw"], own.files["shapes.raw"]);
    for spec in FACE_PARTS {
        let name = format!("{}_VB.raw", spec.stem);
        assert!(source.files[&name] == own.files[&name], "{name}");
    }
    assert_eq!(again.further_shapes(), pack.further_shapes());
    assert_eq!((again.controls(), again.poses()), (pack.controls(), pack.poses()));
    assert_eq!((again.shapes(), again.sliders()), (pack.shapes(), pack.sliders()));
    for (a, b) in again.parts().iter().zip(pack.parts()) {
        assert_eq!(
            (&a.mesh.shapes, a.first_shape, a.bytes),
            (&b.mesh.shapes, b.first_shape, b.bytes),
            "{}",
            a.name
        );
    }
}

/// GLB keeps every shape; which of them count as products of others, and mixtures, it cannot say.
#[test]
fn all_shapes_go_through_glb_and_into_a_pack_again() {
    let own = source();
    let (pack, textures) = (Pack::load(&own).expect("a pack"), Textures::load(&own));
    let bytes = glb::write_raw(&export(&pack, &textures)).expect("a GLB");
    let scene = gltf::read("a.glb", &bytes, &mut |_| Err(String::new())).expect("a scene");
    let import = Import::from_scene(scene).expect("an avatar");
    let written = raw_files(&import.pack, &import.textures).expect("files");
    let source = MemorySource { files: written.files.into_iter().collect() };
    let again = Pack::load(&source).expect("what was written");
    let rest = |pack: &Pack| FaceState::new(pack).deform(pack, 0).expect("the skin").positions;
    let (a, b) = (rest(&pack), rest(&again));
    assert_eq!(a.len(), b.len());
    assert!(a.iter().zip(&b).all(|(a, b)| a.distance(*b) < 1e-5), "the same rest");
    for name in ["browInnerUp", "tongueOut", "half a brow", "open with brows"] {
        let control = again.controls().index(name).unwrap_or_else(|| panic!("the control {name}"));
        let mut state = FaceState::new(&again);
        let mut values = again.controls().defaults();
        values[control] = 1.0;
        state.pose(&again, &values).expect("a pose");
        for (_, part, vertex, position, normal) in MOVED.iter().filter(|moved| moved.0 == name) {
            let index = again.parts().iter().position(|other| other.name == *part).expect("a part");
            let deformed = state.deform(&again, index).expect("a part");
            let mesh = &pack.part(part).expect("a part").mesh;
            let vertex = *vertex as usize;
            let moved = deformed.positions[vertex] - mesh.positions[vertex];
            assert!(moved.distance(*position) < 1e-5, "{name} of {part}: {moved}");
            let turned = (mesh.normals[vertex] + *normal).normalize_or_zero();
            assert!(deformed.normals[vertex].distance(turned) < 1e-5, "{name} of {part}");
        }
    }
}
