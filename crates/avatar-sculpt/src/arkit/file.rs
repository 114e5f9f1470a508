//! The shapes as files of the pack: `shapes.toml` says what they are, `shapes.raw` holds the offsets.

use std::fmt::Write as _;

use avatar_mesh::{Offsets, Shape, raw_shapes};
use glam::{DVec3, Vec3};

use super::{Moved, Weight};

/// Other names of what bones do, and the sounds of speech: text that people read and edit.
const MIXTURES: &str = include_str!("mixtures.toml");

/// Which shapes wrinkle the skin: text that people read and edit.
const WRINKLES: &str = include_str!("wrinkles.toml");

/// The parts of the raw format that shapes move, by the stems of their files.
const PARTS: [(&str, &str); 2] = [("MarsienneSkin", "skin"), ("LowerJaw", "lower-jaw")];

/// The file `shapes.toml`.
#[must_use]
pub fn toml(moved: &[Moved]) -> String {
    let mut text = String::from(
        "# The shapes of ARKit that bones cannot make, in the order of shapes.raw; then what bones do, and the\n\
         # sounds of speech. docs/packs.md describes the format.\n",
    );
    for parts in moved.chunk_by(|a, b| a.name == b.name) {
        let name = &parts[0].name;
        // Writing to a string does not fail.
        let _ = write!(text, "\n[[shape]]\nname = \"{name}\"\ngroup = \"{}\"\n", group(name));
        if let Some(side) = ["Left", "Right"].into_iter().find(|side| name.ends_with(side)) {
            let _ = writeln!(text, "side = \"{}\"", side.to_lowercase());
        }
        let named = |m: &Moved| PARTS.iter().find(|(stem, _)| *stem == m.stem).map_or("", |(_, name)| *name);
        if parts.iter().any(|m| named(m) != PARTS[0].1) {
            let names: Vec<String> = parts.iter().map(|m| format!("\"{}\"", named(m))).collect();
            let _ = writeln!(text, "parts = [{}]", names.join(", "));
        }
        let _ = match parts[0].weight {
            Weight::Control => Ok(()),
            Weight::Follows(input, at) => writeln!(text, "follows = \"{input}\"\nat = {at:?}"),
            // Both shapes of a pair have got the weight of their side.
            Weight::Product([a, b]) | Weight::OfSide([a, _], [b, _]) => {
                writeln!(text, "product = [\"{a}\", \"{b}\"]")
            }
        };
    }
    text.push('\n');
    text.push_str(MIXTURES);
    text.push_str(WRINKLES);
    text
}

/// Where a shape is listed.
fn group(name: &str) -> &'static str {
    let groups = [
        ("brow", "brows"),
        ("eye", "eyes"),
        ("lid", "eyes"),
        ("cheek", "cheeks"),
        ("nose", "nose"),
        ("jaw", "jaw"),
    ];
    groups.into_iter().find(|(start, _)| name.starts_with(start)).map_or("mouth", |(_, group)| group)
}

/// The file `shapes.raw`.
#[must_use]
pub fn raw(moved: &[Moved]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for m in moved {
        let offsets = |d: &[DVec3]| d.iter().map(|d| d.as_vec3() + Vec3::ZERO).collect::<Offsets>();
        let shape = Shape::new(&*m.name, offsets(&m.offsets)).with_normals(offsets(&m.normals));
        raw_shapes::write(&shape, &mut bytes);
    }
    bytes
}
