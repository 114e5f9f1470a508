use crate::{DensityMap, Region, Regions, Root, density_area, scatter};
use avatar_mesh::{Bounds, Mesh};
use glam::{Vec2, Vec3};
use std::time::Instant;

/// A bumpy sheet of `n` × `n` squares over the whole texture.
fn sheet(n: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for row in 0..=n {
        for column in 0..=n {
            let uv = Vec2::new(column as f32, row as f32) / n as f32;
            let height = 0.3 * (uv.x * 7.0).sin() * (uv.y * 5.0).cos();
            mesh.positions.push(Vec3::new(3.0 * uv.x * uv.x + uv.x, -4.0 * uv.y, height));
            mesh.uvs.push(uv);
            mesh.normals.push(Vec3::Z);
        }
    }
    for row in 0..n {
        for column in 0..n {
            let a = row * (n + 1) + column;
            let (b, c, d) = (a + 1, a + n + 1, a + n + 2);
            mesh.triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    mesh
}

fn one_triangle() -> Mesh {
    Mesh {
        positions: vec![Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(0.0, 2.0, 1.0)],
        uvs: vec![Vec2::new(0.1, 0.1), Vec2::new(0.9, 0.2), Vec2::new(0.2, 0.9)],
        normals: vec![Vec3::Z; 3],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    }
}

fn random_map(seed: u64, width: u32, height: u32) -> DensityMap {
    let stream = crate::random::Stream::new(seed);
    let values = (0..u64::from(width * height)).map(|i| (stream.unit(i) * 1.6 - 0.6).max(0.0)).collect();
    DensityMap::new(width, height, values).expect("a map")
}

fn even() -> DensityMap {
    DensityMap::new(1, 1, vec![1.0]).expect("a map")
}

fn uv_of(mesh: &Mesh, root: &Root) -> Vec2 {
    (0..3).map(|i| mesh.uvs[root.corners[i] as usize] * root.barycentric[i]).sum()
}

/// The integral of density × area over the mesh where `inside` says so, by brute force.
fn integral(mesh: &Mesh, map: &DensityMap, inside: impl Fn(Vec2) -> bool) -> f64 {
    const N: u32 = 24;
    let mut sum = 0.0;
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize].as_dvec3());
        let area = (b - a).cross(c - a).length() / 2.0;
        let [a, b, c] = corners.map(|i| mesh.uvs[i as usize]);
        for i in 0..N {
            for j in 0..2 * (N - i) - 1 {
                let third = if j % 2 == 0 { 1.0 / 3.0 } else { 2.0 / 3.0 };
                let (v, w) = (((j / 2) as f32 + third) / N as f32, (i as f32 + third) / N as f32);
                let uv = a + (b - a) * v + (c - a) * w;
                if inside(uv) {
                    sum += area * f64::from(map.at(uv)) / f64::from(N * N);
                }
            }
        }
    }
    sum
}

#[test]
fn counts_follow_the_integral_of_density_over_area_on_random_maps() {
    let mesh = sheet(8);
    for seed in 0..100 {
        let map = random_map(seed, 11 + seed as u32 % 7, 9 + seed as u32 % 5);
        let count = 40_000;
        let roots = scatter(&mesh, &map, &Regions::default(), [count, 0, 0], seed);
        assert_eq!(roots.len(), count as usize);
        let all = integral(&mesh, &map, |_| true);
        let own = density_area(&mesh, &map, &Regions::default())[0];
        assert!((own - all).abs() < 0.005 * all, "seed {seed}: {own} for {all}");
        for half in 0..4 {
            let inside = |uv: Vec2| [uv.x < 0.5, uv.x >= 0.5, uv.y < 0.5, uv.y >= 0.5][half];
            let expected = f64::from(count) * integral(&mesh, &map, inside) / all;
            let found = roots.iter().filter(|root| inside(uv_of(&mesh, root))).count() as f64;
            assert!((found - expected).abs() < 0.02 * expected, "seed {seed}: {found} for {expected}");
        }
    }
}

#[test]
fn each_triangle_has_its_share_to_within_one_strand() {
    let (mesh, map) = (sheet(12), random_map(3, 64, 64));
    let roots = scatter(&mesh, &map, &Regions::default(), [9_000, 0, 0], 5);
    let all = density_area(&mesh, &map, &Regions::default())[0];
    let mut counts = vec![0u32; mesh.triangles.len()];
    roots.iter().for_each(|root| counts[root.triangle as usize] += 1);
    for (triangle, &count) in counts.iter().enumerate() {
        let alone = Mesh { triangles: vec![mesh.triangles[triangle]], ..mesh.clone() };
        let share = 9_000.0 * density_area(&alone, &map, &Regions::default())[0] / all;
        assert!((f64::from(count) - share).abs() < 1.0 + 1e-6, "{triangle}: {count} for {share}");
    }
}

#[test]
fn nothing_grows_without_density() {
    let mesh = sheet(4);
    let none = DensityMap::new(4, 4, vec![0.0; 16]).expect("a map");
    assert_eq!(scatter(&mesh, &none, &Regions::default(), [1000; 3], 1), []);
    assert_eq!(scatter(&mesh, &even(), &Regions::default(), [0; 3], 1), []);
    // Half of the map is bare, and no root strays there.
    let half: Vec<f32> = (0..64 * 64).map(|i| if i % 64 < 32 { 0.0 } else { 1.0 }).collect();
    let map = DensityMap::new(64, 64, half).expect("a map");
    let roots = scatter(&mesh, &map, &Regions::default(), [20_000, 0, 0], 1);
    assert!(roots.iter().all(|root| map.at(uv_of(&mesh, root)) > 0.0));
}

#[test]
fn roots_spread_over_a_triangle_as_the_density_does() {
    let mesh = one_triangle();
    let ramp: Vec<f32> = (0..64 * 64).map(|i| (i % 64) as f32 / 63.0).collect();
    for map in [even(), DensityMap::new(64, 64, ramp).expect("a map")] {
        // Sixteen alike pieces: 15 degrees of freedom, beyond 37.7 once in a thousand.
        let cell = |weights: Vec3| {
            let (v, w) = (weights.y * 4.0, weights.z * 4.0);
            let (i, j) = ((w as usize).min(3), (v as usize).min(3));
            let turned = v.fract() + w.fract() > 1.0;
            [0, 7, 12, 15][i] + 2 * j + usize::from(turned)
        };
        let mut expected = [0.0f64; 16];
        for i in 0..400 {
            for j in 0..400 - i {
                let weights = Vec3::new(0.0, (j as f32 + 0.3) / 400.0, (i as f32 + 0.3) / 400.0);
                let (v, w) = (weights.y, weights.z);
                let uv = mesh.uvs[0] * (1.0 - v - w) + mesh.uvs[1] * v + mesh.uvs[2] * w;
                expected[cell(weights)] += f64::from(map.at(uv));
            }
        }
        let total: f64 = expected.iter().sum();
        for seed in 0..40 {
            let roots = scatter(&mesh, &map, &Regions::default(), [4_000, 0, 0], seed);
            // A prefix as well as the whole: the order is random.
            for count in [roots.len() / 4, roots.len()] {
                let mut found = [0u32; 16];
                roots[..count].iter().for_each(|root| found[cell(root.barycentric.into())] += 1);
                let chi_square: f64 = (found.iter().zip(&expected))
                    .map(|(&found, part)| (f64::from(found), part / total * count as f64))
                    .map(|(found, expected)| (found - expected).powi(2) / expected)
                    .sum();
                assert!(chi_square < 37.7, "seed {seed}, {count} roots: {chi_square} of {found:?}");
            }
        }
    }
}

#[test]
fn every_prefix_is_a_fair_sample() {
    let (mesh, map) = (sheet(8), random_map(9, 32, 32));
    let roots = scatter(&mesh, &map, &Regions::default(), [60_000, 0, 0], 2);
    let group = |root: &Root| root.triangle as usize / 8;
    let mut all = vec![0.0f64; 16];
    roots.iter().for_each(|root| all[group(root)] += 1.0 / roots.len() as f64);
    for count in [500, 1_000, 5_000, 20_000] {
        let mut found = vec![0.0f64; 16];
        roots[..count].iter().for_each(|root| found[group(root)] += 1.0);
        let chi_square: f64 = (found.iter().zip(&all))
            .map(|(found, share)| (found - share * count as f64).powi(2) / (share * count as f64))
            .sum();
        assert!(chi_square < 37.7, "{count}: {chi_square}");
        let mean = roots[..count].iter().map(|root| f64::from(root.random[2])).sum::<f64>() / count as f64;
        assert!((mean - 0.5).abs() < 4.0 * (1.0 / 12.0f64).sqrt() / (count as f64).sqrt(), "{mean}");
    }
}

#[test]
fn the_same_input_gives_the_same_roots_and_another_seed_others() {
    // Without sines, which machines disagree about.
    let (mesh, map) = (one_triangle(), random_map(4, 20, 20));
    let of = |seed| scatter(&mesh, &map, &Regions::default(), [3_000, 0, 0], seed);
    assert_eq!(of(1), of(1));
    assert_ne!(of(1), of(2));
    // What a machine must not change: these stood here when the test was written.
    let bits = of(1).iter().fold(0u64, |sum, root| {
        let words = root.barycentric.map(f32::to_bits).into_iter().chain(root.random.map(f32::to_bits));
        words.fold(sum ^ u64::from(root.triangle), |sum, word| sum.rotate_left(7) ^ u64::from(word))
    });
    assert_eq!(bits, EXPECTED_BITS, "{bits:#x}");
}

const EXPECTED_BITS: u64 = 0x364000a4adcdad35;

#[test]
fn regions_are_told_apart_by_the_eyes() {
    let eye = |x: f32| Bounds { min: Vec3::new(x - 1.0, -1.0, -1.0), max: Vec3::new(x + 1.0, 1.0, 1.0) };
    let regions = Regions::new(&[eye(-2.0), eye(2.0)]);
    assert_eq!(regions.at(Vec3::new(2.0, 0.3, 1.1)), Some(Region::Lashes));
    assert_eq!(regions.at(Vec3::new(-2.5, 1.4, 1.0)), Some(Region::Brows));
    assert_eq!(regions.at(Vec3::new(0.0, 5.0, 0.0)), Some(Region::Scalp));
    assert_eq!(regions.at(Vec3::new(3.9, 1.5, -1.5)), Some(Region::Scalp), "the temple");
    assert_eq!(Regions::default().at(Vec3::new(2.0, 0.3, 1.1)), Some(Region::Scalp));
    let strip = regions.with_strip(0.0, 0.5);
    assert_eq!(strip.at(Vec3::new(0.6, 5.0, 0.0)), None);
    assert_eq!(strip.at(Vec3::new(2.0, 0.3, 1.1)), Some(Region::Lashes));
    let roots = scatter(&sheet(8), &even(), &Regions::default().with_strip(2.0, 0.25), [5_000, 100, 100], 1);
    let mesh = sheet(8);
    assert_eq!(roots.len(), 5_000, "no eyes: no brows and no lashes");
    for root in roots {
        let x: f32 = (0..3).map(|i| mesh.positions[root.corners[i] as usize].x * root.barycentric[i]).sum();
        assert!((x - 2.0).abs() < 0.26, "{x}");
    }
}

#[test]
fn meshes_that_are_not_whole_grow_what_they_can() {
    let mut mesh = one_triangle();
    mesh.triangles.extend([[0, 1, 9], [1, 1, 1], [2, 2, 0]]);
    mesh.positions[0].x = 0.5;
    assert_eq!(scatter(&mesh, &even(), &Regions::default(), [50, 0, 0], 1).len(), 50);
    mesh.positions[0].x = f32::NAN;
    assert_eq!(scatter(&mesh, &even(), &Regions::default(), [50, 0, 0], 1), []);
    assert_eq!(scatter(&Mesh::default(), &even(), &Regions::default(), [50, 0, 0], 1), []);
    let far = DensityMap::new(3, 1, vec![1e30, 0.0, 1e-30]).expect("a map");
    assert_eq!(scatter(&one_triangle(), &far, &Regions::default(), [50, 0, 0], 1).len(), 50);
}

/// Prints; `cargo test --release -p avatar-hair -- --ignored --nocapture` on a machine at rest says how fast it is.
#[test]
#[ignore = "measures"]
fn how_fast_roots_are_scattered() {
    let skin = super::marsienne::skin();
    let start = Instant::now();
    let roots = scatter(&skin.mesh, &skin.density, &skin.regions, [150_000, 2_000, 600], 1);
    println!("{} roots in {:?}", roots.len(), start.elapsed());
    assert!(start.elapsed().as_secs_f64() < 0.1);
}
