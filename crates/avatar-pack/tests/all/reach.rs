//! What controls move, and what a ray hits.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test: it may panic and read files"
)]

use crate::common::marsienne;
use avatar_mesh::{Deformed, PartKind};
use avatar_pack::{FaceState, Pack, Reach};
use glam::Vec3;
use std::collections::HashSet;

fn part(pack: &Pack, name: &str) -> usize {
    pack.parts().iter().position(|part| part.name == name).expect(name)
}

fn control(pack: &Pack, name: &str) -> usize {
    pack.controls().index(name).expect(name)
}

/// The names of the parts that a control moves.
fn moved_parts<'a>(pack: &'a Pack, reach: &Reach, name: &str) -> HashSet<&'a str> {
    reach.moved(control(pack, name)).map(|(part, _)| pack.parts()[part].name.as_str()).collect()
}

fn deformed(pack: &Pack, values: &[f32]) -> Vec<Deformed> {
    let mut state = FaceState::new(pack);
    state.pose(pack, values).expect("values fit");
    (0..pack.parts().len()).map(|part| state.deform(pack, part).expect("a part")).collect()
}

#[test]
fn controls_move_what_they_are_about() {
    let pack = marsienne();
    let reach = Reach::new(&pack);
    assert_eq!(moved_parts(&pack, &reach, "smile"), HashSet::from(["skin"]));
    assert_eq!(moved_parts(&pack, &reach, "jaw.open"), HashSet::from(["skin", "lower-jaw"]));
    assert_eq!(moved_parts(&pack, &reach, "eye.left.lr"), HashSet::from(["left-eyeball", "left-cornea"]));
    // The upper lid follows.
    let up = moved_parts(&pack, &reach, "eye.left.ud");
    assert_eq!(up, HashSet::from(["left-eyeball", "left-cornea", "skin"]));
    let turned: HashSet<_> = reach.moved(control(&pack, "head.turn")).collect();
    for (index, part) in pack.parts().iter().enumerate().filter(|(_, part)| part.kind == PartKind::Surface) {
        assert!((0..part.mesh.positions.len()).all(|vertex| turned.contains(&(index, vertex))));
    }
    let skin = part(&pack, "skin");
    let forehead = |position: &&Vec3| position.y > 5.0 && position.z > 0.0;
    assert!(pack.parts()[skin].mesh.positions.iter().filter(forehead).count() > 100);
    for (vertex, _) in pack.parts()[skin].mesh.positions.iter().enumerate().filter(|(_, p)| forehead(p)) {
        assert!(turned.contains(&(skin, vertex)), "{vertex}");
    }
    assert_eq!(reach.moved(99).count(), 0);
}

#[test]
fn moved_is_what_the_deformed_face_says() {
    let pack = marsienne();
    let reach = Reach::new(&pack);
    let rest = deformed(&pack, &pack.controls().defaults());
    let ends = |name: &str| {
        let index = control(&pack, name);
        let at = |value: f32| {
            let mut values = pack.controls().defaults();
            values[index] = value;
            deformed(&pack, &values)
        };
        [at(pack.controls().controls()[index].min), at(pack.controls().controls()[index].max)]
    };
    // The height of what is above the neck, from the other end: the threshold lies between its share of
    // these.
    let all = pack.bounds().expect("vertices");
    let most = 0.002 * (all.max.y - all.min.y);
    for name in ["smile", "jaw.jut", "lid.right.upper", "eye.left.ud"] {
        let index = control(&pack, name);
        let ends = ends(name);
        let way = |part: usize, vertex: usize| {
            let from = rest[part].positions[vertex];
            ends.iter().map(|end| end[part].positions[vertex].distance(from)).fold(0.0, f32::max)
        };
        let (mut moved, mut longest) = (0, 0.0f32);
        for (part, deformed) in rest.iter().enumerate() {
            for vertex in 0..deformed.positions.len() {
                let (way, strength) = (way(part, vertex), reach.strength(index, part, vertex));
                assert!(strength.is_some() || way <= most, "{name} {part} {vertex}: {way}");
                assert!(strength.is_none() || way > 0.5 * most, "{name} {part} {vertex}: {way}");
                moved += usize::from(strength.is_some());
                longest = longest.max(way);
            }
        }
        assert_eq!(reach.moved(index).count(), moved);
        for (part, vertex) in reach.moved(index) {
            let strength = reach.strength(index, part, vertex).expect("it is moved");
            let share = way(part, vertex) / longest;
            assert!((strength - share).abs() <= 1.01 / 255.0, "{name}: {strength} {share}");
        }
    }
}

#[test]
fn the_mouth_s_corner_is_about_smiles_first_and_about_heads_last() {
    let pack = marsienne();
    let reach = Reach::new(&pack);
    let skin = part(&pack, "skin");
    let smile = &pack.parts()[skin].mesh.shapes[0].positions;
    let (corner, _) = { smile.iter() }.max_by(|a, b| a.1.length().total_cmp(&b.1.length())).expect("a smile");
    let side = if pack.parts()[skin].mesh.positions[corner].x > 0.0 { "Left" } else { "Right" };
    let mut out = vec![99];
    reach.controls_at(skin, corner, &mut out);
    let names: Vec<_> = out.iter().map(|index| pack.controls().controls()[*index].name.as_str()).collect();
    assert!(names[0].starts_with("mouth") && names[0].ends_with(side), "{names:?}");
    let head = &names[names.len() - 3..];
    assert!(head.iter().all(|name| name.starts_with("head.")), "{names:?}");
    assert!(names.contains(&"smile") && names.contains(&"frown") && names.contains(&"jaw.open"));
    assert!(
        !names.iter().any(|name| ["eye", "lid.", "brow"].iter().any(|part| name.starts_with(part))),
        "{names:?}"
    );

    reach.controls_at(part(&pack, "left-eyeball"), 0, &mut out);
    let names: Vec<_> = out.iter().map(|index| pack.controls().controls()[*index].name.as_str()).collect();
    let of_eye =
        |name: &&str| name.starts_with("eye.left.") || name.starts_with("eyeLook") && name.ends_with("Left");
    assert!(names[..names.len() - 3].iter().all(of_eye), "{names:?}");
    reach.controls_at(99, 0, &mut out);
    assert!(out.is_empty());
}

#[test]
fn a_ray_hits_the_side_that_it_comes_from() {
    let pack = marsienne();
    let mut values = pack.controls().defaults();
    for turned in [0.0, 50.0] {
        values[control(&pack, "head.turn")] = turned;
        let face = deformed(&pack, &values);
        let skin = part(&pack, "skin");
        // Through the forehead, and past the head.
        let front = pack.hit(&face, Vec3::new(0.5, 5.0, 100.0), Vec3::NEG_Z).expect("the forehead");
        let back = pack.hit(&face, Vec3::new(0.5, 5.0, -100.0), Vec3::Z).expect("the back of the head");
        assert_eq!((front.part, back.part), (skin, skin));
        let at = |hit: &avatar_pack::Hit| face[hit.part].positions[hit.vertex];
        assert!(at(&front).z > at(&back).z + 5.0, "{front:?} {back:?}");
        for (hit, depth) in [(front, 100.0 - front.distance), (back, back.distance - 100.0)] {
            let met = Vec3::new(0.5, 5.0, depth);
            assert!(at(&hit).distance(met) < 1.5, "{} {met}", at(&hit));
        }
        for beside in [Vec3::new(60.0, 0.0, 100.0), Vec3::new(0.0, 60.0, 100.0)] {
            assert_eq!(pack.hit(&face, beside, Vec3::NEG_Z), None);
        }
        // What lies behind is not hit.
        assert_eq!(pack.hit(&face, Vec3::new(0.5, 5.0, 100.0), Vec3::Z), None);
    }
    values[control(&pack, "head.turn")] = 0.0;
    let face = deformed(&pack, &values);
    let eye = pack.rig().joint("LtEyeJoint").expect("an eye").index();
    let eye = Vec3::from(pack.rig().world_from_bind()[eye].translation);
    // Half the way, in a direction twice as long; the cornea before the eyeball is looked through.
    let hit = pack.hit(&face, eye + 50.0 * Vec3::Z, -2.0 * Vec3::Z).expect("the eye");
    assert_eq!(pack.parts()[hit.part].name, "left-eyeball");
    assert!(hit.distance > 20.0 && hit.distance < 25.0, "{hit:?}");
    assert_eq!(pack.hit(&face[..0], eye + 50.0 * Vec3::Z, Vec3::NEG_Z), None, "no part is deformed");
}
