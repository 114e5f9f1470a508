//! Wavefront OBJ: meshes, materials, shapes and sequences of files.
//!
//! Groups, objects and materials become parts of one node. Polygons become triangles, concave ones, too.
//! Normals that a file lacks are computed: smooth, or as its smoothing groups say.
//!
//! The lines are read here rather than by a library, since errors name their line, shapes need the file's own
//! order of vertices and smoothing groups matter, which the common libraries drop.
//!
//! ```
//! let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng wall\nf 1 2 3 4\n";
//! let mut obj = avatar_exchange::obj::read_obj("wall.obj", text.as_bytes(), &mut |_| Err(String::new()))?;
//! assert_eq!((obj.positions.len(), obj.parts[0].mesh.triangles.len()), (4, 2));
//! // The third vertex of the file moves.
//! obj.add_shape("lean", &[(2, glam::Vec3::Z)])?;
//! let scene = obj.into_scene()?;
//! assert_eq!(scene.parts[0].name, "wall");
//! # Ok::<(), avatar_exchange::ImportError>(())
//! ```

mod build;
mod mtl;
mod parse;
mod sequence;

pub use sequence::{ObjFrame, read_sequence};

use crate::build::text::decode;
use crate::scene::{ImportError, Material, Node, Note, RawScene, Resolve, Scene, SceneImage, ScenePart};
use avatar_mesh::{Mesh, Shape, SmoothNormals};
use glam::Vec3;

/// An OBJ file with the order of its vertices, which is what shapes of it refer to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjFile {
    /// Its name, for messages.
    pub file: String,
    /// The name without folders and extension.
    pub name: String,
    /// All vertices (`v`) in the order of the file, used by faces or not.
    pub positions: Vec<Vec3>,
    /// All faces in the order of the file.
    pub faces: ObjFaces,
    /// What is drawn.
    pub parts: Vec<ObjPart>,
    /// The materials that parts name, in the order in which the file names them.
    pub materials: Vec<Material>,
    /// Their textures.
    pub images: Vec<SceneImage>,
    /// How the scene differs from the file.
    pub notes: Vec<Note>,
}

/// The polygons of a file before they became triangles.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ObjFaces {
    /// The corners of all faces, one face after the other: places among [`ObjFile::positions`].
    pub corners: Vec<u32>,
    /// For each corner its vertex in the part of its face.
    pub vertices: Vec<u32>,
    /// For each face where the next one's corners begin.
    pub ends: Vec<u32>,
    /// For each face its part.
    pub parts: Vec<u32>,
}

/// The faces of one group or object with one material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjPart {
    /// Its group, or else its object, or else the file.
    pub name: String,
    /// Among the file's materials.
    pub material: Option<usize>,
    /// A vertex for each use of a position with other texture coordinates or another normal; those of no face
    /// are left out.
    pub mesh: Mesh,
    /// For each vertex, never falling: its place among [`ObjFile::positions`].
    pub sources: Vec<u32>,
}

/// Reads a file as a scene.
///
/// # Errors
/// The first line that is wrong, or a file without faces.
pub fn read(file: &str, bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<Scene, ImportError> {
    read_obj(file, bytes, resolve)?.into_scene()
}

/// Reads a file with the order of its vertices. Libraries and images that `resolve` does not bring get notes.
///
/// # Errors
/// The first line that is wrong, in the file or in one of its libraries, or a file without faces.
pub fn read_obj(file: &str, bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<ObjFile, ImportError> {
    let in_file = |error: ImportError| if error.file.is_empty() { error.in_file(file) } else { error };
    let lines = parse::parse(&decode(bytes)).map_err(in_file)?;
    let mut obj = build::build(file, &lines).map_err(in_file)?;
    mtl::attach(&mut obj, &lines.materials, &lines.libraries, resolve).map_err(in_file)?;
    Ok(obj)
}

impl ObjFile {
    /// Gives every part a shape that moves some of the file's vertices. Vertices that no face uses are
    /// ignored.
    ///
    /// # Errors
    /// A vertex that the file lacks, one that comes twice, or a shape of this name that is there already.
    pub fn add_shape(&mut self, name: &str, offsets: &[(u32, Vec3)]) -> Result<(), ImportError> {
        self.check_name(name)?;
        let vertices = self.positions.len();
        let wrong = |error: avatar_mesh::OffsetsError| {
            ImportError::new(format!("shape {name:?}"), "offsets of its vertices", error.to_string())
                .in_file(&self.file)
        };
        avatar_mesh::Offsets::from_pairs(vertices, offsets.iter().copied()).map_err(wrong)?;
        let mut shapes = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            let pairs = offsets.iter().flat_map(|&(position, offset)| {
                let first = part.sources.partition_point(|source| *source < position);
                let uses = part.sources[first..].iter().take_while(move |source| **source == position);
                uses.enumerate().map(move |(k, _)| ((first + k) as u32, offset))
            });
            shapes.push(Shape::from_pairs(name, part.sources.len(), pairs).map_err(wrong)?);
        }
        self.parts.iter_mut().zip(shapes).for_each(|(part, shape)| part.mesh.shapes.push(shape));
        Ok(())
    }

    /// Names of shapes are unique.
    fn check_name(&self, name: &str) -> Result<(), ImportError> {
        if self.parts.iter().flat_map(|part| &part.mesh.shapes).any(|shape| shape.name == name) {
            let place = format!("shape {name:?}");
            return Err(
                ImportError::new(place, "a name of its own", "a shape of this name").in_file(&self.file)
            );
        }
        Ok(())
    }

    /// A scene of one node with all parts. Shapes without normals of their own get those of
    /// [`SmoothNormals`].
    pub fn into_raw(mut self) -> RawScene {
        self.add_shape_normals();
        let shapes = self.parts.iter().map(|part| part.mesh.shapes.len()).max().unwrap_or(0);
        let node = Node { name: self.name, weights: vec![0.0; shapes], ..Node::default() };
        let parts = self.parts.into_iter().enumerate().map(|(primitive, part)| ScenePart {
            primitive,
            material: part.material,
            ..ScenePart::rigid(&part.name, 0, part.mesh)
        });
        RawScene {
            nodes: vec![node],
            parts: parts.collect(),
            materials: self.materials,
            images: self.images,
            notes: self.notes,
            ..RawScene::default()
        }
    }

    /// Computed for all parts as one surface: they may be cut where it is smooth.
    fn add_shape_normals(&mut self) {
        let shapes = self.parts.iter().map(|part| part.mesh.shapes.len()).max().unwrap_or(0);
        let lacks =
            |part: &ObjPart, shape: usize| part.mesh.shapes.get(shape).is_some_and(|s| s.normals.is_none());
        let incomplete: Vec<usize> =
            (0..shapes).filter(|shape| self.parts.iter().any(|part| lacks(part, *shape))).collect();
        if incomplete.is_empty() {
            return;
        }
        let mut whole = Mesh::default();
        for ObjPart { mesh, .. } in &self.parts {
            let first = whole.positions.len() as u32;
            whole.positions.extend_from_slice(&mesh.positions);
            whole.normals.extend_from_slice(&mesh.normals);
            whole.triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        }
        let mut smooth = SmoothNormals::new(&whole);
        for shape in incomplete {
            let mut moved = whole.positions.clone();
            let mut rest = &mut moved[..];
            for ObjPart { mesh, .. } in &self.parts {
                let here;
                (here, rest) = rest.split_at_mut(mesh.positions.len());
                mesh.shapes.get(shape).into_iter().for_each(|shape| shape.positions.add_scaled(1.0, here));
            }
            let mut change = vec![Vec3::ZERO; moved.len()];
            smooth.add_change(&moved, &mut change);
            let mut change = change.into_iter();
            for part in &mut self.parts {
                let here: Vec<Vec3> = change.by_ref().take(part.mesh.positions.len()).collect();
                if let Some(shape) = part.mesh.shapes.get_mut(shape) {
                    shape.normals.get_or_insert_with(|| here.into());
                }
            }
        }
    }

    /// The same, checked.
    ///
    /// # Errors
    /// Public fields that were changed so that they contradict each other.
    pub fn into_scene(self) -> Result<Scene, ImportError> {
        let file = self.file.clone();
        Scene::from_raw(self.into_raw()).map_err(|error| error.in_file(&file))
    }
}
