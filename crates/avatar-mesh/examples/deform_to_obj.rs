//! Bends a strip of quads with two bones and one blend shape and prints it as OBJ:
//! `cargo run -p avatar-mesh --example deform_to_obj > bent.obj`

use avatar_mesh::{Mesh, Shape, Skinning, deform, obj};
use glam::{Affine3A, Quat, Vec2, Vec3};
use std::error::Error;

const STEPS: u32 = 16;

fn main() -> Result<(), Box<dyn Error>> {
    let mut mesh = Mesh::default();
    let mut skinning = Skinning::default();
    let (mut bulge, mut tilt) = (Vec::new(), Vec::new());
    for step in 0..=STEPS {
        let t = step as f32 / STEPS as f32;
        for side in [-1.0, 1.0] {
            mesh.positions.push(Vec3::new(side, 10.0 * t, 0.0));
            mesh.uvs.push(Vec2::new(side * 0.5 + 0.5, 1.0 - t));
            mesh.normals.push(Vec3::Z);
            skinning.bones.push([0, 1, 0, 0]);
            skinning.weights.push([1.0 - t, t, 0.0, 0.0]);
            bulge.push(Vec3::Z * (t * (1.0 - t)));
            tilt.push(Vec3::Y * (2.0 * t - 1.0));
        }
    }
    for step in 0..STEPS {
        let [a, b, c, d] = [0, 1, 2, 3].map(|corner| 2 * step + corner);
        mesh.triangles.extend([[a, b, d], [a, d, c]]);
    }
    mesh.skinning = Some(skinning);
    mesh.shapes.push(Shape::new("Bulge", bulge).with_normals(tilt));
    for warning in mesh.validate(2)? {
        eprintln!("{warning}");
    }

    // The lower bone rests; the upper one turns about the strip's middle.
    let middle = Vec3::Y * 5.0;
    let turn = Affine3A::from_quat(Quat::from_rotation_x(60f32.to_radians()));
    let bones =
        [Affine3A::IDENTITY, Affine3A::from_translation(middle) * turn * Affine3A::from_translation(-middle)];
    let mut bent = mesh.deformed();
    deform(&mesh, &bones, &[1.5], &mut bent)?;
    print!("{}", obj::write("bent strip", &bent, &mesh.triangles));
    Ok(())
}
