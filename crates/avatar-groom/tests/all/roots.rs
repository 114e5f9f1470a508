//! Roots: as many as the density asks for, evenly where it is even, the same every time.
#![allow(clippy::expect_used, reason = "a test may panic")]

use avatar_groom::{DensityMap, MAX_ROOTS, Region, Root, Style, scatter};
use avatar_mesh::{Bounds, Mesh};
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

/// A map with its values, to be read independently.
struct Map {
    size: usize,
    values: Vec<u8>,
}

impl Map {
    fn new(size: usize, value: impl Fn(usize, usize) -> u8) -> Self {
        let values = (0..size * size).map(|i| value(i % size, i / size)).collect();
        Self { size, values }
    }

    fn density(&self) -> DensityMap {
        DensityMap::new(self.size as u32, self.size as u32, self.values.clone())
            .expect("as many values as places")
    }

    /// Between the four nearest middles of values, over the edges.
    fn at(&self, x: f64, y: f64) -> f64 {
        let n = self.size as f64;
        let (x, y) = (x * n - 0.5, y * n - 0.5);
        let value = |x: f64, y: f64| {
            let (x, y) = (x.rem_euclid(n) as usize, y.rem_euclid(n) as usize);
            f64::from(self.values[y * self.size + x]) / 255.0
        };
        let (dx, dy) = (x - x.floor(), y - y.floor());
        let row = |y: f64| value(x.floor(), y) * (1.0 - dx) + value(x.floor() + 1.0, y) * dx;
        row(y.floor()) * (1.0 - dy) + row(y.floor() + 1.0) * dy
    }
}

fn random(seed: u64, counter: u64) -> u64 {
    // Marsaglia's xorshift, some steps.
    let mut x = (seed * 1_000_003 + counter).wrapping_mul(0x2545_F491_4F6C_DD1D) | 1;
    for _ in 0..3 {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
    }
    x >> 16
}

/// Random maps of several kinds: waves, noise, single spots, blocks with hard edges.
fn map(seed: u64) -> Map {
    let wave = |k: u64| (random(seed, k) % 8) as f64 + 1.0;
    match seed % 4 {
        0 => Map::new(64, |x, y| {
            let (x, y) = (x as f64 / 64.0, y as f64 / 64.0);
            let sum: f64 = (0..3).map(|k| (wave(k) * x * 6.0 + wave(k + 7) * y * 5.0 + k as f64).sin()).sum();
            ((0.5 + sum / 5.0).clamp(0.0, 1.0) * 255.0) as u8
        }),
        1 => Map::new(48, |x, y| random(seed, (y * 48 + x) as u64) as u8),
        2 => {
            Map::new(100, |x, y| if random(seed, (y * 100 + x) as u64).is_multiple_of(20) { 255 } else { 0 })
        }
        _ => Map::new(
            70,
            |x, y| if random(seed, (y / 9 * 70 + x / 9) as u64).is_multiple_of(3) { 200 } else { 0 },
        ),
    }
}

/// Density × area, as a share of the skin's height squared: the middles of 40 × 40 small triangles of each
/// triangle.
fn integral(mesh: &Mesh, map: &Map, steps: usize) -> f64 {
    let mut sum = 0.0;
    for triangle in &mesh.triangles {
        let corner = |k: usize| triangle[k] as usize;
        let [a, b, c] = [0, 1, 2].map(|k| mesh.positions[corner(k)].as_dvec3());
        let [ua, ub, uc] = [0, 1, 2].map(|k| mesh.uvs[corner(k)].as_dvec2());
        let area = (b - a).cross(c - a).length() / 2.0;
        let mut inside = 0.0;
        for i in 0..steps {
            for j in 0..steps - i {
                for third in [1.0, 2.0] {
                    if third == 2.0 && i + j + 1 == steps {
                        continue;
                    }
                    let (s, t) =
                        ((i as f64 + third / 3.0) / steps as f64, (j as f64 + third / 3.0) / steps as f64);
                    let uv = ua + (ub - ua) * s + (uc - ua) * t;
                    inside += map.at(uv.x, uv.y);
                }
            }
        }
        sum += area * inside / (steps * steps) as f64;
    }
    let height = f64::from(mesh.bounds().expect("a mesh").size().y);
    sum / (height * height)
}

#[test]
fn counts_follow_the_integral_of_density_times_area_on_100_random_maps() {
    for seed in 0..100 {
        let map = map(seed);
        // From two triangles with thousands of values each to many with a few; bent, so that areas differ.
        let (n, steps) = [(1, 400), (3, 140), (24, 20)][seed as usize / 4 % 3];
        let mut mesh = plate(n);
        mesh.positions.iter_mut().for_each(|p| *p = Vec3::new(p.x * (0.5 + p.x), p.y, p.x * p.y));
        let found = scatter(&mesh, &map.density(), &[], &Style::SHORT, 40_000.0, seed).len() as f64;
        let expected = 40_000.0 * integral(&mesh, &map, steps);
        assert!((found - expected).abs() <= 0.02 * expected, "{seed}: {found}, expected {expected}");
    }
}

#[test]
fn nothing_grows_where_the_density_is_0() {
    // Spots and blocks on black, on triangles much larger and much smaller than they are.
    for (seed, n) in [(2, 1), (3, 1), (6, 5), (7, 40), (10, 40), (11, 2)] {
        let (map, mesh) = (map(seed), plate(n));
        let roots = scatter(&mesh, &map.density(), &[], &Style::SHORT, 30_000.0, seed);
        assert!(roots.len() > 500, "{}", roots.len());
        for root in roots {
            let uv: Vec2 = (0..3).map(|i| mesh.uvs[root.corners[i] as usize] * root.barycentric[i]).sum();
            assert!(map.at(uv.x.into(), uv.y.into()) > 0.0, "{seed}: {uv}");
        }
    }
}

#[test]
fn a_single_spot_on_a_large_triangle_is_found_and_grows_its_share() {
    let map = Map::new(512, |x, y| if (200..204).contains(&x) && (100..104).contains(&y) { 255 } else { 0 });
    let roots = scatter(&plate(1), &map.density(), &[], &Style::SHORT, 1e7, 1);
    let expected = 1e7 * 16.0 / (512.0 * 512.0);
    assert!((roots.len() as f64 - expected).abs() < 0.02 * expected, "{} of {expected}", roots.len());
    // As dense in the middle as the map says: not crowded in any of the places of values.
    let mut columns = [0u32; 6];
    for root in &roots {
        let x = (0..3).map(|i| plate(1).uvs[root.corners[i] as usize].x * root.barycentric[i]).sum::<f32>()
            * 512.0;
        columns[(x - 199.0) as usize] += 1;
    }
    // A column at the edge has half a value's density, falling to 0 over it: an eighth beyond, seven eighths
    // within.
    for (found, share) in columns.iter().zip([0.125, 0.875, 1.0, 1.0, 0.875, 0.125]) {
        let wanted = expected * share / 4.0;
        assert!((f64::from(*found) - wanted).abs() < 5.0 * wanted.sqrt().max(3.0), "{columns:?}");
    }
}

#[test]
fn regions_grow_as_dense_as_their_styles_say() {
    let even = DensityMap::new(1, 1, vec![255]).expect("a map");
    // The plate is 1 high and wide; an eye lies in it.
    let (radius, center) = (0.08, Vec3::new(0.3, 0.4, 0.0));
    let eye = Bounds { min: center - radius, max: center + radius };
    let mut style = Style::SHORT;
    style.scalp.density = 0.5;
    style.brows.density = 3.0;
    style.lashes.density = 0.25;
    style.scalp.strip = 0.1;
    let strands = 50_000.0;
    let roots = scatter(&plate(64), &even, &[eye], &style, strands, 4);
    let count = |region| roots.iter().filter(|root| root.region == region).count() as f64;
    let r2 = f64::from(radius * radius);
    // A rectangle over the eye; a disc of 1.5 radii without its caps beyond 0.75; a strip in the middle of
    // the plate.
    let brows = 2.0 * 1.75 * (2.4 - 0.75) * r2;
    let half = (0.75f64 / 1.5).asin();
    let lashes = 2.0 * 1.5 * 1.5 * (half + half.sin() * half.cos()) * r2;
    // The brow reaches to 0.44, into the strip from 0.4 to 0.6; the eye's disc to 0.42.
    let brow_in_strip = 0.04 * (2.4 - 0.75) * 0.08;
    let lash_in_strip = lens(0.1 / 0.08, 1.5, 0.75) * r2;
    let scalp = 0.2 - brow_in_strip - lash_in_strip;
    for (region, area, density) in
        [(Region::Brows, brows, 3.0), (Region::Lashes, lashes, 0.25), (Region::Scalp, scalp, 0.5)]
    {
        let expected = f64::from(strands) * area * density;
        assert!(
            (count(region) - expected).abs() < 0.02 * expected,
            "{region:?}: {} of {expected}",
            count(region)
        );
    }
    for root in roots.iter().filter(|root| root.region == Region::Scalp) {
        let x: f32 = (0..3).map(|i| plate_x(root.corners[i]) * root.barycentric[i]).sum();
        assert!((x - 0.5).abs() < 0.1 + 1e-6, "{x}");
    }
}

/// X of a vertex of `plate(64)`.
fn plate_x(vertex: u32) -> f32 {
    (vertex % 65) as f32 / 64.0
}

/// Area of a disc beyond `from`, of its part at most `half` above and below, by thin columns.
fn lens(from: f64, radius: f64, half: f64) -> f64 {
    let steps = 100_000;
    let width = (radius - from) / steps as f64;
    let column = |i: usize| {
        let x = from + (i as f64 + 0.5) * width;
        2.0 * (radius * radius - x * x).max(0.0).sqrt().min(half)
    };
    (0..steps).map(column).sum::<f64>() * width
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

/// Roots on one triangle in n × n cells of equal area: with v = 1 − √(1 − a) and u = b (1 − v) equal steps of
/// a and b are equal areas.
fn chi_square(strands: f32, seed: u64, n: usize) -> f64 {
    let mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::Y],
        normals: vec![Vec3::Z; 3],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let even = DensityMap::new(64, 64, vec![255; 64 * 64]).expect("a map");
    let roots = scatter(&mesh, &even, &[], &Style::SHORT, strands, seed);
    let mut cells = vec![0u32; n * n];
    for root in &roots {
        let [w, u, v] = root.barycentric;
        assert!(w >= 0.0 && u >= 0.0 && v >= 0.0 && (w + u + v - 1.0).abs() < 1e-6, "{root:?}");
        let a = 1.0 - (1.0 - v) * (1.0 - v);
        let b = u / (1.0 - v).max(1e-6);
        let cell = |x: f32| ((x * n as f32) as usize).min(n - 1);
        cells[cell(a) * n + cell(b)] += 1;
    }
    let expected = roots.len() as f64 / (n * n) as f64;
    cells.iter().map(|count| (f64::from(*count) - expected).powi(2) / expected).sum()
}

#[test]
fn a_chi_square_test_accepts_the_distribution_on_a_triangle() {
    for seed in 0..8 {
        let chi = chi_square(16_000.0, seed, 4);
        // 15 degrees of freedom: one in a thousand is above 37.7.
        assert!(chi < 37.7, "{seed}: {chi}");
    }
}

#[test]
fn roots_are_spread_more_evenly_than_by_chance() {
    // 63 degrees of freedom: by chance the mean of 8 is within 63 ± 20, nearly always.
    let mean = (0..8).map(|seed| chi_square(1280.0, seed, 8)).sum::<f64>() / 8.0;
    assert!(mean < 40.0, "{mean}");
}

#[test]
fn the_first_strands_are_a_fair_sample_of_all() {
    let roots = scatter(&plate(24), &map(0).density(), &[], &Style::SHORT, 40_000.0, 5);
    let half = |roots: &[Root]| {
        roots.iter().filter(|root| root.triangle < 24 * 24).count() as f64 / roots.len() as f64
    };
    // A fair sample of 2000 is off by more than 4 % less than once in 3000 times.
    assert!((half(&roots[..2000]) - half(&roots)).abs() < 0.04);
}

#[test]
fn the_same_seed_gives_the_same_roots_and_another_one_others() {
    let density = map(4).density();
    let roots = |seed| scatter(&plate(8), &density, &[], &Style::SHORT, 1000.0, seed);
    assert_eq!(roots(1), roots(1));
    assert_ne!(roots(1), roots(2));
}

#[test]
fn other_brows_leave_the_scalp_as_it_is() {
    let even = DensityMap::new(1, 1, vec![255]).expect("a map");
    let eye = Bounds { min: Vec3::splat(0.3), max: Vec3::splat(0.5) };
    let scalp = |style: Style| -> Vec<Root> {
        let roots = scatter(&plate(16), &even, &[eye], &style, 5000.0, 1);
        roots.into_iter().filter(|root| root.region == Region::Scalp).collect()
    };
    let mut style = Style::SHORT;
    style.brows.density = 2.0;
    assert_eq!(scalp(style), scalp(Style::SHORT));
}

#[test]
fn broken_meshes_and_absurd_numbers_grow_what_they_can_and_end() {
    let even = DensityMap::new(3, 2, vec![255; 6]).expect("a map");
    let grow = |mesh: &Mesh, strands: f32| scatter(mesh, &even, &[], &Style::SHORT, strands, 1).len();
    let mut mesh = plate(2);
    mesh.triangles.extend([[0, 1, 99], [1, 1, 1], [2, 2, 0]]);
    assert_eq!(grow(&mesh, 1000.0), grow(&plate(2), 1000.0));
    for strands in [f32::NAN, f32::NEG_INFINITY, -1.0, 0.0, f32::INFINITY] {
        assert_eq!(grow(&mesh, strands), 0, "{strands}");
    }
    assert!((MAX_ROOTS - 6..=MAX_ROOTS).contains(&grow(&mesh, 1e30)));
    for broken in [f32::NAN, f32::INFINITY, 1e38] {
        let mut mesh = plate(4);
        mesh.uvs[6].x = broken;
        mesh.positions[18].y = broken;
        grow(&mesh, 1000.0);
    }
    // Flat, so that it has no height; far away on the map; repeated over it a thousand times.
    let mut flat = plate(2);
    flat.positions.iter_mut().for_each(|p| p.y = 0.0);
    assert_eq!(grow(&flat, 1e3), 0, "no area");
    let mut far = plate(2);
    far.uvs.iter_mut().for_each(|uv| *uv = *uv * 1000.0 - 4000.0);
    assert!(grow(&far, 1000.0).abs_diff(1000) <= 1);
}

#[test]
fn what_is_too_much_is_thinned_out_alike_everywhere() {
    // Twice as dense on the left as on the right, in triangles that stand in rows from the top.
    let map = Map::new(64, |x, _| if x < 32 { 240 } else { 120 });
    for strands in [1e7, 3e8] {
        let roots = scatter(&plate(8), &map.density(), &[], &Style::SHORT, strands, 1);
        assert!((MAX_ROOTS - 6..=MAX_ROOTS).contains(&roots.len()), "{}", roots.len());
        let mesh = plate(8);
        let mut quarters = [[0u32; 2]; 2];
        for root in &roots {
            let place: Vec3 =
                (0..3).map(|i| mesh.positions[root.corners[i] as usize] * root.barycentric[i]).sum();
            quarters[usize::from(place.y < 0.5)][usize::from(place.x > 0.5)] += 1;
        }
        for [left, right] in quarters {
            let whole = f64::from(quarters.as_flattened().iter().sum::<u32>());
            assert!((f64::from(left) / whole - 1.0 / 3.0).abs() < 0.005, "{quarters:?}");
            assert!((f64::from(right) / whole - 1.0 / 6.0).abs() < 0.005, "{quarters:?}");
        }
    }
}

/// The map is skipped in whole blocks where it is black: also over its edges, and where blocks are cut by
/// them.
#[test]
fn hair_at_the_edges_of_a_map_is_not_missed() {
    for size in [1u32, 3, 16, 17, 33, 50] {
        for (x, y) in [(0, 0), (size - 1, 0), (0, size - 1), (size - 1, size - 1), (size / 2, size / 2)] {
            let at = (y * size + x) as usize;
            let values = (0..(size * size) as usize).map(|i| if i == at { 255 } else { 0 }).collect();
            let density = DensityMap::new(size, size, values).expect("a map");
            for offset in [0.0, -0.4, 0.7, 5.3] {
                let mut mesh = plate(6);
                mesh.uvs.iter_mut().for_each(|uv| *uv += offset);
                let roots = scatter(&mesh, &density, &[], &Style::SHORT, 200.0 * (size * size) as f32, 1);
                // One value alone is seen at a few places only: not exactly its share, but no quarter or half
                // of it.
                assert!((170..=230).contains(&roots.len()), "{size}, {x}, {y}, {offset}: {}", roots.len());
            }
        }
    }
}
