//! Meshes and animations of id Tech 4: `.md5mesh` and `.md5anim`, version 10.
//!
//! In the format z points up and models look along x; triangles run clockwise. Numbers stay those of the
//! file, below a root node that turns x to z, y to x and z to y, so that faces look along +Z; triangles are
//! turned around. Texture coordinates begin at the top left already. Normals are computed, since there are
//! none in the file, and a shader is a name only.
//!
//! ```
//! use avatar_exchange::{TextFile, md5::read};
//!
//! let mesh = b"MD5Version 10 numJoints 1 numMeshes 1
//! joints { \"origin\" -1 ( 0 0 1 ) ( 0 0 0 ) }
//! mesh {
//!     shader \"skin\"
//!     numverts 3 vert 0 ( 0 0 ) 0 1 vert 1 ( 1 0 ) 1 1 vert 2 ( 0 1 ) 2 1
//!     numtris 1 tri 0 0 2 1
//!     numweights 3 weight 0 0 1 ( 0 0 0 ) weight 1 0 1 ( 1 0 0 ) weight 2 0 1 ( 0 1 0 )
//! }";
//! let scene = read(TextFile { file: "a.md5mesh", bytes: mesh }, &[])?;
//! let mesh = &scene.parts[0].mesh;
//! assert_eq!((mesh.positions[1], mesh.triangles[0]), (glam::Vec3::new(1.0, 0.0, 1.0), [0, 1, 2]));
//! # Ok::<(), avatar_exchange::ImportError>(())
//! ```

mod anim;
mod mesh;
mod words;

use crate::build::text::{decode, stem};
use crate::scene::{
    Finding, ImportError, Node, Note, RawScene, Scene, ScenePart, Skin, TextFile, Transform, Trs, narrow,
};
use glam::{DAffine3, Quat};
use words::Words;

/// A third of a turn about the diagonal, which is exact in f32: x becomes z, y becomes x, z becomes y.
const WORLD_FROM_MODEL: Quat = Quat::from_xyzw(-0.5, -0.5, -0.5, 0.5);

/// Reads a mesh and any number of its animations, each of which becomes a clip.
///
/// # Errors
/// The first line that is wrong, and animations of other joints.
pub fn read(mesh: TextFile<'_>, animations: &[TextFile<'_>]) -> Result<Scene, ImportError> {
    Scene::from_raw(read_raw(mesh, animations)?).map_err(|error| error.in_file(mesh.file))
}

/// The same, unchecked.
///
/// # Errors
/// The first line that is wrong, and animations of other joints.
pub fn read_raw(mesh: TextFile<'_>, animations: &[TextFile<'_>]) -> Result<RawScene, ImportError> {
    let text = decode(mesh.bytes);
    let model = mesh::read(&mut Words::new(&text)).map_err(|error| error.in_file(mesh.file))?;
    let mut raw = scene(stem(mesh.file), model);
    let turned = "z is up and x is forward there: the node above all joints turns them to y and z";
    let turned = Finding::converted(turned);
    raw.notes.push(Note::new(mesh.file, turned));
    for animation in animations {
        let text = decode(animation.bytes);
        let clip = anim::read(&mut Words::new(&text), stem(animation.file), &raw.nodes)
            .map_err(|error| error.in_file(animation.file))?;
        raw.clips.push(clip);
    }
    Ok(raw)
}

/// One node that turns the axes, then the joints in their order.
fn scene(name: &str, model: mesh::Model) -> RawScene {
    let mut raw = RawScene { notes: model.notes, materials: model.materials, ..RawScene::default() };
    let upright = Trs { rotation: WORLD_FROM_MODEL, ..Trs::default() };
    raw.nodes.push(Node { name: name.to_owned(), local: Transform::Trs(upright), ..Node::default() });
    let models: Vec<DAffine3> = model.joints.iter().map(|joint| joint.model_from_joint()).collect();
    for (joint, model_from_joint) in model.joints.iter().zip(&models) {
        let parent_from_joint = match joint.parent {
            Some(parent) => models[parent].inverse() * *model_from_joint,
            None => *model_from_joint,
        };
        let (_, rotation, translation) = parent_from_joint.to_scale_rotation_translation();
        let trs = Trs {
            translation: translation.as_vec3(),
            rotation: rotation.normalize().as_quat(),
            ..Trs::default()
        };
        let parent = Some(joint.parent.map_or(0, |parent| parent + 1));
        raw.nodes.push(Node {
            name: joint.name.clone(),
            parent,
            local: Transform::Trs(trs),
            weights: Vec::new(),
        });
    }
    if !model.joints.is_empty() {
        raw.skins.push(Skin {
            name: name.to_owned(),
            joints: (1..raw.nodes.len()).collect(),
            inverse_binds: models.iter().map(|model| narrow(model.inverse())).collect(),
        });
    }
    for (primitive, part) in model.parts.into_iter().enumerate() {
        let name = if part.name.is_empty() { name } else { &part.name };
        raw.parts.push(ScenePart {
            primitive,
            material: Some(part.material),
            ..ScenePart::skinned(name, 0, part.mesh, 0)
        });
    }
    raw
}
