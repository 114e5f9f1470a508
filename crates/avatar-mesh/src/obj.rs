//! Wavefront OBJ text of deformed meshes.

use crate::Deformed;
use std::fmt::Write;

/// All positions (`v`), then all normals (`vn`), one each per vertex in its order, then the triangles as
/// `f v//vn`. Numbers are the shortest that read back to the same f32.
pub fn write(name: &str, deformed: &Deformed, triangles: &[[u32; 3]]) -> String {
    let mut out = String::with_capacity(64 * deformed.positions.len() + 32 * triangles.len());
    let one_line: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let _ = writeln!(out, "o {one_line}");
    for p in &deformed.positions {
        let _ = writeln!(out, "v {} {} {}", p.x, p.y, p.z);
    }
    for n in &deformed.normals {
        let _ = writeln!(out, "vn {} {} {}", n.x, n.y, n.z);
    }
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| u64::from(corner) + 1);
        let _ = writeln!(out, "f {a}//{a} {b}//{b} {c}//{c}");
    }
    out
}
