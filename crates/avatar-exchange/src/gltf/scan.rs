//! What the structures of the JSON drop without a word, and what memory they will take, found in a pass of
//! its own before they are made.

use std::borrow::Cow;
use std::collections::BTreeSet;

/// What one pass over a JSON text found.
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
/// Bytes of the name of a member beside its letters; its place is in the object's node.
const KEY: usize = 16;
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

/// Deeper values than this are counted, but what they are called means nothing: the structures read none of
/// them.
const MOST_DEPTH: usize = 256;

/// Goes through the whole text, whatever is wrong in it: readers pass over much that is no valid JSON where
/// they keep nothing of it, and read on behind it.
pub(super) fn scan(text: &[u8]) -> Found {
    let mut scan = Scan { text, at: 0, found: Found::default(), open: Vec::new(), deeper: 0 };
    while let Some(&byte) = text.get(scan.at) {
        match byte {
            b'{' | b'[' => scan.begin(byte == b'{'),
            b'}' | b']' => scan.end(),
            b'"' => scan.string(),
            b',' => scan.comma(),
            b':' | b' ' | b'\t' | b'\n' | b'\r' => scan.at += 1,
            _ => scan.word(),
        }
    }
    scan.found
}

/// What a value is.
#[derive(Clone, Copy)]
enum Kind {
    /// A number, a list, or a word of the language.
    Plain,
    Text,
    Object,
}

/// Where a value stands.
#[derive(Clone, Copy)]
struct Place {
    at: At,
    /// Whether it is in one of the lists that geometry and motion are made of.
    is_geometry: bool,
}

/// An object or a list that has begun.
struct Open {
    place: Place,
    /// Where its next value stands.
    next: Place,
    /// Whether the next string is the name of a member.
    wants_key: bool,
    is_object: bool,
}

struct Scan<'t> {
    text: &'t [u8],
    at: usize,
    found: Found,
    open: Vec<Open>,
    /// How many have begun within the deepest of `open`.
    deeper: usize,
}

impl Scan<'_> {
    fn place(&self) -> Place {
        let root = Place { at: At::Root, is_geometry: false };
        self.open.last().map_or(root, |open| open.next)
    }

    fn begin(&mut self, is_object: bool) {
        let place = self.place();
        self.count(place.at, if is_object { Kind::Object } else { Kind::Plain });
        self.at += 1;
        if self.open.len() == MOST_DEPTH || self.deeper > 0 {
            self.deeper += 1;
            return;
        }
        let at = if place.at == At::Targets { At::Target } else { place.at };
        let next = if is_object { place } else { Place { at, ..place } };
        self.open.push(Open { place, next, wants_key: is_object, is_object });
    }

    fn end(&mut self) {
        self.at += 1;
        match self.deeper.checked_sub(1) {
            Some(deeper) => self.deeper = deeper,
            None => _ = self.open.pop(),
        }
    }

    fn comma(&mut self) {
        self.at += 1;
        if let Some(open) = self.open.last_mut().filter(|_| self.deeper == 0) {
            open.wants_key = open.is_object;
        }
    }

    /// A number or a word, up to what can follow one.
    fn word(&mut self) {
        self.count(self.place().at, Kind::Plain);
        let rest = &self.text[self.at..];
        let ends = |byte: &u8| b",:{}[]\" \t\n\r".contains(byte);
        self.at += rest.iter().position(ends).unwrap_or(rest.len());
    }

    fn string(&mut self) {
        let first = self.at + 1;
        let mut end = first;
        while let Some(byte) = self.text.get(end).filter(|byte| **byte != b'"') {
            end += if *byte == b'\\' { 2 } else { 1 };
        }
        let end = end.min(self.text.len());
        self.at = end + 1;
        let is_key = self.deeper == 0 && self.open.last().is_some_and(|open| open.wants_key);
        if is_key {
            let name = unescaped(&self.text[first..end]);
            self.member(&name);
        } else {
            self.count(self.place().at, Kind::Text);
        }
    }

    /// The name of a member of the innermost object.
    fn member(&mut self, name: &str) {
        let Some(open) = self.open.last_mut() else { return };
        open.wants_key = false;
        let Place { at: own, is_geometry } = open.place;
        let at = match (own, name) {
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
        let is_geometry = is_geometry || (own == At::Root && GEOMETRY.contains(&name));
        open.next = Place { at, is_geometry };
        let found = &mut self.found;
        let mut is_new = false;
        match own {
            At::Extensions => {
                if is_geometry {
                    found.of_geometry.insert(name.to_owned());
                }
                is_new = found.extensions.insert(name.to_owned());
            }
            At::Target if at != At::Loose && !MOVED.contains(&name) => {
                is_new = found.target_attributes.insert(name.to_owned());
            }
            _ => {}
        }
        // In both sets and in a note.
        let listed = if is_new { LISTED_NAME + 3 * name.len() } else { 0 };
        let is_kept = matches!(own, At::Extensions | At::Extension | At::Loose);
        let kept = if is_kept { KEY + name.len() } else { 0 };
        found.bytes = found.bytes.saturating_add(listed + kept);
        found.bytes_of_tree = found.bytes_of_tree.saturating_add(KEY + name.len());
    }

    /// Counts what a value takes.
    fn count(&mut self, at: At, kind: Kind) {
        let tree = match kind {
            Kind::Object => TREE_OBJECT + TREE_VALUE,
            Kind::Plain | Kind::Text => TREE_VALUE,
        };
        let structure = match (at, kind) {
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

/// The text of a string; one that means nothing stays as it is.
fn unescaped(raw: &[u8]) -> Cow<'_, str> {
    let plain = String::from_utf8_lossy(raw);
    if !raw.contains(&b'\\') {
        return plain;
    }
    serde_json::from_str(&format!("\"{plain}\"")).map_or(plain, Cow::Owned)
}

#[cfg(test)]
mod tests {
    use super::scan;

    /// What the structures pass over, and read on behind it.
    #[test]
    fn nothing_ends_the_pass_early() {
        let rest = r#""materials":[{},{}],"nodes":[{"extensions":{"ACME_anvil":{}}}]"#;
        let plain = scan(format!("{{{rest}}}").as_bytes());
        assert!(plain.of_geometry.contains("ACME_anvil"));
        let deep = format!("{}{}", "[".repeat(1000), "]".repeat(1000));
        for odd in ["1e999", r#""\ud800""#, r#"{"a":-1e-999,"b":"\u0022}"}"#, deep.as_str(), r#"{"":"\\"}"#] {
            for member in ["foo", "extras"] {
                let text = format!(r#"{{"{member}":{odd},{rest}}}"#);
                let found = scan(text.as_bytes());
                assert!(found.bytes >= plain.bytes, "{member} {}", &odd[..odd.len().min(20)]);
                assert_eq!(found.of_geometry, plain.of_geometry, "{member} {}", &odd[..odd.len().min(20)]);
            }
        }
        let escaped = scan(br#"{"n\u006fdes":[{"extens\u0069ons":{"ACME_\u0061nvil":1}}]}"#);
        assert_eq!(escaped.of_geometry, plain.of_geometry);
        for broken in ["", "{", "]", "\"", "{\"a\\", "[[[", "}}}", "{\"a\":", ",,,::"] {
            scan(broken.as_bytes());
        }
    }
}
