//! COLLADA 1.4 and 1.5.
//!
//! ```text
//!  bytes ──xml──▶ tree ──node──▶ nodes ──geometry, controller──▶ parts, skins ──material──▶ looks
//!                                  └────animation──▶ clips
//! ```
//!
//! The tree is read here rather than by the crate `dae-parser`: that one wants every file valid against the
//! schema of 1.4 and knows neither `polygons` nor 1.5, and so refuses a third of the files that real
//! exporters wrote. Whatever a file says, reading ends with a scene or an error, in bounded time and memory.

mod animation;
mod controller;
mod geometry;
mod material;
mod node;
mod part;
mod sampler;
mod source;
mod transform;
mod xml;

use crate::build::budget::Budget;
use crate::build::polygon::Cutter;
use crate::scene::{Finding, ImportError, Note, RawScene, Resolve, Scene};
use geometry::Geometry;
use material::Names;
use source::Source;
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;
use xml::{At, Tree};

/// Reads a `.dae` file: UTF-8, UTF-16 or Latin-1. `file` is its name for messages; `resolve` brings textures.
/// One that it does not bring is an image without bytes, with a note.
///
/// Where the file has another unit than the metre or another axis than +Y up, a root node is added that
/// converts it. Animations are one clip, or those that the file's `library_animation_clips` tells.
///
/// ```
/// let dae = br##"<COLLADA version="1.4.1">
///     <library_visual_scenes><visual_scene id="s">
///         <node id="hip"><translate>0 1 0</translate></node>
///     </visual_scene></library_visual_scenes>
/// </COLLADA>"##;
/// let scene = avatar_exchange::collada::read("hip.dae", dae, &mut |_| Err("no other files".to_owned()))?;
/// assert_eq!(scene.worlds(&scene.rest())[0].translation.y, 1.0);
/// # Ok::<(), avatar_exchange::ImportError>(())
/// ```
///
/// # Errors
/// Data that is not COLLADA, references without a target, or a need of memory far beyond the file's size.
pub fn read(file: &str, bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<Scene, ImportError> {
    let raw = read_raw(file, bytes, resolve)?;
    Scene::from_raw(raw).map_err(|error| error.in_file(file))
}

/// As [`read()`], before the scene is checked as a whole.
///
/// # Errors
/// As [`read()`].
pub fn read_raw(file: &str, bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<RawScene, ImportError> {
    read_all(bytes, resolve).map_err(|error| error.in_file(file))
}

fn read_all(bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<RawScene, ImportError> {
    let tree = Tree::read(bytes)?;
    let root = tree.root();
    if root.name() != "COLLADA" {
        return Err(ImportError::new(root.place(), "<COLLADA>", format!("<{}>", root.name())));
    }
    let mut reader = Reader {
        tree: &tree,
        scene: RawScene::default(),
        budget: Budget::of_vertices(bytes.len()),
        cutter: Cutter::default(),
        sources: HashMap::new(),
        geometries: HashMap::new(),
        texcoords: Vec::new(),
        terms: BTreeMap::new(),
    };
    let nodes = reader.read_nodes()?;
    let materials = reader.read_materials(resolve);
    let weights = reader.read_parts(&nodes, &materials)?;
    reader.read_clips(&nodes, &weights)?;
    for (library, what) in [("library_lights", "lights"), ("library_cameras", "cameras")] {
        let count: usize = root.all(library).map(|library| library.children().count()).sum();
        if count > 0 {
            reader.note(root, Finding::LeftOut(format!("{count} {what} are left out")));
        }
    }
    for text in reader.cutter.findings() {
        reader.scene.notes.push(Note::new("polygons", Finding::Mended(text)));
    }
    Ok(reader.scene)
}

/// A file on its way into a scene. What several elements refer to is read once.
#[derive(Debug)]
struct Reader<'a> {
    tree: &'a Tree,
    scene: RawScene,
    budget: Budget,
    cutter: Cutter,
    sources: HashMap<usize, Rc<Source>>,
    geometries: HashMap<usize, Rc<Geometry>>,
    /// For each material, how its textures name texture coordinates.
    texcoords: Vec<Names>,
    /// What materials have and surfaces have not: how many materials, and the first element.
    terms: BTreeMap<&'static str, (usize, usize)>,
}

impl Reader<'_> {
    fn note(&mut self, at: At<'_>, finding: Finding) {
        self.scene.notes.push(Note::new(at.place(), finding));
    }

    /// Takes from the budget on behalf of an element.
    fn take(&mut self, at: At<'_>, count: usize) -> Result<(), ImportError> {
        self.budget.take(count, 1).map_err(|exceeded| exceeded.at(at.place()))
    }
}
