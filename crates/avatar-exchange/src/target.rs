//! MakeHuman targets: shapes of an OBJ file, as text.
//!
//! Each line is the place of a vertex among the file's `v` lines, from 0 on, and its offset in the file's
//! units (decimetres in MakeHuman's own). A target without lines is a shape that moves nothing.
//!
//! ```
//! use avatar_exchange::{obj, target};
//!
//! let base = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
//! let mut base = obj::read_obj("base.obj", base.as_bytes(), &mut |_| Err(String::new()))?;
//! target::add("jawOpen.target", b"# opens\n2 0 -.5 0\n", &mut base)?;
//! let scene = base.into_scene()?;
//! assert_eq!(scene.parts[0].mesh.shapes[0].name, "jawOpen");
//! # Ok::<(), avatar_exchange::ImportError>(())
//! ```

use crate::build::text::{at_line, decode, float, shown, stem};
use crate::obj::ObjFile;
use crate::scene::ImportError;
use glam::Vec3;

/// Reads offsets of some of `vertices` vertices, in the order of the file.
///
/// # Errors
/// The first line that is wrong: no index and three numbers, a vertex beyond the base, or one that comes
/// twice.
pub fn read(file: &str, bytes: &[u8], vertices: usize) -> Result<Vec<(u32, Vec3)>, ImportError> {
    let mut offsets = Vec::new();
    let mut seen = vec![false; vertices];
    for (row, text) in decode(bytes).lines().enumerate() {
        let mut words = text.split_whitespace().take_while(|word| !word.starts_with('#'));
        let Some(index) = words.next() else { continue };
        let offset = offset(row + 1, index, words, &mut seen).map_err(|error| error.in_file(file))?;
        offsets.push(offset);
    }
    Ok(offsets)
}

/// Reads a target as a shape of all parts of its base, named like the file.
///
/// # Errors
/// The first line that is wrong, or a shape of this name that is there already.
pub fn add(file: &str, bytes: &[u8], base: &mut ObjFile) -> Result<(), ImportError> {
    let offsets = read(file, bytes, base.positions.len())?;
    base.add_shape(stem(file), &offsets).map_err(|error| error.in_file(file))
}

fn offset<'a>(
    line: usize,
    index: &str,
    mut words: impl Iterator<Item = &'a str>,
    seen: &mut [bool],
) -> Result<(u32, Vec3), ImportError> {
    let expected = || format!("a vertex of the base, below {}", seen.len());
    let vertex: u32 = index.parse().map_err(|_| at_line(line, expected(), shown(index)))?;
    let Some(seen_here) = seen.get(vertex as usize) else {
        return Err(at_line(line, expected(), vertex.to_string()));
    };
    if *seen_here {
        return Err(at_line(line, "each vertex once", format!("{vertex} again")));
    }
    seen[vertex as usize] = true;
    let mut next = |what| float(line, what, words.next());
    let offset = Vec3::new(next("x of an offset")?, next("y of an offset")?, next("z of an offset")?);
    match words.next() {
        Some(word) => Err(at_line(line, "a vertex and three numbers", format!("{} after them", shown(word)))),
        None => Ok((vertex, offset)),
    }
}
