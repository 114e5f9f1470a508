//! Winding, bounds and OBJ text.
#![allow(
    clippy::panic,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test: it may panic and read files"
)]

use crate::common::{Random, shared_data};
use avatar_mesh::{Bounds, Deformed, Mesh, Winding, obj, raw};
use glam::{Vec2, Vec3};

/// An octahedron with outward normals and counter-clockwise triangles.
fn octahedron() -> Mesh {
    let positions = vec![Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let triangles =
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    Mesh { uvs: vec![Vec2::ZERO; 6], normals: positions.clone(), positions, triangles, ..Mesh::default() }
}

#[test]
fn winding_counts_triangles_against_their_normals() {
    let mut mesh = octahedron();
    assert_eq!(Winding::of(&mesh), Winding { agreeing: 8, contradicting: 0, undecided: 0 });
    assert!(!Winding::of(&mesh).is_inside_out());
    // A mirror copy with the same triangles is inside out.
    let mirrored = |v: &Vec3| Vec3::new(-v.x, v.y, v.z);
    let mut mirror = mesh.clone();
    mirror.positions = mesh.positions.iter().map(mirrored).collect();
    mirror.normals = mesh.normals.iter().map(mirrored).collect();
    assert_eq!(Winding::of(&mirror), Winding { agreeing: 0, contradicting: 8, undecided: 0 });
    assert!(Winding::of(&mirror).is_inside_out());
    mirror.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    assert_eq!(Winding::of(&mirror).agreeing, 8);
    // Without area, or with normals at right angles, nothing is decided; half and half is not inside out.
    mesh.triangles = vec![[0, 0, 1], [0, 2, 4], [0, 4, 2]];
    assert_eq!(Winding::of(&mesh), Winding { agreeing: 1, contradicting: 1, undecided: 1 });
    assert!(!Winding::of(&mesh).is_inside_out());
    mesh.triangles = vec![[0, 2, 99]];
    assert_eq!(Winding::of(&mesh).undecided, 1);
    assert!(!Winding::of(&Mesh::default()).is_inside_out());
}

#[test]
fn bounds_are_the_extreme_coordinates() {
    let points = [Vec3::new(1., 2., 3.), Vec3::new(-1., 5., 3.), Vec3::new(0., 0., 4.)];
    let bounds = Bounds::of(&points).unwrap();
    assert_eq!(bounds, Bounds { min: Vec3::new(-1., 0., 3.), max: Vec3::new(1., 5., 4.) });
    assert_eq!((bounds.center(), bounds.size()), (Vec3::new(0., 2.5, 3.5), Vec3::new(2., 5., 1.)));
    assert_eq!(Bounds::of(&[]), None);
    let one = Bounds::of(&[Vec3::splat(9.)]).unwrap();
    assert_eq!(one.size(), Vec3::ZERO);
    assert_eq!(one.union(bounds), Bounds { min: Vec3::new(-1., 0., 3.), max: Vec3::splat(9.) });
    assert_eq!(octahedron().bounds(), Some(Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE }));
    assert_eq!(Mesh::default().bounds(), None);
}

#[test]
fn obj_text_is_what_the_format_says() {
    let deformed =
        Deformed { positions: vec![Vec3::new(1., -0.5, 1e-7)], normals: vec![Vec3::Z], tangents: vec![] };
    let text = obj::write("a\nb", &deformed, &[[0, 0, 0]]);
    assert_eq!(text, "o a b\nv 1 -0.5 0.0000001\nvn 0 0 1\nf 1//1 1//1 1//1\n");
}

#[test]
fn obj_text_reads_back_to_the_bit() {
    let mut random = Random(7);
    let any = |random: &mut Random| loop {
        let x = f32::from_bits(random.next() as u32);
        if x.is_finite() {
            return x;
        }
    };
    let mut points = |n: usize| -> Vec<Vec3> {
        (0..n).map(|_| Vec3::from_array([(); 3].map(|()| any(&mut random)))).collect()
    };
    let mut deformed = Deformed { positions: points(500), normals: points(500), tangents: vec![] };
    deformed.positions[0] = Vec3::new(-0.0, f32::from_bits(1), f32::MAX);
    let triangles: Vec<[u32; 3]> = (0..498).map(|i| [i, i + 2, i + 1]).chain([[u32::MAX, 0, 499]]).collect();
    let text = obj::write("skin", &deformed, &triangles);

    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("o skin"));
    let mut numbers = |kind: &str| -> Vec<[u32; 3]> {
        let of_kind = lines.by_ref().take(500);
        let read = |line: &str| {
            let words: Vec<&str> = line.split(' ').collect();
            assert_eq!((words[0], words.len()), (kind, 4), "{line}");
            std::array::from_fn(|i| words[i + 1].parse::<f32>().unwrap().to_bits())
        };
        of_kind.map(read).collect()
    };
    let bits = |points: &[Vec3]| -> Vec<[u32; 3]> {
        points.iter().map(|p| p.to_array().map(f32::to_bits)).collect()
    };
    assert!(numbers("v") == bits(&deformed.positions));
    assert!(numbers("vn") == bits(&deformed.normals));
    let faces: Vec<[u64; 3]> = lines
        .map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            assert_eq!((words[0], words.len()), ("f", 4), "{line}");
            std::array::from_fn(|i| {
                let (v, vn) = words[i + 1].split_once("//").unwrap();
                assert_eq!(v, vn);
                v.parse::<u64>().unwrap() - 1
            })
        })
        .collect();
    assert_eq!(faces, triangles.iter().map(|t| t.map(u64::from)).collect::<Vec<_>>());
}

#[test]
fn the_parts_of_a_real_face_run_counter_clockwise() {
    let Some(data) = shared_data() else { return };
    let folder = data.join("avatar-course-format-makehuman");
    for part in &avatar_mesh::FACE_PARTS[1..] {
        let read = |kind: &str| std::fs::read(folder.join(format!("{}_{kind}.raw", part.stem))).unwrap();
        let mesh = raw::read_rigid(&read("VB"), &read("IB")).unwrap();
        let winding = Winding::of(&mesh);
        assert!(!winding.is_inside_out(), "{}: {winding:?}", part.name);
    }
}
