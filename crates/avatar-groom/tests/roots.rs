//! Roots: as many as the density asks for, evenly where it is even, the same every time.
#![allow(clippy::expect_used, reason = "a test may panic")]

use avatar_groom::{DensityMap, Style, scatter};
use avatar_mesh::Mesh;
use glam::{Vec2, Vec3};

/// A strip of `n` × `n` squares of two triangles, 1 × 1, painted 1 : 1.
fn plate(n: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for row in 0..=n {
        for column in 0..=n {
            let uv = Vec2::new(column as f32, row as f32) / n as f32;
            mesh.positions.push(Vec3::new(uv.x, 1.0 - uv.y, 0.0));
            mesh.uvs.push(uv);
            mesh.normals.push(Vec3::Z);
        }
    }
    let across = n + 1;
    for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
        let a = row * across + column;
        mesh.triangles.extend([[a, a + across, a + 1], [a + 1, a + across, a + across + 1]]);
    }
    mesh
}

/// A smooth random map, from sums of waves with random directions, and its integral by the middles of its own pixels.
fn map(seed: u64) -> (DensityMap, f64) {
    let wave = |k: u64| {
        let h = (seed * 31 + k).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
        (h & 7) as f32 + 1.0
    };
    let value = |x: f32, y: f32| {
        let sum = (0..3).map(|k| (wave(k) * x * 6.0 + wave(k + 7) * y * 5.0 + k as f32).sin()).sum::<f32>();
        (0.5 + sum / 5.0).clamp(0.0, 1.0)
    };
    let size = 64;
    let pixels = (0..size).flat_map(|y| (0..size).map(move |x| (x, y)));
    let values: Vec<u8> =
        pixels.map(|(x, y)| (value(x as f32 / 64.0, y as f32 / 64.0) * 255.0) as u8).collect();
    let integral = values.iter().map(|v| f64::from(*v) / 255.0).sum::<f64>() / values.len() as f64;
    (DensityMap::new(size, size, values).expect("as many values as pixels"), integral)
}

#[test]
fn counts_follow_the_integral_of_density_times_area_on_100_random_maps() {
    let mesh = plate(24);
    for seed in 0..100 {
        let (density, integral) = map(seed);
        let found = scatter(&mesh, &density, &[], &Style::SHORT, 20_000.0, seed).len() as f64;
        let expected = 20_000.0 * integral;
        assert!((found - expected).abs() <= 0.02 * expected, "{seed}: {found}, expected {expected}");
    }
}

#[test]
fn no_density_grows_nothing_and_neither_does_an_empty_mesh() {
    let dark = DensityMap::new(2, 2, vec![0; 4]).expect("a map");
    assert!(scatter(&plate(4), &dark, &[], &Style::SHORT, 1e5, 1).is_empty());
    let light = DensityMap::new(2, 2, vec![255; 4]).expect("a map");
    assert!(scatter(&Mesh::default(), &light, &[], &Style::SHORT, 1e5, 1).is_empty());
    assert!(scatter(&plate(4), &light, &[], &Style::SHORT, 0.0, 1).is_empty());
    assert!(scatter(&plate(4), &light, &[], &Style::BALD, 1e4, 1).is_empty());
}

/// 16 cells of equal area on one triangle: with v = 1 − √(1 − a) and u = b (1 − v) equal steps of a and b are equal areas.
#[test]
fn a_chi_square_test_accepts_the_distribution_on_a_triangle() {
    let mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::Y],
        normals: vec![Vec3::Z; 3],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let even = DensityMap::new(1, 1, vec![255]).expect("a map");
    for seed in 0..8 {
        let roots = scatter(&mesh, &even, &[], &Style::SHORT, 16_000.0, seed);
        let mut cells = [0u32; 16];
        for root in &roots {
            let [_, u, v] = root.barycentric;
            let a = 1.0 - (1.0 - v) * (1.0 - v);
            let b = u / (1.0 - v).max(1e-6);
            let cell = |x: f32| ((x * 4.0) as usize).min(3);
            cells[cell(a) * 4 + cell(b)] += 1;
        }
        let expected = roots.len() as f64 / 16.0;
        let chi: f64 = cells.iter().map(|n| (f64::from(*n) - expected).powi(2) / expected).sum();
        // 15 degrees of freedom: one in a thousand is above 37.7.
        assert!(chi < 37.7, "{seed}: {chi}, {cells:?}");
    }
}

#[test]
fn the_first_strands_are_a_fair_sample_of_all() {
    let (density, _) = map(3);
    let roots = scatter(&plate(24), &density, &[], &Style::SHORT, 40_000.0, 5);
    let half = |roots: &[avatar_groom::Root]| {
        roots.iter().filter(|root| root.triangle < 24 * 24).count() as f64 / roots.len() as f64
    };
    // A fair sample of 2000 is off by more than 4 % less than once in 3000 times.
    assert!((half(&roots[..2000]) - half(&roots)).abs() < 0.04);
}

#[test]
fn the_same_seed_gives_the_same_roots_and_another_one_others() {
    let (density, _) = map(1);
    let roots = |seed| scatter(&plate(8), &density, &[], &Style::SHORT, 1000.0, seed);
    assert_eq!(roots(1), roots(1));
    assert_ne!(roots(1), roots(2));
}
