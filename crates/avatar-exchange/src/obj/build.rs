//! Parts of triangles from the polygons of a file.

use super::parse::{Corner, Face, Lines, Smoothing};
use super::{ObjFile, ObjPart};
use crate::build::normals::{NormalSums, Weighting};
use crate::build::polygon::Cutter;
use crate::build::text::{at_line, shown, stem};
use crate::scene::{Finding, ImportError, Note};
use avatar_mesh::Mesh;
use glam::{Vec2, Vec3, Vec4};
use std::collections::HashMap;

/// Marks a corner without texture coordinates.
const NO_UV: u32 = u32::MAX;

/// What makes a vertex of a part. Sorted, so that vertices come in the order of the file's.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    position: u32,
    uv: u32,
    normal: Normal,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Normal {
    /// One of the file's.
    Given(u32),
    /// One of the sums.
    Computed(u32),
}

pub(super) fn build(file: &str, lines: &Lines) -> Result<ObjFile, ImportError> {
    let mut obj = ObjFile {
        file: file.to_owned(),
        name: stem(file).to_owned(),
        positions: lines.positions.clone(),
        ..ObjFile::default()
    };
    if lines.faces.is_empty() {
        return Err(at_line(lines.last_line.max(1), "at least one face before the end", "none"));
    }
    check_indices(lines)?;
    let mut cutter = Cutter::default();
    let triangles: Vec<Vec<[usize; 3]>> =
        faces(lines).map(|(_, corners)| cutter.cut(&points(lines, corners))).collect();
    let (keys, sums) = keys(lines, &triangles);
    let mut part_keys = vec![Vec::new(); lines.parts.len()];
    for (face, corners) in faces(lines) {
        part_keys[face.part].extend_from_slice(&keys[corners]);
    }
    part_keys.iter_mut().for_each(|keys| {
        keys.sort_unstable();
        keys.dedup();
        keys.shrink_to_fit();
    });
    obj.parts = lines
        .parts
        .iter()
        .zip(&part_keys)
        .map(|(key, keys)| {
            let normal = |normal| match normal {
                Normal::Given(index) => given(lines, index).unwrap_or(Vec3::Y),
                Normal::Computed(group) => sums.normal(group),
            };
            let color = |key: &Key| lines.colors.get(key.position as usize).copied().unwrap_or(Vec3::ONE);
            let is_colored = keys.iter().any(|key| color(key) != Vec3::ONE);
            let colors: Vec<Vec4> =
                keys.iter().filter(|_| is_colored).map(|key| color(key).extend(1.0)).collect();
            let mesh = Mesh {
                colors,
                positions: keys.iter().map(|key| lines.positions[key.position as usize]).collect(),
                uvs: keys
                    .iter()
                    .map(|key| lines.uvs.get(key.uv as usize).copied().unwrap_or(Vec2::ZERO))
                    .collect(),
                normals: keys.iter().map(|key| normal(key.normal)).collect(),
                ..Mesh::default()
            };
            let name = if key.name.is_empty() { obj.name.clone() } else { key.name.clone() };
            let sources = keys.iter().map(|key| key.position).collect();
            ObjPart { name, material: key.material, mesh, sources }
        })
        .collect();
    for ((face, corners), triangles) in faces(lines).zip(&triangles) {
        let (keys_here, part) = (&keys[corners], &mut obj.parts[face.part]);
        // Every key was put there above.
        let vertex = |key: &Key| part_keys[face.part].partition_point(|other| other < key) as u32;
        let first = obj.faces.vertices.len();
        obj.faces.vertices.extend(keys_here.iter().map(vertex));
        obj.faces.corners.extend(keys_here.iter().map(|key| key.position));
        obj.faces.ends.push(obj.faces.corners.len() as u32);
        obj.faces.parts.push(face.part as u32);
        let vertices = &obj.faces.vertices[first..];
        part.mesh.triangles.extend(triangles.iter().map(|corners| corners.map(|corner| vertices[corner])));
    }
    obj.notes = notes(lines, &cutter);
    Ok(obj)
}

/// All faces with the range of their corners.
fn faces(lines: &Lines) -> impl Iterator<Item = (&Face, std::ops::Range<usize>)> {
    lines.faces.iter().enumerate().map(|(number, face)| {
        let end = lines.faces.get(number + 1).map_or(lines.corners.len(), |next| next.first_corner);
        (face, face.first_corner..end)
    })
}

fn check_indices(lines: &Lines) -> Result<(), ImportError> {
    for (face, corners) in faces(lines) {
        for corner in &lines.corners[corners] {
            let check = |what: &str, index: Option<u32>, length: usize| match index {
                Some(index) if index as usize >= length => {
                    let expected = format!("the number of {what}, at most {length}");
                    Err(at_line(face.line, expected, (u64::from(index) + 1).to_string()))
                }
                _ => Ok(()),
            };
            check("a vertex", Some(corner.position), lines.positions.len())?;
            check("a texture coordinate", corner.uv, lines.uvs.len())?;
            check("a normal", corner.normal, lines.normals.len())?;
        }
    }
    Ok(())
}

/// A normal of the file, as it is or of unit length.
fn given(lines: &Lines, index: u32) -> Option<Vec3> {
    let normal = *lines.normals.get(index as usize)?;
    let length = normal.as_dvec3().length();
    if (length - 1.0).abs() < 1e-3 {
        Some(normal)
    } else {
        normal.as_dvec3().try_normalize().map(|n| n.as_vec3())
    }
}

/// Where the corners of a face are.
fn points(lines: &Lines, corners: std::ops::Range<usize>) -> Vec<Vec3> {
    lines.corners[corners].iter().map(|corner| lines.positions[corner.position as usize]).collect()
}

/// The vertex of each corner, and sums of normals.
fn keys(lines: &Lines, triangles: &[Vec<[usize; 3]>]) -> (Vec<Key>, NormalSums) {
    let mut keys = Vec::with_capacity(lines.corners.len());
    let mut groups: HashMap<(u32, Smoothing), u32> = HashMap::new();
    let mut sums = NormalSums::new(0, Weighting::Angle);
    let mut ring = Vec::new();
    for ((face, corners), triangles) in faces(lines).zip(triangles) {
        let corners = &lines.corners[corners];
        let usable = |corner: &Corner| corner.normal.filter(|index| given(lines, *index).is_some());
        if corners.iter().any(|corner| usable(corner).is_none()) {
            ring.clear();
            let mut fresh = || sums.add_group();
            if face.smoothing == Smoothing::Flat {
                ring.resize(corners.len(), fresh());
            } else {
                let group = |corner: &Corner| {
                    *groups.entry((corner.position, face.smoothing)).or_insert_with(&mut fresh)
                };
                ring.extend(corners.iter().map(group));
            }
            let point = |corner: usize| lines.positions[corners[corner].position as usize];
            for triangle in triangles {
                sums.add(triangle.map(point), triangle.map(|corner| ring[corner]));
            }
        }
        keys.extend(corners.iter().enumerate().map(|(k, corner)| Key {
            position: corner.position,
            uv: corner.uv.unwrap_or(NO_UV),
            normal: usable(corner).map_or_else(|| Normal::Computed(ring[k]), Normal::Given),
        }));
    }
    (keys, sums)
}

fn notes(lines: &Lines, cutter: &Cutter) -> Vec<Note> {
    let mut notes = Vec::new();
    let mut note =
        |line: usize, text: String| notes.push(Note::new(format!("line {line}"), Finding::LeftOut(text)));
    for (keyword, (count, line)) in &lines.unknown {
        note(*line, format!("{count} lines {} are left out", shown(keyword)));
    }
    if let Some(line) = lines.rational {
        note(line, "weights of vertices, for rational curves, are left out".to_owned());
    }
    if let Some(line) = lines.odd_color {
        let text = "colours of vertices beyond 0 to 1 are brought into it".to_owned();
        notes.push(Note::new(format!("line {line}"), Finding::Mended(text)));
    }
    notes.extend(cutter.findings().map(|text| Note::new("faces", Finding::Mended(text))));
    notes
}
