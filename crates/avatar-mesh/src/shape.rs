use crate::{Offsets, OffsetsError};
use glam::Vec3;

/// A blend shape in relative form: offsets from the base shape at weight 1.
///
/// ```
/// use avatar_mesh::Shape;
/// use glam::Vec3;
///
/// // Of a mesh of 1000 vertices, the lips move.
/// let pout = Shape::from_pairs("pout", 1000, [(410, Vec3::Z), (411, Vec3::Z * 0.5)])?;
/// assert_eq!((pout.moved_vertices(), pout.memory_bytes()), (2, 32));
/// let wave = Shape::new("wave", vec![Vec3::X; 4]).with_normals(vec![Vec3::Y; 4]);
/// assert_eq!(wave.positions.get(3), Some(Vec3::X));
/// # Ok::<(), avatar_mesh::OffsetsError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Name, unique in the mesh.
    pub name: String,
    /// Offsets of the positions.
    pub positions: Offsets,
    /// Offsets of the normals; without them the shape leaves normals alone ([`crate::ShapeNormals`] says what
    /// else is possible).
    pub normals: Option<Offsets>,
    /// Offsets of the tangents' directions, for meshes with [`crate::Mesh::tangents`].
    pub tangents: Option<Offsets>,
}

impl Shape {
    /// A shape that moves positions. `offsets` may be one offset per vertex (`Vec<Vec3>`) or [`Offsets`].
    pub fn new(name: impl Into<String>, offsets: impl Into<Offsets>) -> Self {
        Self { name: name.into(), positions: offsets.into(), ..Self::default() }
    }

    /// A shape that moves the positions of some of `vertices` vertices.
    ///
    /// # Errors
    /// A vertex beyond the mesh, or one that comes twice.
    pub fn from_pairs(
        name: impl Into<String>,
        vertices: usize,
        offsets: impl IntoIterator<Item = (u32, Vec3)>,
    ) -> Result<Self, OffsetsError> {
        Ok(Self::new(name, Offsets::from_pairs(vertices, offsets)?))
    }

    /// The shape with offsets for normals.
    #[must_use]
    pub fn with_normals(self, offsets: impl Into<Offsets>) -> Self {
        Self { normals: Some(offsets.into()), ..self }
    }

    /// The shape with offsets for tangents.
    #[must_use]
    pub fn with_tangents(self, offsets: impl Into<Offsets>) -> Self {
        Self { tangents: Some(offsets.into()), ..self }
    }

    /// Number of vertices whose position it moves.
    pub fn moved_vertices(&self) -> usize {
        self.positions.moved_vertices()
    }

    /// Bytes that its offsets take.
    pub fn memory_bytes(&self) -> usize {
        self.arrays().map(|(_, offsets)| offsets.memory_bytes()).sum()
    }

    /// Its offsets and what they are offsets of.
    pub(crate) fn arrays(&self) -> impl Iterator<Item = (&'static str, &Offsets)> {
        let others = [("normal", self.normals.as_ref()), ("tangent", self.tangents.as_ref())];
        std::iter::once(("position", &self.positions))
            .chain(others.into_iter().filter_map(|(what, offsets)| Some((what, offsets?))))
    }
}
