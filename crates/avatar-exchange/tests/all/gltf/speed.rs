//! How long reading takes beside copying; prints, and is run on its own:
//! `cargo test --release -p avatar-exchange --test all speed -- --ignored --nocapture`.

use crate::support::gltf::{Builder, one_primitive, read};
use std::time::{Duration, Instant};

const SHAPES: usize = 50;
const VERTICES: usize = 60_000;
const ROUNDS: usize = 9;

fn median(mut run: impl FnMut()) -> Duration {
    let mut times: Vec<_> = (0..ROUNDS)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed()
        })
        .collect();
    times.sort();
    times[ROUNDS / 2]
}

/// Dense shapes, positions and normals.
#[test]
#[ignore = "measures time"]
fn dense_shapes_cost_at_most_two_copies() {
    let values: Vec<f32> = (0..3 * VERTICES).map(|i| (i % 1009) as f32 * 0.001).collect();
    let mut file = Builder::default();
    let (position, normal) = (file.floats(&values, "VEC3"), file.floats(&values, "VEC3"));
    let targets: Vec<_> = (0..SHAPES)
        .map(|_| {
            let (positions, normals) = (file.floats(&values, "VEC3"), file.floats(&values, "VEC3"));
            format!(r#"{{"POSITION": {positions}, "NORMAL": {normals}}}"#)
        })
        .collect();
    let glb = file.glb(&one_primitive(&format!(
        r#"{{"attributes": {{"POSITION": {position}, "NORMAL": {normal}}}, "targets": [{}]}}"#,
        targets.join(", ")
    )));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("shapes.glb");
    std::fs::write(&path, &glb).expect("a file");

    let copying = median(|| {
        let bytes = std::fs::read(&path).expect("a file");
        std::hint::black_box(bytes.clone());
    });
    let reading = median(|| {
        let scene = read(&std::fs::read(&path).expect("a file")).expect("a scene");
        assert_eq!(std::hint::black_box(scene).parts[0].mesh.shapes.len(), SHAPES);
    });
    let ratio = reading.as_secs_f64() / copying.as_secs_f64();
    println!(
        "{} MB: reading the file and copying its bytes {copying:.1?}, reading the scene {reading:.1?}: ratio {ratio:.2}",
        glb.len() / 1_000_000
    );
    assert!(ratio <= 2.0, "{ratio}");
}
