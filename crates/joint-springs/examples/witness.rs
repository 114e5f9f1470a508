//! Prints JSON of a chain with colliders on a head that moves: how it moves, and where the joints' tails are
//! found. scripts/check-springs has another program compute the same.
//!
//! `cargo run -p joint-springs --example witness RATE`: frames a second.

use glam::{Affine3A, EulerRot, Quat, Vec3};
use joint_springs::{Collider, Law, Shape, Spring, Swing};
use std::f64::consts::TAU;

const JOINTS: usize = 5;

#[allow(clippy::disallowed_methods, reason = "a program reads its command line")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rate: f64 = std::env::args().nth(1).ok_or("usage: witness RATE")?.parse()?;
    let shapes = [
        Shape::Sphere { offset: Vec3::new(0.0, 0.02, 0.0), radius: 0.09, inside: false },
        Shape::Capsule {
            offset: Vec3::new(-0.1, -0.25, 0.0),
            tail: Vec3::new(0.1, -0.25, 0.0),
            radius: 0.06,
            inside: false,
        },
    ];
    let mut cases = Vec::new();
    for (stiffness, drag, gravity, hits) in [
        (1.0, 0.4, Vec3::ZERO, false),
        (0.5, 0.2, Vec3::new(0.0, -0.1, 0.0), false),
        (3.0, 0.6, Vec3::new(0.05, -0.5, 0.02), false),
        (0.15, 0.1, Vec3::new(0.0, -0.05, 0.0), true),
        (0.8, 0.5, Vec3::new(0.0, -1.0, 0.0), true),
        (0.0, 0.9, Vec3::new(0.0, -0.2, 0.0), true),
    ] {
        let colliders: Vec<_> =
            if hits { shapes.map(|shape| Collider { joint: 0, shape }).into() } else { vec![] };
        let numbers = (0..colliders.len()).collect::<Vec<_>>();
        let law = Law::Vrm { stiffness, drag, gravity };
        let spring = |joint| Spring {
            hit_radius: 0.01,
            colliders: numbers.clone(),
            ..Spring::new(joint, tail(), law)
        };
        let parents: Vec<_> = (0..=JOINTS).map(|joint: usize| joint.checked_sub(1)).collect();
        let mut swing = Swing::new(&parents, (1..=JOINTS).map(spring).collect(), colliders)?;
        let mut frames = Vec::new();
        for frame in 0..=(8.0 * rate) as u32 {
            let (turn, place) = head(f64::from(frame) / rate);
            let mut world = [Affine3A::from_rotation_translation(turn, place); JOINTS + 1];
            for joint in 1..=JOINTS {
                let offset = if joint == 1 { Vec3::new(0.0, 0.0, -0.11) } else { tail() };
                world[joint] = world[joint - 1] * Affine3A::from_translation(offset);
            }
            swing.advance(if frame == 0 { 0.0 } else { 1.0 / rate }, &mut world)?;
            let tails: Vec<_> =
                world[1..].iter().flat_map(|joint| joint.transform_point3(tail()).to_array()).collect();
            let [turn, place] = [turn.to_array().to_vec(), place.to_array().to_vec()];
            frames.push(format!("{{\"turn\":{turn:?},\"place\":{place:?},\"tails\":{tails:?}}}"));
        }
        let gravity = gravity.to_array();
        cases.push(format!(
            "{{\"stiffness\":{stiffness},\"drag\":{drag},\"gravity\":{gravity:?},\"hits\":{hits},\"frames\":[{}]}}",
            frames.join(",\n")
        ));
    }
    println!("[{}]", cases.join(",\n"));
    Ok(())
}

/// Where the next joint of the chain is.
fn tail() -> Vec3 {
    Vec3::new(0.0, -0.06, -0.01)
}

/// How the head moves: a turn by 30 degrees and back within a second, nods, and steps to the side.
fn head(secs: f64) -> (Quat, Vec3) {
    let wave = |hz: f64, phase: f64| ((TAU * hz * secs + phase).sin() - phase.sin()) as f32;
    let turn =
        Quat::from_euler(EulerRot::YXZ, 0.5 * wave(0.9, 0.0), 0.2 * wave(0.7, 1.0), 0.1 * wave(0.5, 2.0));
    (turn, Vec3::new(0.04 * wave(0.8, 0.5), 1.5 + 0.02 * wave(1.1, 0.0), 0.03 * wave(0.4, 1.0)))
}
