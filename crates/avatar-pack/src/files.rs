//! Names of the files of a pack in the raw format. Those of pictures are
//! [`Texture::stem`](crate::Texture::stem).

use avatar_mesh::PartSpec;

/// The joints.
pub const RIG: &str = "Transformations.xml";
/// The names that the joints' file has in the wild, in the order in which they are looked for.
pub const RIG_NAMES: [&str; 2] = [RIG, "Transformationen.xml"];
/// The controls; may be missing.
pub const CONTROLS: &str = "controls.toml";
/// The poses; may be missing.
pub const POSES: &str = "poses.toml";
/// Clips of controls; may be missing.
pub const CLIPS: &str = "clips.toml";
/// The looks of the parts; may be missing.
pub const MATERIALS: &str = "materials.toml";
/// The hair; may be missing.
pub const HAIR: &str = "hair.toml";
/// What swings by itself; may be missing.
pub const SPRINGS: &str = "springs.toml";
/// Axes that make other people of the face; may be missing.
pub const IDENTITY: &str = "identity.toml";
/// Names of shapes beside the two of the raw format, and mixtures of controls; may be missing.
pub const SHAPES: &str = "shapes.toml";
/// What these shapes move, where `shapes.toml` has any.
pub const SHAPES_RAW: &str = "shapes.raw";

/// The vertices of a part.
pub fn vertices(part: &PartSpec) -> String {
    format!("{}_VB.raw", part.stem)
}

/// The triangles of a part.
pub fn triangles(part: &PartSpec) -> String {
    format!("{}_IB.raw", part.stem)
}
