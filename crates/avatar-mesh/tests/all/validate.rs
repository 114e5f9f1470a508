//! What a valid mesh is: each error at its vertex or triangle, each warning, and the thresholds from both
//! sides.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::{Random, edit_offset};
use avatar_mesh::{Mesh, MeshError, MeshWarning, Offsets, Shape};
use glam::Vec3;

const VERTICES: usize = 10;
const BONES: usize = 5;

fn mesh() -> Mesh {
    Random(1).mesh(VERTICES, 2, BONES)
}

fn after(edit: impl FnOnce(&mut Mesh)) -> Result<Vec<MeshWarning>, MeshError> {
    let mut mesh = mesh();
    edit(&mut mesh);
    mesh.validate(BONES)
}

fn weights(mesh: &mut Mesh) -> &mut Vec<[f32; 4]> {
    &mut mesh.skinning.as_mut().unwrap().weights
}

#[test]
fn a_valid_mesh_stays_as_it_is() {
    let mut valid = mesh();
    assert_eq!(valid.validate(BONES), Ok(vec![]));
    assert_eq!(valid, mesh());
    let mut rigid = Mesh { skinning: None, shapes: vec![], ..mesh() };
    assert_eq!(rigid.validate(1), Ok(vec![]));
}

#[test]
fn a_mesh_has_vertices_and_should_have_triangles() {
    assert_eq!(Mesh::default().validate(BONES), Err(MeshError::NoVertices));
    let warnings = after(|mesh| mesh.triangles.clear()).unwrap();
    assert_eq!(warnings, [MeshWarning::NoTriangles]);
    assert_eq!(warnings[0].to_string(), "expected triangles, found none: the part is invisible");
}

#[test]
fn every_array_is_as_long_as_the_positions() {
    let count =
        |what: &str, found| Err(MeshError::Count { what: what.to_owned(), expected: VERTICES, found });
    assert_eq!(after(|m| m.uvs.truncate(9)), count("uvs", 9));
    assert_eq!(after(|m| m.normals.push(glam::Vec3::X)), count("normals", 11));
    let shape = "position offsets of shape \"shape 1\"";
    assert_eq!(after(|m| m.shapes[1].positions = vec![Vec3::X; 3].into()), count(shape, 3));
    assert_eq!(
        after(|m| m.shapes[0].normals = Some(Offsets::default())),
        count("normal offsets of shape \"shape 0\"", 0)
    );
    let tangents = Shape::new("t", vec![Vec3::X; VERTICES]).with_tangents(vec![Vec3::X; 2]);
    assert_eq!(after(|m| m.shapes.push(tangents)), count("tangent offsets of shape \"t\"", 2));
    assert_eq!(after(|m| m.tangents = vec![glam::Vec4::W; 4]), count("tangents", 4));
    assert_eq!(after(|m| m.shapes[0].normals = None), Ok(vec![]));
    assert_eq!(after(|m| weights(m).truncate(1)), count("bone weights", 1));
    assert_eq!(after(|m| m.skinning.as_mut().unwrap().bones.truncate(2)), count("bone indices", 2));
    assert_eq!(after(|m| m.skinning.as_mut().unwrap().blend_index.truncate(4)), count("blend indices", 4));
    assert_eq!(after(|m| m.skinning.as_mut().unwrap().blend_index.clear()), Ok(vec![]));
    let text = count("uvs", 9).unwrap_err().to_string();
    assert_eq!(text, "expected 10 elements in uvs, found 9");
}

#[test]
fn every_number_is_finite() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for vertex in [0, 7, VERTICES - 1] {
            let check = |expected: &str, edit: &dyn Fn(&mut Mesh)| match after(edit) {
                Err(MeshError::NotFinite { vertex: v, field, found }) => {
                    assert_eq!((v, field.as_str(), found.to_bits()), (vertex, expected, bad.to_bits()));
                }
                other => panic!("{expected} {bad}: {other:?}"),
            };
            check("position", &|m| m.positions[vertex].z = bad);
            check("uv", &|m| m.uvs[vertex].y = bad);
            check("normal", &|m| m.normals[vertex].x = bad);
            check("position offset of shape 0", &|m| {
                edit_offset(&mut m.shapes[0].positions, vertex, |d| d.x = bad)
            });
            check("normal offset of shape 1", &|m| {
                edit_offset(m.shapes[1].normals.as_mut().unwrap(), vertex, |d| d.y = bad)
            });
            check("position offset of far", &|m| {
                let one = Shape::from_pairs("far", VERTICES, [(vertex as u32, Vec3::new(0.0, 1.0, bad))]);
                m.shapes.push(one.unwrap());
            });
            check("tangent offset of shape 0", &|m| {
                let mut offsets = vec![Vec3::ZERO; VERTICES];
                offsets[vertex].x = bad;
                m.shapes[0].tangents = Some(offsets.into());
            });
            check("tangent", &|m| {
                m.tangents = vec![glam::Vec4::W; VERTICES];
                m.tangents[vertex].w = bad;
            });
            check("bone weight", &|m| weights(m)[vertex][3] = bad);
            check("blend index", &|m| m.skinning.as_mut().unwrap().blend_index[vertex].y = bad);
        }
    }
    // The largest number is finite, however many of them there are.
    assert_eq!(after(|m| m.positions.fill(glam::Vec3::splat(f32::MAX))), Ok(vec![]));
    let error = after(|m| m.uvs[3].x = f32::INFINITY).unwrap_err();
    assert_eq!(error.to_string(), "vertex 3: expected a finite number in uv, found inf");
}

#[test]
fn every_corner_is_a_vertex() {
    for (triangle, corner) in [(0, 0), (4, 1), (VERTICES - 1, 2)] {
        for found in [VERTICES as u32, u32::MAX] {
            let expected = MeshError::IndexOutOfRange { triangle, corner, found, vertices: VERTICES };
            assert_eq!(after(|m| m.triangles[triangle][corner] = found), Err(expected));
        }
        assert_eq!(after(|m| m.triangles[triangle][corner] = VERTICES as u32 - 1), Ok(vec![]));
    }
    let error = after(|m| m.triangles[4][1] = 10).unwrap_err();
    assert_eq!(error.to_string(), "triangle 4, corner 1: expected a vertex below 10, found 10");
    // A triangle without area is no error.
    assert_eq!(after(|m| m.triangles[0] = [3, 3, 3]), Ok(vec![]));
}

#[test]
fn every_bone_is_in_the_palette() {
    for slot in 0..4 {
        let error = after(|m| m.skinning.as_mut().unwrap().bones[6][slot] = BONES as u16);
        assert_eq!(error, Err(MeshError::BoneIndex { vertex: 6, slot, found: 5.0, last: 4 }));
    }
}

/// Weights 1/2, 1/4, 1/8 and the rest: their sum in f64 is 1 + `off` but for the rounding of the last weight,
/// 4e-9.
fn off(off: f64) -> [f32; 4] {
    [0.5, 0.25, 0.125, (0.125 + off) as f32]
}

#[test]
fn weights_within_a_millionth_are_taken_as_they_are() {
    for sign in [1.0, -1.0] {
        let mut mesh = mesh();
        weights(&mut mesh)[3] = off(sign * 0.98e-6);
        let before = mesh.clone();
        assert_eq!(mesh.validate(BONES), Ok(vec![]));
        assert_eq!(mesh, before);
    }
}

#[test]
fn weights_within_a_thousandth_are_renormalised_with_a_warning() {
    for off_by in [1.02e-6, -1.02e-6, 0.9999e-3, -0.9999e-3] {
        let mut mesh = mesh();
        weights(&mut mesh)[3] = off(off_by);
        weights(&mut mesh)[5] = off(off_by / 2.0);
        weights(&mut mesh)[7] = off(off_by);
        let before = mesh.clone();
        let warnings = mesh.validate(BONES).unwrap();
        let [MeshWarning::Renormalised { vertices, worst, sum }] = warnings[..] else {
            panic!("{warnings:?}")
        };
        // The half is below the threshold for the small pair. Of equals the first is the worst.
        assert_eq!((vertices, worst), (if off_by.abs() > 1e-5 { 3 } else { 2 }, 3));
        assert!((sum - 1.0 - off_by).abs() < 1e-8, "{sum}");
        for (i, (new, old)) in
            weights(&mut mesh).iter().zip(&before.skinning.as_ref().unwrap().weights).enumerate()
        {
            if [3, 7].contains(&i) {
                let total: f64 = old.iter().map(|&w| f64::from(w)).sum();
                assert_eq!(*new, old.map(|w| (f64::from(w) / total) as f32));
            } else if i != 5 {
                assert_eq!(new, old);
            }
        }
        let text = warnings[0].to_string();
        assert!(text.starts_with("expected bone weights that sum to 1, renormalised "), "{text}");
        assert!(text.contains("(vertex 3: sum "), "{text}");
        // What was mended needs no mending.
        assert_eq!(mesh.validate(BONES), Ok(vec![]));
    }
}

#[test]
fn weights_beyond_a_thousandth_are_an_error() {
    for off_by in [1.0001e-3, -1.0001e-3, 1.0, -1.0] {
        let Err(MeshError::WeightSum { vertex, found }) = after(|m| {
            weights(m)[3] = off(0.5e-3);
            weights(m)[8] = off(off_by);
        }) else {
            panic!("{off_by} was accepted")
        };
        assert_eq!(vertex, 8);
        assert!((found - 1.0 - off_by).abs() < 1e-7, "{found}");
    }
    let error = after(|m| weights(m)[2] = [0.0; 4]).unwrap_err();
    assert_eq!(error, MeshError::WeightSum { vertex: 2, found: 0.0 });
    let text = "vertex 2: expected bone weights that sum to 1 (within 0.001), found 0";
    assert_eq!(error.to_string(), text);
}
