//! Mixes faces in a `ShapeSpace`: each is a point, and points add up. Prints the coordinates of a mixture and
//! where a vertex of the mesh goes: `cargo run -p avatar-mesh --example mix_faces`

use avatar_mesh::space::{Coordinates, ShapeSpace};
use avatar_mesh::{Mesh, Shape, ShapeNormals, blend};
use glam::Vec3;
use std::error::Error;

/// Three points of a face: the tip of the nose and the corners of the mouth.
fn face() -> Result<Mesh, Box<dyn Error>> {
    let positions = vec![Vec3::new(0.0, 0.0, 2.0), Vec3::new(-1.0, -1.5, 1.0), Vec3::new(1.0, -1.5, 1.0)];
    let shapes = vec![
        Shape::from_pairs("long nose", 3, [(0, Vec3::Z)])?,
        Shape::from_pairs("wide mouth", 3, [(1, Vec3::NEG_X * 0.5), (2, Vec3::X * 0.5)])?,
        Shape::from_pairs("smile", 3, [(1, Vec3::Y * 0.4), (2, Vec3::Y * 0.4)])?,
    ];
    Ok(Mesh { normals: vec![Vec3::Z; 3], positions, shapes, ..Mesh::default() })
}

fn main() -> Result<(), Box<dyn Error>> {
    let mesh = face()?;
    let space = ShapeSpace::of(&mesh);
    println!("axes of the mesh: {}", space.axes().join(", "));

    // Two people and an expression. Names, not indices: they fit any mesh that has such shapes, in whatever
    // order.
    let anna = Coordinates::from([("long nose", 0.8), ("wide mouth", 0.2)]);
    let bert = Coordinates::from([("wide mouth", 1.0), ("beard", 1.0)]);
    let smiling = Coordinates::from([("smile", 1.0)]);

    for (what, parts) in [
        ("Anna", vec![(1.0, &anna)]),
        ("half Anna, half Bert", vec![(0.5, &anna), (0.5, &bert)]),
        ("the same, smiling a little", vec![(0.5, &anna), (0.5, &bert), (0.3, &smiling)]),
        ("Anna's opposite", vec![(-1.0, &anna)]),
    ] {
        let point = Coordinates::mixed(parts);
        let mut weights = vec![0.0; space.axes().len()];
        let mut missing = Vec::new();
        space.weights(&point, &mut weights, |axis, weight| missing.push(format!("{axis} {weight}")))?;
        let mut posed = mesh.deformed();
        blend(&mesh, &weights, ShapeNormals::Given, &mut posed)?;
        println!("\n{what}");
        for (axis, weight) in space.axes().iter().zip(&weights) {
            println!("  {axis:<11} {weight:>5.2}");
        }
        println!("  nose at     {:.2}", posed.positions[0]);
        println!("  mouth       {:.2} wide", posed.positions[2].x - posed.positions[1].x);
        if !missing.is_empty() {
            println!("  the mesh has no {}", missing.join(", "));
        }
    }
    Ok(())
}
