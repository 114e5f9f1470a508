//! Boxes that know shapes and bones: never too small, seldom too large.
#![allow(
    clippy::panic,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test: it may panic and read files"
)]

use crate::common::{Random, shared_data};
use avatar_mesh::{
    Bounds, DeformBounds, FACE_BONES, Mesh, Offsets, Shape, ShapeNormals, Skinning, blend, deform, raw,
};
use glam::{Affine3A, Mat3, Quat, Vec3};
use proptest::prelude::*;

fn deformed(mesh: &Mesh, bones: &[Affine3A], weights: &[f32]) -> Bounds {
    let mut out = mesh.deformed();
    deform(mesh, bones, weights, &mut out).unwrap();
    Bounds::of(&out.positions).unwrap()
}

/// No tolerance: what f32 rounds is the box's business.
fn holds(outer: Bounds, inner: Bounds) -> bool {
    outer.min.cmple(inner.min).all() && outer.max.cmpge(inner.max).all()
}

/// How much longer the most stretched edge is.
fn ratio(outer: Bounds, inner: Bounds) -> f32 {
    (outer.size() / inner.size()).max_element()
}

/// Shapes that move the vertices around a place, as those of faces do.
fn add_local_shapes(random: &mut Random, mesh: &mut Mesh, shapes: usize) {
    for k in 0..shapes {
        let (middle, way) = (mesh.positions[random.below(mesh.positions.len())], random.vec3(3.0));
        let near = |p: &Vec3| (1.0 - p.distance(middle) / 6.0).max(0.0);
        let offsets: Offsets = mesh.positions.iter().map(|p| way * near(p)).collect();
        mesh.shapes.push(Shape::new(k.to_string(), offsets));
    }
}

proptest! {
    #[test]
    fn no_vertex_leaves_the_box(
        seed in any::<u64>(), vertices in 1..60usize, bones in 1..6usize, skinned in any::<bool>(), kind in 0..4,
        weights in prop::collection::vec(prop_oneof![-2.0..3.0f32, Just(0.0f32), Just(1.0f32)], 0..6),
        scale in prop_oneof![Just(1.0f32), Just(1e-6f32), Just(1e6f32)],
    ) {
        let mut random = Random(seed);
        let mut mesh = random.mesh(vertices, if kind == 0 { weights.len() } else { 0 }, bones);
        match kind {
            // Some vertices rest, and all shapes of the second kind push one way.
            1 => add_local_shapes(&mut random, &mut mesh, weights.len()),
            2 => mesh.shapes = weights.iter().map(|_| {
                let way = random.vec3(4.0);
                Shape::new("all", vec![way; vertices])
            }).collect(),
            3 => mesh.shapes = weights.iter().map(|_| {
                let some = (0..vertices).filter(|_| random.below(4) == 0).collect::<Vec<_>>();
                Shape::from_pairs("some", vertices, some.iter().map(|v| (*v as u32, random.vec3(4.0)))).unwrap()
            }).collect(),
            _ => {}
        }
        mesh.positions.iter_mut().for_each(|p| *p *= scale);
        for shape in &mut mesh.shapes {
            shape.positions = shape.positions.per_vertex().map(|d| d * scale).collect();
        }
        if !skinned {
            mesh.skinning = None;
        } else if seed % 4 == 0 {
            // Weights that no validation would let through.
            let weights = &mut mesh.skinning.as_mut().unwrap().weights;
            weights.iter_mut().for_each(|w| *w = [(); 4].map(|()| random.signed()));
            weights[0] = [0.0; 4];
        } else if seed % 4 == 1 {
            // None below 0, but with any sum.
            let weights = &mut mesh.skinning.as_mut().unwrap().weights;
            weights.iter_mut().for_each(|w| *w = [(); 4].map(|()| random.signed().abs()));
        }
        let palette: Vec<Affine3A> = (0..bones).map(|_| {
            let stretch = if seed % 3 == 0 { Mat3::from_diagonal(random.vec3(2.0)) } else { Mat3::IDENTITY };
            random.rigid() * Affine3A::from_mat3(stretch)
        }).collect();
        let bounds = DeformBounds::new(&mesh);
        let inner = deformed(&mesh, &palette, &weights);
        let outer = bounds.around(&palette, &weights).unwrap();
        prop_assert!(holds(outer, inner), "{outer:?} {inner:?}");
        // The box of a range holds that of each weight in it.
        let range = |k: usize| [weights[k].min(0.0), weights[k] + 0.5];
        let wide = bounds.around_within(&palette, range).unwrap();
        for share in [0.0, 0.3, 1.0] {
            let within: Vec<f32> = (0..weights.len()).map(|k| range(k)[0] + share * (range(k)[1] - range(k)[0])).collect();
            prop_assert!(holds(wide, deformed(&mesh, &palette, &within)));
        }
        // Before bones, those of one bone are all there is.
        let mut blended = mesh.deformed();
        blend(&mesh, &weights, ShapeNormals::Unblended, &mut blended).unwrap();
        let rigid = DeformBounds::rigid(&mesh, 7);
        prop_assert!(rigid.bones().iter().all(|around| around.bone() == 7));
        let shaped = rigid.bones().iter().map(|around| around.shaped(|k| [weights[k]; 2]));
        prop_assert!(holds(shaped.reduce(Bounds::union).unwrap(), Bounds::of(&blended.positions).unwrap()));
    }
}

/// Edges are compared; turned boxes and shapes that add up in one direction only in theory make them longer.
#[test]
fn boxes_of_random_meshes_are_seldom_half_as_large_again() {
    let mut random = Random(17);
    let mut ratios = Vec::new();
    for case in 0..400 {
        let mut mesh = random.mesh(400, 0, 5);
        let shapes = 1 + case % 8;
        match case % 2 {
            0 => add_local_shapes(&mut random, &mut mesh, shapes),
            _ => mesh.shapes = random.mesh(400, shapes, 1).shapes,
        }
        let bones: Vec<Affine3A> = (0..5)
            .map(|_| {
                let turn = Quat::from_axis_angle(random.unit(), random.signed() * 0.3);
                Affine3A::from_rotation_translation(turn, random.vec3(0.5))
            })
            .collect();
        let weights: Vec<f32> = (0..shapes).map(|_| random.signed().abs()).collect();
        let outer = DeformBounds::new(&mesh).around(&bones, &weights).unwrap();
        ratios.push(ratio(outer, deformed(&mesh, &bones, &weights)));
    }
    seldom(&mut ratios, "random meshes");
}

fn seldom(ratios: &mut [f32], what: &str) {
    ratios.sort_by(f32::total_cmp);
    let above = ratios.iter().filter(|r| **r > 1.5).count();
    let (middle, most) = (ratios[ratios.len() / 2], ratios[ratios.len() - 1]);
    println!(
        "{what}: edges {middle} times as long in the middle, {most} at most; {above} of {} above 1.5",
        ratios.len()
    );
    assert!(ratios[0] >= 1.0 && above * 20 <= ratios.len(), "{what}: {above} of {}", ratios.len());
}

/// Poses of the bones as a face takes them, and both shapes at all weights.
fn boxes_of(folder: &std::path::Path, what: &str) {
    let read = |kind: &str| std::fs::read(folder.join(format!("MarsienneSkin_{kind}.raw"))).unwrap();
    let mut mesh = raw::read_skin(&read("VB"), &read("IB")).unwrap();
    mesh.validate(FACE_BONES.len()).unwrap();
    let bounds = DeformBounds::new(&mesh);
    let mut random = Random(5);
    let mut ratios = Vec::new();
    for _ in 0..60 {
        let weights = [random.signed().abs(), random.signed().abs()];
        // The head turns as a whole, the rest a little more about its middle.
        let about = |middle: Vec3, turn: Quat| {
            Affine3A::from_translation(middle)
                * Affine3A::from_quat(turn)
                * Affine3A::from_translation(-middle)
        };
        let head =
            about(Vec3::new(0.0, -10.0, -1.6), Quat::from_axis_angle(random.unit(), random.signed() * 0.6));
        let bones: Vec<Affine3A> = (0..FACE_BONES.len())
            .map(|bone| match bone {
                0 => Affine3A::IDENTITY,
                1 => head,
                _ => head * about(Vec3::new(0.0, -1.0, 0.0), Quat::from_rotation_x(random.signed() * 0.3)),
            })
            .collect();
        let (outer, inner) = (bounds.around(&bones, &weights).unwrap(), deformed(&mesh, &bones, &weights));
        assert!(holds(outer, inner), "{what}: {outer:?} {inner:?}");
        ratios.push(ratio(outer, inner));
    }
    seldom(&mut ratios, what);
}

#[test]
fn boxes_of_the_default_avatar_are_seldom_half_as_large_again() {
    boxes_of(&std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne"), "marsienne");
}

#[test]
fn boxes_of_a_real_face_are_seldom_half_as_large_again() {
    let Some(data) = shared_data() else { return };
    boxes_of(&data.join("avatar-course-format-makehuman"), "makehuman");
}

/// What is exact in the box and rounded in f32.
#[test]
fn boxes_leave_room_for_rounding() {
    // Each offset is too small to count, all together are not: the vertex stays where it is.
    let tiny = |k: usize| Shape::new(k.to_string(), vec![Vec3::splat(0.4 * f32::EPSILON)]);
    let mesh = Mesh { shapes: (0..200).map(tiny).collect(), ..cloud(Vec3::ONE, [1.0, 0.0, 0.0, 0.0]) };
    let inner = deformed(&mesh, &[Affine3A::IDENTITY], &[1.0; 200]);
    assert_eq!(inner.min, Vec3::ONE);
    assert!(holds(DeformBounds::new(&mesh).around(&[Affine3A::IDENTITY], &[1.0; 200]).unwrap(), inner));
    // Far away, weights round more than the box's own numbers do.
    let mut random = Random(8);
    for _ in 0..5000 {
        let raw: [f32; 4] = [(); 4].map(|()| random.signed().abs() + 0.01);
        let mesh = cloud(random.unit(), raw.map(|w| w / raw.iter().sum::<f32>()));
        let far = Affine3A::from_translation(random.vec3(1e6)) * random.rigid();
        let (outer, inner) = (DeformBounds::new(&mesh).around(&[far], &[]), deformed(&mesh, &[far], &[]));
        assert!(holds(outer.unwrap(), inner), "{outer:?} {inner:?}");
    }
}

/// One vertex that follows bone 0 four times.
fn cloud(position: Vec3, weights: [f32; 4]) -> Mesh {
    let skinning = Skinning { bones: vec![[0; 4]], weights: vec![weights], ..Skinning::default() };
    Mesh { positions: vec![position], normals: vec![Vec3::X], skinning: Some(skinning), ..Mesh::default() }
}

#[test]
fn what_raises_the_chin_does_not_raise_the_crown() {
    let positions = vec![Vec3::ZERO, Vec3::Y * 10.0, Vec3::new(1.0, 5.0, 1.0)];
    let chin = Shape::from_pairs("chin", 3, [(0, Vec3::Y * 4.0)]).unwrap();
    let down = Shape::new("down", vec![Vec3::Y * -2.0; 3]);
    let mesh = Mesh { positions, shapes: vec![chin, down], ..Mesh::default() };
    let bounds = DeformBounds::new(&mesh);
    let around = |chin: f32, down: f32| {
        let found = bounds.around(&[Affine3A::IDENTITY], &[chin, down]).unwrap();
        // But for the room for rounding, some millionths of the size.
        [found.min, found.max].map(|v| (v * 1e4).round() / 1e4 + Vec3::ZERO)
    };
    assert_eq!(around(0.0, 0.0), [Vec3::ZERO, Vec3::new(1.0, 10.0, 1.0)]);
    assert_eq!(around(1.0, 0.0)[1].y, 10.0);
    assert_eq!(around(-1.0, 0.0)[0].y, -4.0);
    // All vertices go down together.
    assert_eq!(around(0.0, 1.0), [Vec3::Y * -2.0, Vec3::new(1.0, 8.0, 1.0)]);
}

#[test]
fn what_is_nowhere_has_no_box_and_nothing_panics() {
    assert_eq!(DeformBounds::new(&Mesh::default()).around(&[], &[]), None);
    let mesh = Random(3).mesh(5, 2, 4);
    let bounds = DeformBounds::new(&mesh);
    assert_eq!(bounds.around(&[], &[0.0; 2]), None);
    // Missing weights are 0.
    let bones = [Affine3A::IDENTITY; 4];
    assert_eq!(bounds.around(&bones, &[]), bounds.around(&bones, &[0.0; 2]));
    for odd in [f32::NAN, f32::INFINITY, f32::MAX, f32::MIN] {
        bounds.around(&bones, &[odd, -odd]);
        let mut bad = mesh.clone();
        bad.positions[2] = Vec3::splat(odd);
        bad.skinning.as_mut().unwrap().weights[1] = [odd, -odd, 0.0, 1.0];
        DeformBounds::new(&bad).around(&bones, &[1.0, 2.0]);
    }
    let mut short = mesh.clone();
    short.positions.truncate(2);
    DeformBounds::new(&short).around(&bones, &[1.0, 2.0]);
    short.skinning.as_mut().unwrap().bones.clear();
    assert_eq!(DeformBounds::new(&short).around(&bones, &[1.0, 2.0]), None);
    assert!(DeformBounds::rigid(&mesh, usize::MAX).around(&bones, &[]).is_none());
}
