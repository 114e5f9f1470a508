//! What runs every frame allocates nothing.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

#[path = "all/common/mod.rs"]
mod common;

use avatar_mesh::drivers::{Input, Rule, ShapeDrivers, ShapeRule};
use avatar_mesh::sequence::{Sequence, SequenceKey};
use avatar_mesh::space::{Coordinates, ShapeSpace};
use avatar_mesh::{DeformBounds, ShapeNormals, SmoothNormals, deform, deform_with, weights};
use common::Random;
use glam::{Affine3A, Vec3, Vec4};

#[track_caller]
fn nothing(what: &str, run: impl FnOnce()) {
    let info = allocation_counter::measure(run);
    assert_eq!(info.count_total, 0, "{what}");
}

#[test]
fn frames_allocate_nothing() {
    let mut random = Random(4);
    let mut mesh = random.mesh(100, 4, 3);
    mesh.tangents = vec![Vec4::X; 100];
    mesh.shapes[1].positions = (0..100).map(|v| if v < 9 { Vec3::X } else { Vec3::ZERO }).collect();
    mesh.shapes[2].tangents = Some(vec![Vec3::Y; 100].into());
    let bones: Vec<Affine3A> = (0..3).map(|_| random.rigid()).collect();
    let (mut out, mut smooth, bounds) =
        (mesh.deformed(), SmoothNormals::new(&mesh), DeformBounds::new(&mesh));
    let mut w = [0.5, -0.5, 1.0, 2.0];
    // The measure itself works.
    assert!(allocation_counter::measure(|| drop(mesh.deformed())).count_total > 0);
    nothing("deform", || deform(&mesh, &bones, &w, &mut out).unwrap());
    nothing("recomputed normals", || {
        deform_with(&mesh, &bones, &w, ShapeNormals::Recomputed(&mut smooth), &mut out).unwrap();
    });
    let mut eight = mesh.clone();
    random.add_further_bones(&mut eight, 3);
    let uneven: Vec<Affine3A> = (0..3).map(|_| random.uneven()).collect();
    nothing("deform by eight uneven bones", || deform(&eight, &uneven, &w, &mut out).unwrap());
    nothing("bounds", || assert!(bounds.around(&bones, &w).is_some()));
    nothing("weights", || {
        weights::normalise(&mut w);
        weights::clamp(&mut w, 0.0, 1.0);
    });

    let input = || Input::Driver("x".to_owned());
    let rules = [
        ShapeRule { shape: "a".to_owned(), rule: Rule::Follows { input: input(), full_weight: 0.5 } },
        ShapeRule { shape: "b".to_owned(), rule: Rule::Product(vec![Input::Shape("a".to_owned()), input()]) },
    ];
    let drivers = ShapeDrivers::new(&["x"], &["a", "b"], &rules).unwrap();
    nothing("drivers", || drivers.run(&[0.3], &mut w[..2]).unwrap());
    let mut lanes = [lanes::Lanes::splat(0.3); 4];
    nothing("drivers of a crowd", || {
        let (values, weights) = lanes.split_at_mut(2);
        drivers.run_crowd(1, &values[..1], weights).unwrap();
    });

    let key = |time_secs| SequenceKey { time_secs, positions: mesh.positions.clone() };
    let sequence = Sequence::new(vec![key(0.0), key(1.0)]).unwrap();
    nothing("sequence", || {
        sequence.weights(0.3, |s| s * s, &mut w[..2]).unwrap();
        sequence.positions(0.3, |s| s * s, &mut out.positions).unwrap();
    });

    let (space, point) = (ShapeSpace::of(&mesh), Coordinates::from([("shape 1", 0.5), ("elsewhere", 1.0)]));
    let mut unknown = 0;
    nothing("space", || space.weights(&point, &mut w, |_, _| unknown += 1).unwrap());
    assert_eq!((unknown, w), (1, [0.0, 0.5, 0.0, 0.0]));
}
