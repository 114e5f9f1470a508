use crate::{Bounds, Shape, Skinning};
use glam::{Vec2, Vec3, Vec4};

/// A triangle mesh that shapes and bones can deform. All vertex arrays have one length, but for those that
/// may be empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions at bind pose: of packs in the raw format in world space, of other files in the space of the
    /// node or skin that holds the mesh. The bone matrices take them to the world from there.
    pub positions: Vec<Vec3>,
    /// Texture coordinates, origin top left; outside 0…1 the texture repeats.
    pub uvs: Vec<Vec2>,
    /// Second texture coordinates, for the textures of a material that use them. May be empty.
    pub uvs_1: Vec<Vec2>,
    /// Linear colour and opacity of each vertex, factors on those of the material. May be empty.
    pub colors: Vec<Vec4>,
    /// Normals at bind pose, in the space of the positions, of about unit length.
    pub normals: Vec<Vec3>,
    /// Tangents as in glTF 2.0: unit directions of growing u, and in w the handedness ±1 of `bitangent = w ·
    /// (n × t)`. May be empty.
    pub tangents: Vec<Vec4>,
    /// Triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Bones of each vertex; a mesh without follows one matrix.
    pub skinning: Option<Skinning>,
    /// Blend shapes; any number.
    pub shapes: Vec<Shape>,
}

/// Deformed positions, normals and, where the mesh has them, tangents, one each per vertex of the mesh, in
/// its order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deformed {
    /// Positions in world space.
    pub positions: Vec<Vec3>,
    /// Unit normals in world space.
    pub normals: Vec<Vec3>,
    /// Unit tangents in world space, with the handedness of the mesh, or the other one where bones mirror;
    /// empty where the mesh has none.
    pub tangents: Vec<Vec4>,
}

impl Mesh {
    /// Room for the result of [`crate::deform()`], holding the undeformed mesh.
    pub fn deformed(&self) -> Deformed {
        Deformed {
            positions: self.positions.clone(),
            normals: self.normals.clone(),
            tangents: self.tangents.clone(),
        }
    }

    /// The box around the undeformed mesh; `None` without vertices.
    pub fn bounds(&self) -> Option<Bounds> {
        Bounds::of(&self.positions)
    }
}
