//! The file as a tree, without namespaces.

use crate::build::text::{decode_as, without_end_mark};
use crate::scene::ImportError;
use encoding_rs::{Encoding, UTF_16BE, UTF_16LE};
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion, escape};
use std::borrow::Cow;
use std::collections::HashMap;

/// Nesting that real files stay far below.
const MAX_DEPTH: usize = 1024;

#[derive(Debug, Default)]
pub(super) struct Tree {
    elements: Vec<Element>,
    ids: HashMap<String, usize>,
}

#[derive(Debug, Default)]
struct Element {
    name: String,
    attributes: Vec<(String, String)>,
    text: String,
    children: Vec<usize>,
    parent: Option<usize>,
    line: usize,
}

/// An element in its tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct At<'a> {
    tree: &'a Tree,
    /// Its number.
    pub(super) number: usize,
}

impl Tree {
    pub(super) fn read(bytes: &[u8]) -> Result<Self, ImportError> {
        if bytes.starts_with(b"PK") {
            return Err(ImportError::new("byte 0", "COLLADA as text", "an archive; unpack it first"));
        }
        let text = decode(bytes)?;
        let mut tree = Self::default();
        let mut reader = Reader::from_str(&text);
        reader.config_mut().expand_empty_elements = true;
        let mut open: Vec<usize> = Vec::new();
        // Lines are counted as the reader goes, each byte once.
        let (mut counted, mut line) = (0, 1);
        loop {
            let at = usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX).min(text.len());
            line +=
                text.as_bytes().get(counted..at).unwrap_or(&[]).iter().filter(|byte| **byte == b'\n').count();
            counted = counted.max(at);
            let wrong = |found: String| ImportError::new(format!("line {line}"), "well-formed XML", found);
            let event = reader.read_event().map_err(|error| wrong(error.to_string()))?;
            let piece: Cow<'_, str> = match event {
                Event::Start(start) => {
                    let number = tree.elements.len();
                    let parent = open.last().copied();
                    if parent.is_none() && number > 0 {
                        return Err(wrong("a second root".to_owned()));
                    }
                    if open.len() >= MAX_DEPTH {
                        return Err(wrong(format!("elements nested more than {MAX_DEPTH} deep")));
                    }
                    tree.start(&start, parent, line).map_err(wrong)?;
                    open.push(number);
                    continue;
                }
                Event::End(_) => {
                    open.pop();
                    continue;
                }
                Event::Eof => break,
                Event::Text(piece) => piece.to_string().into(),
                Event::CData(piece) => piece.to_string().into(),
                Event::GeneralRef(name) => {
                    let reference = format!("&{};", &*name);
                    escape::unescape(&reference)
                        .map_err(|error| wrong(error.to_string()))?
                        .into_owned()
                        .into()
                }
                _ => continue,
            };
            if let Some(&number) = open.last() {
                tree.elements[number].text.push_str(&piece);
            }
        }
        match open.last() {
            Some(&number) => {
                let name = &tree.elements[number].name;
                Err(ImportError::new(format!("line {line}"), format!("</{name}>"), "the end of the file"))
            }
            None if tree.elements.is_empty() => Err(ImportError::new("line 1", "<COLLADA>", "no element")),
            None => Ok(tree),
        }
    }

    fn start(&mut self, start: &BytesStart<'_>, parent: Option<usize>, line: usize) -> Result<(), String> {
        let name = start.name();
        let name: &str = name.as_ref();
        let number = self.elements.len();
        let mut element = Element { name: local(name).to_owned(), parent, line, ..Element::default() };
        for attribute in start.attributes() {
            let attribute = attribute.map_err(|error| error.to_string())?;
            let value =
                attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|error| error.to_string())?;
            let key: &str = attribute.key.as_ref();
            if key == "id" {
                // Of two elements with one id, which is an error that exporters make, the first counts.
                self.ids.entry(value.clone().into_owned()).or_insert(number);
            }
            element.attributes.push((key.to_owned(), value.into_owned()));
        }
        if let Some(parent) = parent.and_then(|parent| self.elements.get_mut(parent)) {
            parent.children.push(number);
        }
        self.elements.push(element);
        Ok(())
    }

    pub(super) fn root(&self) -> At<'_> {
        At { tree: self, number: 0 }
    }

    pub(super) fn at(&self, number: usize) -> At<'_> {
        At { tree: self, number }
    }

    /// The element with an id.
    pub(super) fn by_id(&self, id: &str) -> Option<At<'_>> {
        Some(At { tree: self, number: *self.ids.get(id)? })
    }
}

fn local(name: &str) -> &str {
    name.rsplit_once(':').map_or(name, |(_, local)| local)
}

impl<'a> At<'a> {
    fn element(self) -> &'a Element {
        &self.tree.elements[self.number]
    }

    pub(super) fn name(self) -> &'a str {
        &self.element().name
    }

    pub(super) fn attribute(self, key: &str) -> Option<&'a str> {
        self.element().attributes.iter().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }

    pub(super) fn text(self) -> &'a str {
        self.element().text.trim()
    }

    pub(super) fn parent(self) -> Option<At<'a>> {
        Some(self.tree.at(self.element().parent?))
    }

    pub(super) fn children(self) -> impl Iterator<Item = At<'a>> {
        self.element().children.iter().map(move |number| self.tree.at(*number))
    }

    /// Another element of the same tree.
    pub(super) fn tree_by_id(self, id: &str) -> Option<At<'a>> {
        self.tree.by_id(id)
    }

    /// All children of a name.
    pub(super) fn all(self, name: &str) -> impl Iterator<Item = At<'a>> {
        self.children().filter(move |child| child.name() == name)
    }

    /// The first child of a name.
    pub(super) fn child(self, name: &str) -> Option<At<'a>> {
        self.children().find(|child| child.name() == name)
    }

    /// What a path of names leads to.
    pub(super) fn path(self, names: &[&str]) -> Option<At<'a>> {
        names.iter().try_fold(self, |at, name| at.child(name))
    }

    /// Name for people: `name`, else `id`, else nothing.
    pub(super) fn label(self) -> &'a str {
        self.attribute("name").or(self.attribute("id")).unwrap_or("")
    }

    /// For messages.
    pub(super) fn place(self) -> String {
        let label: String =
            self.attribute("id").or(self.attribute("name")).unwrap_or("").chars().take(60).collect();
        match label.is_empty() {
            true => format!("line {}, <{}>", self.element().line, self.name()),
            false => format!("line {}, <{}> '{label}'", self.element().line, self.name()),
        }
    }

    pub(super) fn error(self, expected: impl Into<String>, found: impl Into<String>) -> ImportError {
        ImportError::new(self.place(), expected, found)
    }

    /// The element that an attribute refers to with `#id`.
    pub(super) fn target(self, key: &str) -> Result<At<'a>, ImportError> {
        let Some(url) = self.attribute(key) else {
            return Err(self.error(format!("an attribute '{key}'"), "none"));
        };
        let found = url.strip_prefix('#').and_then(|id| self.tree.by_id(id));
        found.ok_or_else(|| self.error(format!("the '#id' of an element in '{key}'"), format!("'{url}'")))
    }

    /// Numbers between blanks, with a point or, as exporters on systems with decimal commas write them, a
    /// comma.
    pub(super) fn numbers<T: std::str::FromStr>(self) -> Result<Vec<T>, ImportError> {
        let parse = |word: &str| {
            word.parse().or_else(|_| word.replacen(',', ".", 1).parse()).map_err(|_| {
                self.error("numbers", format!("'{}'", word.chars().take(30).collect::<String>()))
            })
        };
        self.text().split_ascii_whitespace().map(parse).collect()
    }

    /// So many numbers.
    pub(super) fn exactly<const N: usize>(self) -> Result<[f64; N], ImportError> {
        let numbers: Vec<f64> = self.numbers()?;
        let found = numbers.len();
        numbers.try_into().map_err(|_| self.error(format!("{N} numbers"), found.to_string()))
    }
}

/// Bytes to text: as the mark at their beginning or the XML declaration says, UTF-16 without a mark, too.
fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, ImportError> {
    let stated = match bytes {
        [] => return Err(ImportError::new("byte 0", "COLLADA as text", "no bytes")),
        [b'<', 0, ..] => return Ok(without_end_mark(UTF_16LE.decode_without_bom_handling(bytes).0)),
        [0, b'<', ..] => return Ok(without_end_mark(UTF_16BE.decode_without_bom_handling(bytes).0)),
        _ => stated_encoding(bytes),
    };
    Ok(decode_as(bytes, stated))
}

/// The encoding that `<?xml ... encoding="..."?>` names.
fn stated_encoding(bytes: &[u8]) -> Option<&'static Encoding> {
    let declaration = bytes.strip_prefix(b"<?xml")?.split(|byte| *byte == b'>').next()?;
    let name = b"encoding";
    let at = declaration.windows(name.len()).position(|window| window == name)?;
    let mut quoted = declaration[at + name.len()..].split(|byte| matches!(byte, b'"' | b'\''));
    Encoding::for_label(quoted.nth(1)?)
}
