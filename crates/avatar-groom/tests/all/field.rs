//! Distances from a skin, and the strands that keep them.
#![allow(clippy::expect_used, reason = "a test may panic")]

use avatar_groom::{
    DensityMap, Field, Groom, MARGIN, RegionStyle, SEGMENTS, Style, Triangle, grow, grow_guide,
};
use avatar_mesh::{Mesh, Skinning};
use glam::{Affine3A, Quat, Vec2, Vec3};

/// A ball of radius 1 around a place, by latitude and longitude.
fn ball(center: Vec3) -> Mesh {
    let (rows, columns) = (48u32, 96u32);
    let mut mesh = Mesh::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let uv = Vec2::new(column as f32 / columns as f32, row as f32 / rows as f32);
            let (phi, theta) = (uv.x * std::f32::consts::TAU, uv.y * std::f32::consts::PI);
            let normal = Vec3::new(theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos());
            mesh.positions.push(center + normal);
            mesh.normals.push(normal);
            mesh.uvs.push(uv);
        }
    }
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let a = row * (columns + 1) + column;
        let b = a + columns + 1;
        mesh.triangles.extend([[a, b, a + 1], [a + 1, b, b + 1]]);
    }
    mesh
}

fn places(count: u32, reach: f32) -> impl Iterator<Item = Vec3> {
    // R. Roberts' additive sequence in three dimensions.
    let g = 1.220_744_1_f32;
    let steps = Vec3::new(1.0 / g, 1.0 / (g * g), 1.0 / (g * g * g));
    (0..count).map(move |i| ((steps * i as f32 + 0.5).fract() * 2.0 - 1.0) * reach)
}

#[test]
fn the_distance_from_a_ball_is_that_from_its_middle_less_the_radius() {
    let center = Vec3::new(3.0, -2.0, 5.0);
    let field = Field::new(&ball(center), 0);
    for place in places(4000, 1.12) {
        let near = field.at(center + place);
        let wanted = (place.length() - 1.0).clamp(-field.range(), field.range());
        // The grid's half cell where distances bend most: in the middle. Where their range ends, they stop
        // within a cell.
        let most = if wanted.abs() < field.range() - field.cell { 0.25 } else { 0.35 };
        assert!((near.distance - wanted).abs() < most * field.cell, "{place}: {} {wanted}", near.distance);
        if (0.6..1.1).contains(&place.length()) {
            // Smoothing adds half its variance (a cell's square) times the curvature, and facets lie below
            // the ball.
            assert!(
                (near.distance - wanted).abs() < 0.12 * field.cell,
                "{place}: {} {wanted}",
                near.distance
            );
            let along = near.outward.dot(place.normalize_or_zero());
            assert!(along > 0.999, "{place}: {along}");
        }
    }
    let far = field.at(center + Vec3::X * 9.0);
    assert!((far.distance - 8.0).abs() < 0.5, "{}", far.distance);
}

#[test]
fn a_field_knows_its_side_where_the_skin_is_open_and_where_it_is_folded() {
    // Without its lowest part, as a head without its body.
    let mut open = ball(Vec3::ZERO);
    open.triangles.retain(|corners| corners.iter().all(|i| open.positions[*i as usize].y > -0.6));
    let field = Field::new(&open, 0);
    assert!(field.at(Vec3::new(0.0, 0.3, 0.0)).distance < -0.4);
    assert!(field.at(Vec3::new(0.95, -0.5, 0.0)).distance > 0.0);
    // A ridge as sharp as the edge of an ear: on both sides of it is outside.
    let mut ridge = ball(Vec3::ZERO);
    for p in ridge.positions.iter_mut().filter(|p| p.x.abs() < 0.04 && p.y > 0.0) {
        *p *= 1.5;
    }
    let field = Field::new(&ridge, 0);
    for x in [-0.3, -0.2, 0.2, 0.3] {
        assert!(field.at(Vec3::new(x, 1.2, 0.0)).distance > 0.0, "{x}");
    }
}

/// Two balls of radius 1 that are one skin, their middles this far from the origin to both sides.
const APART: f32 = 0.9;

fn two_balls() -> Mesh {
    let mut mesh = ball(Vec3::ZERO);
    for p in &mut mesh.positions {
        // The seam is one.
        p.x = if p.x.abs() < 1e-6 { 0.0 } else { p.x };
        p.z = if p.x == 0.0 { (1.0 - p.y * p.y).max(0.0).sqrt().copysign(p.z) } else { p.z };
        // Where a ray from between the balls leaves the one that it goes to.
        let aside = APART * p.x.abs();
        *p *= aside + (1.0 - APART * APART + aside * aside).sqrt();
    }
    mesh
}

#[test]
fn creases_are_filled_as_far_as_a_ball_gets_stuck_in_them() {
    let field = Field::new(&two_balls(), 0);
    // A ball that lies in the crease touches both balls: its middle is this far from the axis.
    let radius = 2.0 * field.cell;
    let middle = ((1.0 + radius).powi(2) - APART * APART).sqrt();
    let skin = (1.0 - APART * APART).sqrt();
    for around in 0u8..24 {
        let (sin, cos) = (f32::from(around) * 0.26).sin_cos();
        let at = |x: f32, off_axis: f32| field.at(Vec3::new(x, off_axis * cos, off_axis * sin)).distance;
        for share in [0.0, 0.2, 0.4, 0.6] {
            let off_axis = skin + share * (middle - skin);
            let expected = radius - (middle - off_axis);
            let found = at(0.0, off_axis);
            // Two thirds of a cell less is filled everywhere; smoothing fills a little more.
            let off = (found - expected) / field.cell;
            assert!((-0.5..0.66).contains(&off), "{off_axis}: {found} {expected}");
        }
        assert!(at(0.0, skin) < -1.2 * field.cell, "the skin itself is deep in what is filled");
        // Wide places and those outside keep their distance.
        let off = Vec2::new(APART - 0.5, 1.1).length() - 1.0;
        assert!(off > radius && (at(0.5, 1.1) - off).abs() < 0.2 * field.cell, "{} {off}", at(0.5, 1.1));
        assert!((at(APART, 1.1) - 0.1).abs() < 0.15 * field.cell);
    }
}

#[test]
fn what_is_thin_is_not_smoothed_away() {
    // A plate, some two cells thick, as the rims of ears are.
    let half = Vec3::new(1.0, 1.0, 0.03);
    let corner = |i: u8| half * Vec3::from([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 }));
    let sides = [[0, 2, 1, 3], [4, 5, 6, 7], [0, 1, 4, 5], [2, 6, 3, 7], [0, 4, 2, 6], [1, 3, 5, 7]];
    let plate = Mesh {
        positions: (0..8).map(corner).collect(),
        triangles: sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*c, *b, *d]]).collect(),
        ..Mesh::default()
    };
    let field = Field::new(&plate, 0);
    for place in places(500, 0.9) {
        let place = Vec3::new(place.x, place.y, place.z * 0.1);
        let expected = place.z.abs() - half.z;
        let found = field.at(place).distance;
        // No less thick than it is by more than a fifth of a cell, and thicker by a part of one.
        let off = (found - expected) / field.cell;
        assert!((-0.9..0.2).contains(&off), "{place}: {found} {expected}");
    }
}

#[test]
fn no_hair_grows_in_creases_that_it_cannot_leave() {
    let mesh = two_balls();
    let groom = hairy(&mesh, style(RegionStyle { parting: -9.0, ..Style::LONG.scalp }));
    let off_crease = |root: &avatar_groom::Root| {
        let x: f32 = (0..3).map(|i| mesh.positions[root.corners[i] as usize].x * root.barycentric[i]).sum();
        x.abs()
    };
    let between = |least: f32, most: f32| {
        groom.strands().iter().filter(|s| (least..most).contains(&off_crease(&s.root))).count()
    };
    assert_eq!(between(0.0, 0.01), 0);
    assert!(between(0.2, 0.25) > 20, "{}", between(0.2, 0.25));
}

#[test]
fn broken_meshes_have_a_field_too() {
    let mut broken = ball(Vec3::ZERO);
    broken.triangles.push([0, 1, 9_999_999]);
    broken.positions[7] = Vec3::NAN;
    broken.normals.truncate(50);
    let field = Field::new(&broken, 3);
    assert_eq!(field.texels().len(), field.size.iter().product::<u32>() as usize);
    assert!(field.at(Vec3::NAN).outward.is_finite() || field.at(Vec3::NAN).outward.is_nan());
    Field::new(&Mesh::default(), 0).at(Vec3::ONE);
}

fn style(scalp: RegionStyle) -> Style {
    Style { scalp, ..Style::LONG }
}

fn hairy(mesh: &Mesh, style: Style) -> Groom {
    let everywhere = DensityMap::new(1, 1, vec![255]).expect("a map");
    Groom::new(mesh, &everywhere, &[], style, 2000.0, 5)
}

fn triangle(mesh: &Mesh, groom: &Groom, strand: usize, bones: &[Affine3A]) -> Triangle {
    let corners = groom.strands()[strand].root.corners.map(|i| i as usize);
    let bone = bones[groom.head_bone() as usize];
    Triangle {
        positions: corners.map(|i| bone.transform_point3(mesh.positions[i])),
        normals: corners.map(|i| bone.transform_vector3(mesh.normals[i])),
    }
}

#[test]
fn hair_stays_outside_of_a_turned_head_has_its_length_and_follows_its_guide() {
    let mesh = ball(Vec3::ZERO);
    let turned = [Affine3A::from_rotation_translation(Quat::from_rotation_z(0.7), Vec3::new(5.0, 1.0, 2.0))];
    let mut ratios = Vec::new();
    for clump in [0.0, 0.2] {
        let groom = hairy(&mesh, style(RegionStyle { clump, cut: -10.0, ..Style::LONG.scalp }));
        assert!(groom.guides().len() > 20);
        let middle = turned[0].transform_point3(Vec3::ZERO);
        let mut apart = [0.0f32; 2];
        for strand in 0..groom.strands().len() {
            let guide_strand = groom.guide(strand).expect("a guide");
            let guide =
                grow_guide(&groom, guide_strand, &triangle(&mesh, &groom, guide_strand, &turned), &turned);
            let guide = guide.expect("a guide");
            let of = triangle(&mesh, &groom, strand, &turned);
            let points = grow(&groom, strand, &of, &turned, Some(&guide)).expect("a strand");
            for point in &points[2..] {
                let height = point.distance(middle) - 1.0;
                assert!(height > 0.25 * MARGIN * groom.height(), "{height}");
            }
            let length: f32 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            let wanted = groom.strands()[strand].length;
            // Segments that the head pushes back get shorter.
            assert!(length <= wanted * 1.001 && length > 0.8 * wanted, "{length} {wanted}");
            apart[0] += points[0].distance(guide[0]);
            apart[1] += points[SEGMENTS].distance(guide[SEGMENTS]);
        }
        ratios.push(apart[1] / apart[0]);
    }
    assert!(ratios[1] < 0.8 * ratios[0], "{ratios:?}");
}

#[test]
fn the_cut_is_where_the_style_says() {
    let mesh = ball(Vec3::ZERO);
    let scalp =
        RegionStyle { cut: -0.2, clump: 0.0, length: 3.0, length_variation: 0.0, ..Style::LONG.scalp };
    let groom = hairy(&mesh, style(scalp));
    let bones = [Affine3A::IDENTITY];
    // The lowest point of the ball is -1, its height 2.
    let height = -1.0 - 0.2 * 2.0;
    let guides: Vec<f32> = (groom.guides().iter())
        .map(|&strand| {
            let of = triangle(&mesh, &groom, strand as usize, &bones);
            grow_guide(&groom, strand as usize, &of, &bones).expect("a guide")[SEGMENTS].y
        })
        .collect();
    // No lower; and higher by no more than a twentieth of the length, which is how uneven the cut is, and by
    // what a shorter strand bends otherwise.
    for y in &guides {
        assert!((-0.01..0.15 + 0.15).contains(&(y - height)), "{y}");
    }
    let mean = guides.iter().sum::<f32>() / guides.len() as f32;
    assert!((mean - height).abs() < 0.08, "{mean}");
}

#[test]
fn hair_that_stands_reaches_as_high_as_it_is_long() {
    let mesh = ball(Vec3::Y);
    let stands = RegionStyle {
        length: 0.3,
        length_variation: 0.0,
        bend: 0.0,
        noise: 0.0,
        clump: 0.0,
        ..Style::SHORT.scalp
    };
    let top = hairy(&mesh, style(stands)).top().expect("guides");
    // From 2, the top of the ball, by 0.3 of its height, which is 2. Guides stand at places near the pole.
    assert!((2.5..2.601).contains(&top), "{top}");
    let curled = RegionStyle { curl_radius: 0.01, curl_turns: 2.0, ..stands };
    assert!((hairy(&mesh, style(curled)).top().expect("guides") - top - 0.02).abs() < 1e-3);
    assert_eq!(hairy(&mesh, style(RegionStyle { density: 0.0, ..stands })).top(), None);
}

#[test]
fn guides_are_the_nearest_ones_on_their_side_of_the_parting() {
    let mesh = ball(Vec3::ZERO);
    let groom = hairy(&mesh, style(RegionStyle { parting: 0.1, ..Style::LONG.scalp }));
    let at = |strand: usize| -> Vec3 {
        let root = &groom.strands()[strand].root;
        (0..3).map(|i| mesh.positions[root.corners[i] as usize] * root.barycentric[i]).sum()
    };
    // The parting ends at the crown, 0.36 of the depth from the back.
    let side = |strand: usize| match at(strand) {
        at if at.z <= -1.0 + 0.36 * 2.0 => 0,
        at if at.x < 0.2 => -1,
        _ => 1,
    };
    for strand in 0..groom.strands().len() {
        let same_side = groom.guides().iter().map(|g| *g as usize).filter(|g| side(*g) == side(strand));
        let nearest = same_side.map(|g| at(g).distance(at(strand))).fold(f32::INFINITY, f32::min);
        let found = groom.guide(strand).expect("a guide");
        assert_eq!(side(found), side(strand));
        assert!((at(found).distance(at(strand)) - nearest).abs() < 1e-6, "strand {strand}");
    }
}

#[test]
fn hair_is_combed_away_from_the_parting_and_all_around_from_the_crown() {
    let mesh = ball(Vec3::ZERO);
    let [away, up, forward] = [0.9, 0.2, -0.3];
    let scalp =
        RegionStyle { parting: 0.1, comb: [away, up, forward], edge: [0.1, 0.5, -1.0], ..Style::LONG.scalp };
    let groom = hairy(&mesh, style(scalp));
    let (mut before, mut behind) = (0, 0);
    for strand in groom.strands() {
        let corners = strand.root.corners.map(|i| mesh.positions[i as usize]);
        let at: Vec3 = (0..3).map(|i| corners[i] * strand.root.barycentric[i]).sum();
        let off = Vec3::new(at.x - 0.2, 0.0, at.z - (-1.0 + 0.36 * 2.0));
        let aside = if off.z >= 0.0 {
            before += 1;
            Vec3::X * off.x.signum()
        } else {
            behind += 1;
            off.normalize_or_zero()
        };
        // Toward the front, all of which is 0.64 of the depth before the crown, as the edge is combed.
        let front = (off.z / (0.64 * 2.0)).clamp(0.0, 1.0).powi(4);
        let of = |[away, up, forward]: [f32; 3]| aside * away + Vec3::new(0.0, up, forward);
        let expected = of([away, up, forward]).lerp(of([0.1, 0.5, -1.0]), front);
        // The frame of the triangle: its first edge, and its normal.
        let x = (corners[1] - corners[0]).normalize_or_zero();
        let z = x.cross(corners[2] - corners[0]).normalize_or_zero();
        let found = x * strand.comb.x + z.cross(x) * strand.comb.y + z * strand.comb.z;
        assert!(found.distance(expected) < 1e-4, "{at}: {found} {expected}");
        assert!((strand.thickness - 1.0).abs() < 1e-6, "no hairline on a map that is dense everywhere");
    }
    assert!(before > 100 && behind > 100, "{before} {behind}");
}

#[test]
fn necks_and_jaws_carry_hair_along() {
    // The lower half moves with bone 1.
    let mut mesh = ball(Vec3::ZERO);
    let weights: Vec<[f32; 4]> = (mesh.positions.iter())
        .map(|p| {
            let low = (0.5 - 4.0 * (p.y + 0.4)).clamp(0.0, 1.0);
            [1.0 - low, low, 0.0, 0.0]
        })
        .collect();
    mesh.skinning = Some(Skinning {
        bones: vec![[0, 1, 0, 0]; mesh.positions.len()],
        blend_index: vec![Vec3::ZERO; mesh.positions.len()],
        weights,
        ..Skinning::default()
    });
    let field = Field::new(&mesh, 0);
    assert_eq!(field.bones[0], 1);
    assert!(field.at(Vec3::new(0.0, 0.9, 0.0)).shares[0] < 0.01);
    assert!(field.at(Vec3::new(0.0, -0.95, 0.0)).shares[0] > 0.99);
}
