//! The raw format: column by column, round trips to the bit, and every refusal.
#![allow(
    clippy::panic,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test: it may panic and read files"
)]

use crate::common::{Random, bytes, shared_data};
use avatar_mesh::{FACE_BONES, FACE_PARTS, FACE_SHAPES, Follows, MeshError, raw};
use glam::{Vec2, Vec3};
use raw::{RIGID_FLOATS, SKIN_FLOATS};

/// A skin vertex whose columns count from `start`, with bones 0 to 3.
fn skin_vertex(start: f32) -> [f32; SKIN_FLOATS] {
    std::array::from_fn(|i| match i {
        8..12 => (i - 8) as f32,
        _ => start + i as f32,
    })
}

#[test]
fn every_column_of_a_skin_lands_in_its_field() {
    let data = bytes(&[skin_vertex(100.0), skin_vertex(200.0)].concat());
    let mesh = raw::read_skin(&data, &[]).unwrap();
    assert_eq!(mesh.positions, [Vec3::new(100., 101., 102.), Vec3::new(200., 201., 202.)]);
    assert_eq!(mesh.uvs[1], Vec2::new(203., 204.));
    assert_eq!(mesh.normals[1], Vec3::new(205., 206., 207.));
    let skinning = mesh.skinning.as_ref().unwrap();
    assert_eq!(skinning.bones[1], [0, 1, 2, 3]);
    assert_eq!(skinning.weights[1], [212., 213., 214., 215.]);
    assert_eq!(skinning.blend_index[1], Vec3::new(216., 217., 218.));
    assert_eq!(mesh.shapes.len(), 2);
    assert_eq!((mesh.shapes[0].name.as_str(), mesh.shapes[1].name.as_str()), ("SSmile", "Frown"));
    assert_eq!(mesh.shapes[0].positions.get(1).unwrap(), Vec3::new(219., 220., 221.));
    assert_eq!(mesh.shapes[0].normals.as_ref().unwrap().get(1).unwrap(), Vec3::new(222., 223., 224.));
    assert_eq!(mesh.shapes[1].positions.get(1).unwrap(), Vec3::new(225., 226., 227.));
    assert_eq!(mesh.shapes[1].normals.as_ref().unwrap().get(1).unwrap(), Vec3::new(228., 229., 230.));
}

#[test]
fn every_column_of_a_rigid_part_and_every_index_lands_in_its_field() {
    let floats: [f32; RIGID_FLOATS] = std::array::from_fn(|i| i as f32);
    // Little-endian by hand, so that a machine of the other kind must agree.
    let indices = [0, 0, 0, 0, 1, 2, 3, 4, 0xFF, 0xFF, 0xFF, 0xFF];
    let mesh = raw::read_rigid(&bytes(&floats), &indices).unwrap();
    assert_eq!(mesh.positions, [Vec3::new(0., 1., 2.)]);
    assert_eq!(mesh.uvs, [Vec2::new(3., 4.)]);
    assert_eq!(mesh.normals, [Vec3::new(5., 6., 7.)]);
    assert_eq!(mesh.triangles, [[0, 0x0403_0201, u32::MAX]]);
    assert!(mesh.skinning.is_none() && mesh.shapes.is_empty());
    let one = raw::read_rigid(&[0, 0, 0x80, 0x3F].repeat(8), &[]).unwrap();
    assert_eq!(one.positions, [Vec3::ONE]);
}

/// Any bits but bone indices: NaN with its payload, infinities, subnormals, -0.0.
#[test]
fn writing_gives_back_the_bytes_that_were_read() {
    let mut random = Random(1);
    for vertices in [1, 2, 17, 300] {
        let mut skin: Vec<u8> = (0..vertices * SKIN_FLOATS * 4).map(|_| random.next() as u8).collect();
        for vertex in skin.chunks_exact_mut(SKIN_FLOATS * 4) {
            let bones: Vec<f32> = (0..4).map(|_| random.below(9) as f32).collect();
            vertex[32..48].copy_from_slice(&bytes(&bones));
        }
        let indices: Vec<u8> = (0..vertices * 12).map(|_| random.next() as u8).collect();
        let mesh = raw::read_skin(&skin, &indices).unwrap();
        assert!(raw::write_vertices(&mesh) == skin);
        assert!(raw::write_triangles(&mesh) == indices);

        let rigid: Vec<u8> = (0..vertices * RIGID_FLOATS * 4).map(|_| random.next() as u8).collect();
        let mesh = raw::read_rigid(&rigid, &indices).unwrap();
        assert!(raw::write_vertices(&mesh) == rigid);
        assert!(raw::write_triangles(&mesh) == indices);
    }
}

#[test]
fn a_mesh_from_elsewhere_is_written_with_zeros_for_what_it_lacks() {
    let mut mesh = Random(2).mesh(3, 1, 9);
    mesh.skinning.as_mut().unwrap().blend_index.clear();
    let again = raw::read_skin(&raw::write_vertices(&mesh), &raw::write_triangles(&mesh)).unwrap();
    assert_eq!(again.positions, mesh.positions);
    assert_eq!(again.shapes[0].positions, mesh.shapes[0].positions);
    assert_eq!(again.shapes[1].positions, vec![Vec3::ZERO; 3].into());
    assert_eq!(again.shapes[1].normals, Some(vec![Vec3::ZERO; 3].into()));
    assert_eq!(again.skinning.unwrap().blend_index, [Vec3::ZERO; 3]);
}

#[test]
fn buffers_of_a_wrong_size_are_refused_with_the_size() {
    let vertex = bytes(&skin_vertex(0.0));
    for found in [1, 123, 125, 247] {
        let data = vertex.repeat(2);
        let error = raw::read_skin(&data[..found], &[]).unwrap_err();
        assert_eq!(error, MeshError::PartialElement { element: "vertices", element_bytes: 124, found });
        assert_eq!(
            error.to_string(),
            format!("expected a whole number of 124-byte vertices, found {found} bytes")
        );
    }
    for found in [1, 31, 33, 63] {
        let error = raw::read_rigid(&vertex[..found], &[]).unwrap_err();
        assert_eq!(error, MeshError::PartialElement { element: "vertices", element_bytes: 32, found });
    }
    for found in [1, 4, 11, 13] {
        let expected = MeshError::PartialElement { element: "triangles", element_bytes: 12, found };
        assert_eq!(raw::read_skin(&vertex, &vertex[..found]), Err(expected.clone()));
        assert_eq!(raw::read_rigid(&vertex[..32], &vertex[..found]), Err(expected));
    }
    assert_eq!(raw::read_skin(&[], &[]), Err(MeshError::NoVertices));
    assert_eq!(raw::read_rigid(&[], &[]), Err(MeshError::NoVertices));
}

#[test]
fn a_bone_index_is_a_whole_number_below_nine() {
    for slot in 0..4 {
        let read = |found: f32| {
            let mut floats = [skin_vertex(0.0), skin_vertex(0.0), skin_vertex(0.0)].concat();
            floats[2 * SKIN_FLOATS + 8 + slot] = found;
            raw::read_skin(&bytes(&floats), &[])
        };
        for good in [0.0, -0.0, 8.0] {
            assert_eq!(read(good).unwrap().skinning.unwrap().bones[2][slot], good as u16);
        }
        for found in
            [9.0, -1.0, 0.5, 7.999_999_5, 1e9, 65_536.0, f32::INFINITY, f32::NEG_INFINITY, f32::from_bits(1)]
        {
            assert_eq!(read(found), Err(MeshError::BoneIndex { vertex: 2, slot, found, last: 8 }));
        }
        let error = read(f32::NAN).unwrap_err();
        assert!(matches!(error, MeshError::BoneIndex { vertex: 2, found, last: 8, .. } if found.is_nan()));
        let text = format!("vertex 2, bone {slot}: expected a whole number from 0 to 8, found NaN");
        assert_eq!(error.to_string(), text);
    }
}

#[test]
fn the_seven_parts_are_those_of_the_format() {
    let listed = FACE_PARTS.map(|part| (part.name, part.stem));
    let expected = [
        ("skin", "MarsienneSkin"),
        ("upper-jaw", "UpperJaw"),
        ("lower-jaw", "LowerJaw"),
        ("right-eyeball", "RtEyeBall_smtt"),
        ("left-eyeball", "LtEyeBall_smtt"),
        ("right-cornea", "RtEyeTransp_smtt"),
        ("left-cornea", "LtEyeTransp_smtt"),
    ];
    assert_eq!(listed, expected);
    for part in &FACE_PARTS[1..] {
        let Follows::Joint(joint) = part.follows else { panic!("{} follows bones", part.name) };
        assert!(FACE_BONES.contains(&joint), "{joint}");
    }
    assert_eq!(FACE_PARTS[0].follows, Follows::Bones);
    assert_eq!(FACE_SHAPES, ["SSmile", "Frown"]);
    assert_eq!((FACE_BONES[0], FACE_BONES[6], FACE_BONES[8]), ("NeckJoint", "JawJoint", "RtEyeJoint"));
}

#[test]
fn the_files_of_a_real_face_come_back_to_the_byte() {
    let Some(data) = shared_data() else { return };
    let folder = data.join("avatar-course-format-makehuman");
    for part in FACE_PARTS {
        let read = |kind: &str| std::fs::read(folder.join(format!("{}_{kind}.raw", part.stem))).unwrap();
        let (vertices, indices) = (read("VB"), read("IB"));
        let mesh = match part.follows {
            Follows::Bones => raw::read_skin(&vertices, &indices),
            Follows::Joint(_) => raw::read_rigid(&vertices, &indices),
        };
        let mut mesh = mesh.unwrap();
        assert!(raw::write_vertices(&mesh) == vertices, "{}", part.name);
        assert!(raw::write_triangles(&mesh) == indices, "{}", part.name);
        println!("{}: {:?}", part.name, mesh.validate(FACE_BONES.len()).unwrap());
    }
}
