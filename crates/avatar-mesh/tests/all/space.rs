//! Points of shape spaces, their mixtures, and meshes that lack some axes.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::Random;
use avatar_mesh::drivers::LengthError;
use avatar_mesh::space::{Coordinates, ShapeSpace};
use avatar_mesh::{Mesh, Shape, ShapeNormals, blend};
use glam::Vec3;
use proptest::prelude::*;

fn blended(mesh: &Mesh, weights: &[f32]) -> Vec<Vec3> {
    let mut out = mesh.deformed();
    blend(mesh, weights, ShapeNormals::Unblended, &mut out).unwrap();
    out.positions
}

proptest! {
    /// Mixing points is mixing what they look like: offsets from the base add up as the shares do.
    #[test]
    fn mixtures_of_points_look_like_mixtures_of_faces(seed in any::<u64>(), shares in [-1.0..2.0f32, -1.0..2.0f32]) {
        let mut random = Random(seed);
        let mesh = random.mesh(8, 4, 1);
        let space = ShapeSpace::of(&mesh);
        let faces = [(); 2].map(|()| -> Vec<f32> { (0..4).map(|_| if random.below(3) == 0 { 0.0 } else { random.signed() }).collect() });
        let points = [space.point(&faces[0]), space.point(&faces[1])];
        let mixed = Coordinates::mixed(shares.into_iter().zip(&points));
        let mut weights = [f32::NAN; 4];
        space.weights(&mixed, &mut weights, |axis, _| panic!("{axis}")).unwrap();
        let looks = [blended(&mesh, &faces[0]), blended(&mesh, &faces[1])];
        for (vertex, found) in blended(&mesh, &weights).into_iter().enumerate() {
            let base = mesh.positions[vertex];
            let expected = base + shares[0] * (looks[0][vertex] - base) + shares[1] * (looks[1][vertex] - base);
            // Coordinates up to 32; a dozen roundings.
            prop_assert!(found.distance(expected) < 2e-5);
        }
        // And a point comes back as it was.
        for (face, point) in faces.iter().zip(&points) {
            space.weights(point, &mut weights, |axis, _| panic!("{axis}")).unwrap();
            prop_assert_eq!(&weights[..], &face[..]);
        }
    }
}

#[test]
fn axes_that_a_mesh_lacks_are_reported_and_the_rest_counts() {
    let names = ["smile", "frown", "smile"];
    let shapes = names.map(|name| Shape::new(name, vec![Vec3::X])).into();
    let space = ShapeSpace::of(&Mesh { shapes, ..Mesh::default() });
    assert_eq!(space.axes(), names);
    let point = Coordinates::from([("smile", 0.5), ("wings", 2.0), ("antlers", -1.0), ("smile", 0.75)]);
    let mut weights = [9.0; 3];
    let mut unknown = Vec::new();
    space.weights(&point, &mut weights, |axis, weight| unknown.push((axis.to_owned(), weight))).unwrap();
    assert_eq!(weights, [0.75, 0.0, 0.75]);
    assert_eq!(unknown, [("antlers".to_owned(), -1.0), ("wings".to_owned(), 2.0)]);
    let error = space.weights(&point, &mut [0.0; 2], |_, _| ()).unwrap_err();
    assert_eq!(error, LengthError { what: "weights", expected: 3, found: 2 });
    assert_eq!(error.to_string(), "expected 3 weights, found 2");
    assert_eq!(space.point(&[0.0, 0.25]), Coordinates::from([("frown", 0.25)]));
    assert_eq!(Coordinates::mixed([]), Coordinates::default());
}
