//! Animates a mesh by `Sequence`: whole geometries as keys in time. Prints how high a drop of three vertices
//! is, plays it with two transitions, and turns the keys into blend shapes: `cargo run -p avatar-mesh
//! --example key_shapes`

use avatar_mesh::sequence::{Sequence, SequenceKey};
use glam::Vec3;
use std::error::Error;

/// A drop that hangs, falls and lies flat.
fn drop(time_secs: f64, height: f32, width: f32) -> SequenceKey {
    let positions = vec![
        Vec3::new(-width, height, 0.0),
        Vec3::new(width, height, 0.0),
        Vec3::new(0.0, height + 1.0 / width, 0.0),
    ];
    SequenceKey { time_secs, positions }
}

fn bar(value: f32) -> String {
    "#".repeat((value * 4.0).round().max(0.0) as usize)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut sequence = Sequence::new(vec![drop(0.0, 6.0, 0.5), drop(1.0, 0.0, 0.5), drop(1.25, 0.0, 2.0)])?;
    let steady = |s: f32| s;
    let falling = |s: f32| s * s;
    let mut positions = vec![Vec3::ZERO; sequence.vertex_count()];

    for (name, transition) in [("steadily", &steady as &dyn Fn(f32) -> f32), ("falling", &falling)] {
        println!("height of the drop, {name}:");
        for step in 0..=5 {
            let time_secs = f64::from(step) * 0.25;
            sequence.positions(time_secs, transition, &mut positions)?;
            let height = positions[0].y;
            println!("  {time_secs:.2} s  {height:>5.2}  {}", bar(height));
        }
    }

    // An in-between becomes a key of its own, and moves: the drop hangs in the air for a while.
    let baked = sequence.bake(0.5, falling)?;
    let baked = sequence.move_to(baked, 0.9)?;
    println!("key {baked} was baked at 0.5 s and moved to {} s", sequence.keys()[baked].time_secs);

    // Renderers that blend by weights take the keys as shapes of a base; the weights of a time are theirs.
    let base = sequence.keys()[0].positions.clone();
    let shapes = sequence.shapes(&base, |key| format!("key {key}"))?;
    let mut weights = vec![0.0; shapes.len()];
    sequence.weights(0.95, steady, &mut weights)?;
    for (shape, weight) in shapes.iter().zip(&weights) {
        println!("  {}: moves {} vertices, weight at 0.95 s {weight:.2}", shape.name, shape.moved_vertices());
    }
    Ok(())
}
