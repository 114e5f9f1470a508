//! What the structures of the JSON drop without a word, and what memory they will take, found in a pass of
//! its own before they are made.

use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use std::collections::BTreeSet;
use std::fmt;

/// Names that occur in a JSON text.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// All extensions that some object has, whether the file lists them or not.
    pub(super) extensions: BTreeSet<String>,
    /// Those that something has which geometry or motion is made of.
    pub(super) of_geometry: BTreeSet<String>,
    /// What morph targets move beside positions, normals and tangents.
    pub(super) target_attributes: BTreeSet<String>,
    /// Bytes that the structures of the text take at most, with what becomes of them in a scene.
    pub(super) bytes: usize,
    /// Bytes that the text takes at most as a tree of values.
    pub(super) bytes_of_tree: usize,
}

/// Bytes of an object as a value: one node of a B-tree, with room for eleven members.
const TREE_OBJECT: usize = 720;
/// Bytes of any other value in a list that doubles when it is full, which holds one and a half as much for a
/// while.
const TREE_VALUE: usize = 3 * size_of::<serde_json::Value>();
/// Bytes of an object within an element of a list of the file: a primitive, a channel, attributes by name.
const INNER_OBJECT: usize = 512;
/// Bytes of a string beside its letters.
const TEXT: usize = 100;
/// Bytes of a name in a list of the file, and of the note that may say that it is not known.
const LISTED_NAME: usize = 400;
/// Bytes of a number in a list.
const NUMBER: usize = 3 * size_of::<f32>();

/// Bytes of an element of a list of the file: its structure, in a list that doubles when it is full, and what
/// a scene makes of it.
fn bytes_of_element(list: &str) -> usize {
    use gltf::json as structures;
    let (structure, in_scene) = match list {
        // A joint of an avatar takes as much again.
        "nodes" => return 1_000,
        "accessors" => (size_of::<structures::Accessor>(), 0),
        "animations" => (size_of::<structures::Animation>(), 400),
        "buffers" => (size_of::<structures::Buffer>(), 100),
        "bufferViews" => (size_of::<structures::buffer::View>(), 0),
        "cameras" => (size_of::<structures::Camera>(), 0),
        "images" => (size_of::<structures::Image>(), 500),
        "materials" => (size_of::<structures::Material>(), 1_000),
        "meshes" => (size_of::<structures::Mesh>(), 200),
        "samplers" => (size_of::<structures::texture::Sampler>(), 0),
        "scenes" => (size_of::<structures::Scene>(), 0),
        "skins" => (size_of::<structures::Skin>(), 400),
        "textures" => (size_of::<structures::Texture>(), 100),
        _ => (0, 0),
    };
    3 * structure + in_scene
}

/// Lists of the file that geometry and motion are made of.
const GEOMETRY: [&str; 7] = ["accessors", "animations", "bufferViews", "buffers", "meshes", "nodes", "skins"];

/// Members of a target that the structures have, or that say nothing of geometry.
const MOVED: [&str; 4] = ["POSITION", "NORMAL", "TANGENT", "extensions"];

/// Allocates no more than the names. What is wrong in the text ends the pass early, and is an error
/// elsewhere: whoever reads the text stops at the same place.
pub(super) fn scan(text: &[u8]) -> Found {
    let mut found = Found::default();
    let mut json = serde_json::Deserializer::from_slice(text);
    let _ = Walk { found: &mut found, at: At::Root, is_geometry: false }.deserialize(&mut json);
    found
}

#[derive(Clone, Copy, PartialEq)]
enum At {
    /// The file as a whole.
    Root,
    /// One of its lists: bytes of an element.
    List(usize),
    /// Anything else of glTF.
    Value,
    /// A value that the structures keep as it is, whatever its members are called.
    Loose,
    /// An object whose members are extensions.
    Extensions,
    /// Anything inside an extension, where only further extensions count.
    Extension,
    /// The list of a primitive's targets, and one of them.
    Targets,
    Target,
}

struct Walk<'f> {
    found: &'f mut Found,
    at: At,
    /// Whether it is in one of the lists that geometry and motion are made of.
    is_geometry: bool,
}

/// What a value is.
#[derive(Clone, Copy)]
enum Kind {
    /// A number, a list, or a word of the language.
    Plain,
    Text,
    Object,
}

impl Walk<'_> {
    /// Counts what a value takes.
    fn count(&mut self, kind: Kind) {
        let tree = match kind {
            Kind::Object => TREE_OBJECT + TREE_VALUE,
            Kind::Plain | Kind::Text => TREE_VALUE,
        };
        let structure = match (self.at, kind) {
            (At::Extensions | At::Extension | At::Loose, _) => tree,
            (At::List(element), Kind::Object) => element,
            (At::List(_), Kind::Text) => LISTED_NAME,
            (_, Kind::Object) => INNER_OBJECT,
            (_, Kind::Text) => TEXT,
            (_, Kind::Plain) => NUMBER,
        };
        self.found.bytes = self.found.bytes.saturating_add(structure);
        self.found.bytes_of_tree = self.found.bytes_of_tree.saturating_add(tree);
    }
}

impl<'de> DeserializeSeed<'de> for Walk<'_> {
    type Value = ();
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Walk<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_bool<E: Error>(mut self, _: bool) -> Result<(), E> {
        self.count(Kind::Plain);
        Ok(())
    }

    fn visit_i64<E: Error>(mut self, _: i64) -> Result<(), E> {
        self.count(Kind::Plain);
        Ok(())
    }

    fn visit_u64<E: Error>(mut self, _: u64) -> Result<(), E> {
        self.count(Kind::Plain);
        Ok(())
    }

    fn visit_f64<E: Error>(mut self, _: f64) -> Result<(), E> {
        self.count(Kind::Plain);
        Ok(())
    }

    fn visit_str<E: Error>(mut self, _: &str) -> Result<(), E> {
        self.count(Kind::Text);
        Ok(())
    }

    fn visit_unit<E: Error>(mut self) -> Result<(), E> {
        self.count(Kind::Plain);
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut list: A) -> Result<(), A::Error> {
        self.count(Kind::Plain);
        let at = if self.at == At::Targets { At::Target } else { self.at };
        let is_geometry = self.is_geometry;
        while list.next_element_seed(Walk { found: &mut *self.found, at, is_geometry })?.is_some() {}
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(mut self, mut object: A) -> Result<(), A::Error> {
        self.count(Kind::Object);
        while let Some(key) = object.next_key::<String>()? {
            let at = match (self.at, key.as_str()) {
                (At::Loose, _) => At::Loose,
                (At::Extensions, _) => At::Extension,
                (_, "extensions") => At::Extensions,
                (At::Root | At::List(_) | At::Value | At::Target, "extras") => At::Loose,
                (At::Root, list) => At::List(bytes_of_element(list)),
                (At::List(_) | At::Value, "targets") => At::Targets,
                (At::List(_) | At::Value, "min" | "max") => At::Loose,
                (At::List(_), _) => At::Value,
                (at, _) => at,
            };
            let is_geometry = self.is_geometry || (self.at == At::Root && GEOMETRY.contains(&key.as_str()));
            match self.at {
                At::Extensions => {
                    if is_geometry {
                        self.found.of_geometry.insert(key.clone());
                    }
                    self.found.extensions.insert(key);
                }
                At::Target if at != At::Loose && !MOVED.contains(&key.as_str()) => {
                    self.found.target_attributes.insert(key);
                }
                _ => {}
            }
            object.next_value_seed(Walk { found: &mut *self.found, at, is_geometry })?;
        }
        Ok(())
    }
}
