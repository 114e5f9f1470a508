//! Wavefront OBJ text of deformed meshes.

use crate::Deformed;
use glam::{Vec2, Vec3};
use std::fmt::Write;

/// All positions (`v`), then all normals (`vn`), one each per vertex in its order, then the triangles as
/// `f v//vn`. Numbers are the shortest that read back to the same f32.
pub fn write(name: &str, deformed: &Deformed, triangles: &[[u32; 3]]) -> String {
    let Deformed { positions, normals, .. } = deformed;
    write_parts(&[ObjPart { name, positions, normals, uvs: &[], triangles }])
}

/// A part of [`write_parts`]. Arrays that are shorter than the positions are left out.
#[derive(Clone, Copy, Debug)]
pub struct ObjPart<'a> {
    /// Becomes an object.
    pub name: &'a str,
    /// Positions in world space.
    pub positions: &'a [Vec3],
    /// Normals in world space; may be empty.
    pub normals: &'a [Vec3],
    /// Texture coordinates, origin top left; may be empty.
    pub uvs: &'a [Vec2],
    /// Triangles of the part's own vertices.
    pub triangles: &'a [[u32; 3]],
}

/// Several parts as objects of one text. Numbers are the shortest that read back to the same f32, but for v
/// of texture coordinates, which OBJ counts from below: there they are the shortest of 64 bits.
pub fn write_parts(parts: &[ObjPart<'_>]) -> String {
    let mut out = String::new();
    let [mut first, mut first_uv, mut first_normal] = [1u64; 3];
    for part in parts {
        let one_line: String = part.name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        // A backslash at the end would join the next line.
        let _ = writeln!(out, "o {}", one_line.trim_end_matches('\\'));
        let vertices = part.positions.len();
        let uvs = if part.uvs.len() < vertices { &[] } else { &part.uvs[..vertices] };
        let normals = if part.normals.len() < vertices { &[] } else { &part.normals[..vertices] };
        for p in part.positions {
            let _ = writeln!(out, "v {} {} {}", p.x, p.y, p.z);
        }
        for uv in uvs {
            let _ = writeln!(out, "vt {} {}", uv.x, 1.0 - f64::from(uv.y));
        }
        for n in normals {
            let _ = writeln!(out, "vn {} {} {}", n.x, n.y, n.z);
        }
        for corners in part.triangles {
            out.push('f');
            for corner in corners.map(u64::from) {
                let (v, vt, vn) = (first + corner, first_uv + corner, first_normal + corner);
                let _ = match (uvs.is_empty(), normals.is_empty()) {
                    (true, true) => write!(out, " {v}"),
                    (false, true) => write!(out, " {v}/{vt}"),
                    (true, false) => write!(out, " {v}//{vn}"),
                    (false, false) => write!(out, " {v}/{vt}/{vn}"),
                };
            }
            out.push('\n');
        }
        first += vertices as u64;
        first_uv += uvs.len() as u64;
        first_normal += normals.len() as u64;
    }
    out
}
