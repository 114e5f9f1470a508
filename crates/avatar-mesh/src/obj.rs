//! Wavefront OBJ text of deformed meshes.

use crate::Deformed;
use std::fmt::Write;

/// A mesh among others.
#[derive(Clone, Copy, Debug)]
pub struct Object<'a> {
    /// Name; control characters become blanks.
    pub name: &'a str,
    /// Positions and normals.
    pub deformed: &'a Deformed,
    /// Corners as positions in them.
    pub triangles: &'a [[u32; 3]],
}

/// All positions (`v`), then all normals (`vn`), one each per vertex in its order, then the triangles as
/// `f v//vn`. Numbers are the shortest that read back to the same f32.
pub fn write(name: &str, deformed: &Deformed, triangles: &[[u32; 3]]) -> String {
    write_all(&[Object { name, deformed, triangles }])
}

/// As [`write()`], for several meshes, one object (`o`) each.
pub fn write_all(objects: &[Object<'_>]) -> String {
    let mut out = String::new();
    let mut first = 1u64;
    for Object { name, deformed, triangles } in objects {
        out.reserve(64 * deformed.positions.len() + 32 * triangles.len());
        let one_line: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        let _ = writeln!(out, "o {one_line}");
        for p in &deformed.positions {
            let _ = writeln!(out, "v {} {} {}", p.x, p.y, p.z);
        }
        for n in &deformed.normals {
            let _ = writeln!(out, "vn {} {} {}", n.x, n.y, n.z);
        }
        for corners in *triangles {
            let [a, b, c] = corners.map(|corner| first + u64::from(corner));
            let _ = writeln!(out, "f {a}//{a} {b}//{b} {c}//{c}");
        }
        first += deformed.positions.len() as u64;
    }
    out
}
