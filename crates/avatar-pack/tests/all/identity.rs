//! Other people made of a face: `identity.toml`, and what it does to a pack.
#![allow(clippy::expect_used, clippy::panic, reason = "a test: it may panic")]

use crate::common::golden;
use avatar_mesh::{Shape, raw_shapes};
use avatar_pack::{EyeChange, EyeRegion, FaceState, Identity, IdentityError, MemorySource, Pack, raw_files};
use glam::{DMat3, Vec3};

/// Far more than the golden face: the map acts in full everywhere.
const EVERYWHERE: &str = "center = [0, 2, 0]\nradii = [1e5, 1e5, 1e5]\nfull = 0.9\n";

fn axis(name: &str, rest: &str) -> String {
    format!("[[axis]]\nname = \"{name}\"\nless = \"less\"\nmore = \"more\"\n{rest}\n")
}

fn with_axes(text: &str) -> Pack {
    let mut source = golden();
    source.files.insert("identity.toml".to_owned(), text.as_bytes().to_vec());
    // A shape whose way is known.
    source.files.insert("shapes.toml".to_owned(), b"[[shape]]\nname = \"up\"\n".to_vec());
    let vertices = Pack::load(&golden()).expect("the golden pack").parts()[0].mesh.positions.len();
    let offsets = || [(1, Vec3::new(0.25, 0.5, 0.125))];
    let normals = Shape::from_pairs("", vertices, offsets()).expect("a vertex").positions;
    let shape = Shape::from_pairs("up", vertices, offsets()).expect("a vertex").with_normals(normals);
    let mut raw = Vec::new();
    raw_shapes::write(&shape, &mut raw);
    source.files.insert("shapes.raw".to_owned(), raw);
    Pack::load(&source).expect("a good pack")
}

fn close(a: Vec3, b: Vec3) -> bool {
    a.distance(b) < 1e-4 * (1.0 + a.length())
}

/// Against the formulas of an affine map, by hand.
#[test]
fn a_scale_moves_places_normals_shapes_and_joints() {
    let factors = Vec3::new(1.5, 0.5, 1.0);
    let map = format!("[[axis.map]]\n{EVERYWHERE}scale = [1.5, 0.5, 1]\nmove = [0, 0, 3]\n");
    let pack = with_axes(&axis("wide", &map));
    let person = pack.with_identity(&[1.0]).expect("a person");
    let to = |p: Vec3| Vec3::new(0.0, 2.0, 3.0) + (p - Vec3::new(0.0, 2.0, 0.0)) * factors;
    for (before, after) in pack.parts().iter().zip(person.parts()) {
        for (p, q) in before.mesh.positions.iter().zip(&after.mesh.positions) {
            assert!(close(to(*p), *q), "{p} goes to {q}");
        }
        for (n, m) in before.mesh.normals.iter().zip(&after.mesh.normals) {
            let expected = (*n / factors).normalize_or_zero() * n.length();
            assert!(close(expected, *m), "{n} becomes {m}, not {expected}");
        }
        assert_eq!(after.bounds, after.mesh.bounds());
    }
    let (mesh, moved) = (&pack.parts()[0].mesh, &person.parts()[0].mesh);
    let offset = |mesh: &avatar_mesh::Mesh| {
        let shape = mesh.shapes.iter().find(|shape| shape.name == "up").expect("the shape");
        (shape.positions.get(1), shape.normals.as_ref().and_then(|normals| normals.get(1)))
    };
    let ((Some(way), Some(turn)), (Some(new_way), Some(new_turn))) = (offset(mesh), offset(moved)) else {
        panic!("offsets of the vertex")
    };
    assert!(close(way * factors, new_way), "{new_way}");
    // What turns a normal turns all that is added to it: the sum has the direction of the moved surface.
    let sum = ((mesh.normals[1] + turn) / factors).normalize_or_zero();
    assert!(close(sum, (moved.normals[1] + new_turn).normalize_or_zero()), "{new_turn}");
    for (before, after) in pack.rig().world_from_bind().iter().zip(person.rig().world_from_bind()) {
        assert!(close(to(before.translation.into()), after.translation.into()), "{after}");
        assert!(before.matrix3.abs_diff_eq(after.matrix3, 1e-5), "joints keep their directions");
    }
    // Bones at rest leave the new form alone.
    let mut state = FaceState::new(&person);
    state.pose(&person, &person.controls().defaults()).expect("at rest");
    for (p, q) in state.deform(&person, 0).expect("the skin").positions.iter().zip(&moved.positions) {
        assert!(close(*p, *q), "{p} and {q}");
    }
    assert!(person.identity().is_none(), "its axes are those of another form");
}

#[test]
fn a_map_ends_and_mirrors() {
    let pack =
        with_axes(&axis("one", "[[axis.map]]\ncenter = [3, 0, 0]\nradii = [2, 5, 5]\nmove = [1, 2, 0]"));
    let person = pack.with_identity(&[0.5]).expect("a person");
    let mut moved = 0;
    for (before, after) in pack.parts().iter().zip(person.parts()) {
        for (p, q) in before.mesh.positions.iter().zip(&after.mesh.positions) {
            // 1 − s³ (10 − 15 s + 6 s²) of the distance, in half axes, on the side of the place.
            let rel = Vec3::new(p.x.abs() - 3.0, p.y, p.z) / Vec3::new(2.0, 5.0, 5.0);
            let s = rel.length().min(1.0);
            let share = 1.0 - s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
            let side = if p.x < 0.0 { -1.0 } else { 1.0 };
            assert!(close(*p + share * 0.5 * Vec3::new(side, 2.0, 0.0), *q), "{p} goes to {q}");
            if s == 1.0 {
                assert_eq!(p, q, "beyond the map not a bit changes");
            }
            moved += usize::from(p != q);
        }
    }
    assert!(moved > 0, "the test moves something");
}

#[test]
fn eyes_stay_balls_and_lids_turn_with_them() {
    let eyes = "[eyes]\nfull = 2\napart = 3\nreach = 4\n";
    let map = format!("eye = {{ size = 1.2, tilt = 10, move = [0.5, 0, 0] }}\n[[axis.map]]\n{EVERYWHERE}");
    let pack = with_axes(&format!("{eyes}{}", axis("eyes", &format!("{map}scale = [1.1, 2, 1]"))));
    let person = pack.with_identity(&[1.0]).expect("a person");
    let bind = |pack: &Pack, name: &str| {
        pack.rig().world_from_bind()[pack.rig().joint(name).expect("a joint").index()]
    };
    for (side, sign) in [("Lt", 1.0f32), ("Rt", -1.0)] {
        let (from, to) = (bind(&pack, &format!("{side}EyeJoint")), bind(&person, &format!("{side}EyeJoint")));
        let (from_at, to_at) = (Vec3::from(from.translation), Vec3::from(to.translation));
        let carried = Vec3::new(from_at.x * 1.1, 2.0 + (from_at.y - 2.0) * 2.0, from_at.z);
        assert!(close(carried + Vec3::X * 0.5 * sign, to_at), "{to_at}");
        assert!(from.matrix3.abs_diff_eq(to.matrix3, 1e-5), "the gaze keeps its axes");
        let name = if sign > 0.0 { "left-eyeball" } else { "right-eyeball" };
        let (ball, new) = (pack.part(name).expect("a ball"), person.part(name).expect("a ball"));
        for (p, q) in ball.mesh.positions.iter().zip(&new.mesh.positions) {
            assert!(close(to_at + (*p - from_at) * 1.2, *q), "{p} goes to {q}");
        }
        assert_eq!(ball.mesh.normals, new.mesh.normals);
        // By the platform's sine, which the library does without.
        let turn = DMat3::from_rotation_z(f64::from(sign * 10.0).to_radians());
        let lid = format!("{side}UpperLidJoint");
        let axes = |pack: &Pack| glam::Mat3::from(bind(pack, &lid).matrix3).as_dmat3();
        assert!((turn * axes(&pack)).abs_diff_eq(axes(&person), 1e-5), "{lid}");
        assert!(close(bind(&person, &lid).translation.into(), to_at), "{lid}");
    }
}

#[test]
fn axes_move_others_and_none_goes_too_far() {
    let text = axis("shift", &format!("[[axis.map]]\n{EVERYWHERE}move = [0, 10, 0]"))
        + &axis("half", "of = { shift = 0.5 }")
        + &axis("quarter", "of = { half = 0.5 }");
    let pack = with_axes(&text);
    let rise = |values: &[f32]| {
        let person = pack.with_identity(values).expect("a person");
        person.parts()[0].mesh.positions[0].y - pack.parts()[0].mesh.positions[0].y
    };
    for (values, expected) in [
        ([0.5, 0.0, 0.0], 5.0),
        ([0.0, 1.0, 0.0], 5.0),
        ([0.0, 0.0, 1.0], 2.5),
        ([0.0, -1.0, 1.0], -2.5),
        ([1.0, 1.0, 1.0], 12.0),
    ] {
        assert!((rise(&values) - expected).abs() < 1e-3, "{values:?}: {}", rise(&values));
    }
}

#[test]
fn without_a_value_not_a_byte_changes_and_axes_are_written_and_read() {
    let text = format!("[eyes]\nfull = 1\napart = 2\nreach = 2\n{}", axis("a", "spread = 0.1"))
        + &axis(r#"b \"quoted\""#, "with = { a = -0.5 }\nof = { a = 0.25 }\neye = { tilt = 3 }")
        + &axis("c", &format!("[[axis.map]]\n{EVERYWHERE}turn = [1, 2, 3]"));
    let pack = with_axes(&text);
    let files = |pack: &Pack| raw_files(pack, &avatar_pack::Textures::default()).expect("its files").files;
    assert_eq!(files(&pack), files(&pack.with_identity(&[0.0; 3]).expect("herself")));
    let again = Pack::load(&MemorySource { files: files(&pack).into_iter().collect() }).expect("a good pack");
    assert_eq!(pack.identity(), again.identity());
    let identity = pack.identity().expect("axes");
    assert_eq!(identity.eyes, Some(EyeRegion { full: 1.0, apart: 2.0, reach: 2.0 }));
    assert_eq!(identity.axes[1].eye, EyeChange { tilt: 3.0, ..EyeChange::default() });
    assert_eq!((&identity.axes[1].with[..], &identity.axes[1].of[..]), (&[(0, -0.5)][..], &[(0, 0.25)][..]));
}

#[test]
fn what_is_out_of_range_is_refused() {
    let pack = with_axes(&axis("wide", ""));
    let refused = |values: &[f32]| pack.with_identity(values).expect_err("refused").to_string();
    assert_eq!(refused(&[]), "expected 1 values, one for each axis, found 0");
    assert_eq!(refused(&[1.5]), "identity axis \"wide\": expected a number from -1 to 1, found 1.5");
    assert_eq!(refused(&[f32::NAN]), "identity axis \"wide\": expected a number from -1 to 1, found NaN");
    let plain = Pack::load(&golden()).expect("the golden pack");
    assert_eq!(plain.with_identity(&[]).expect_err("no axes"), IdentityError::NoAxes);
}

#[test]
fn seeds_draw_what_the_file_says() {
    let text = axis("a", "spread = 0.2") + &axis("b", "spread = 0\nwith = { a = -0.5 }");
    let identity = Identity::from_toml(&text).expect("two axes");
    let drawn: Vec<_> = (0..4000).map(|seed| identity.draw(seed)).collect();
    let of_a = || drawn.iter().map(|values| f64::from(values[0]));
    let mean = of_a().sum::<f64>() / 4000.0;
    let deviation = (of_a().map(|a| (a - mean) * (a - mean)).sum::<f64>() / 4000.0).sqrt();
    // Four standard errors of the mean and of the deviation.
    assert!(mean.abs() < 4.0 * 0.2 / 4000f64.sqrt(), "{mean}");
    assert!((deviation - 0.2).abs() < 4.0 * 0.2 / 8000f64.sqrt(), "{deviation}");
    assert!(drawn.iter().all(|values| (values[1] + 0.5 * values[0]).abs() < 1e-6));
    assert!(drawn.iter().flatten().all(|value| (-1.0..=1.0).contains(value)));
}

#[test]
fn colours_of_a_drawn_person_are_those_of_people() {
    use avatar_look::Colors;
    let drawn = |seed: u64| {
        let mut pack = Pack::load(&golden()).expect("the golden pack");
        pack.set_hair(Some(avatar_groom::Hair::default()));
        pack.draw_colors(seed);
        let eye = pack.parts().iter().position(|part| part.name == "left-eyeball").expect("an eye");
        let hair = pack.hair().expect("hair").style.scalp.tip_color;
        (pack.material(0).tone.color, pack.material(eye).iris.color, hair)
    };
    let (pale, dark) = (Colors::skin_with(0.03), Colors::skin_with(1.9));
    let all: Vec<_> = (0..200).map(drawn).collect();
    for (skin, iris, hair) in &all {
        assert!((0..3).all(|k| (dark[k]..=pale[k]).contains(&skin[k])), "{skin:?}");
        assert!(Colors::IRISES.iter().any(|(_, color)| color == iris), "{iris:?}");
        assert!(avatar_groom::Style::COLORS.iter().any(|(_, color)| color == hair), "{hair:?}");
    }
    assert_eq!(drawn(7), all[7]);
    let pale = all.iter().filter(|(skin, ..)| skin[0] > 0.6).count();
    assert!((40..160).contains(&pale), "{pale} of 200 are pale");
}

#[test]
fn mistakes_are_told_with_their_place() {
    let told = |text: &str| Identity::from_toml(text).expect_err("a mistake").to_string();
    let named = axis("a", "");
    for (text, expected) in [
        (
            "[eyes]\nfull = 2\napart = 1\nreach = 3",
            "line 1, column 1: eyes: expected 0 < full < apart <= reach",
        ),
        ("[[axis]]\nname = \"a\"\nless = \"b\"", "more: expected what a face is called at 1, found none"),
        (&format!("{named}{named}"), "expected a name that no other axis has, found \"a\" again"),
        (&axis("b", "of = { a = 1 }"), "expected no axis before there is one, found \"a\""),
        (&format!("{named}{}", axis("b", "of = { a = 3 }")), "expected a number from -2 to 2, found 3"),
        (
            &axis("b", "eye = { size = 1.1 }"),
            "expected a table [eyes] where an axis changes eyes, found none",
        ),
        (&axis("b", "spread = 2"), "expected a number from 0 to 1, found 2"),
        (&axis("b", "[[axis.map]]\ncenter = [0, 0, 0]"), "radii: expected three numbers, found none"),
        (
            &axis("b", "[[axis.map]]\ncenter = [0, 0, 0]\nradii = [1, 0, 1]"),
            "radii: expected an array of three numbers from 0.000001 to 1000000, found",
        ),
        (&axis("b", "wdith = 1"), "expected one of the keys name, less, more"),
    ] {
        assert!(told(text).contains(expected), "{}\nis not\n{expected}", told(text));
    }
}
