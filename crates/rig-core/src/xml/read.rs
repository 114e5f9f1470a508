use super::{MAX_DEPTH, MAX_NAME_BYTES, encoding};
use crate::{MatrixLayout, Place, RawJoint, RawRig, XmlError, XmlProblem};
use glam::Mat4;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{XmlVersion, escape};
use std::collections::HashMap;

/// An element that is open.
#[derive(Debug)]
enum Open {
    JointSet,
    Joint { index: usize, has_matrix: bool, has_children: bool },
    Matrix { joint: usize, at: usize, text: MatrixText },
    Children { joint: usize },
}

/// The text of a matrix, gathered around comments, with the offsets of its pieces in the file.
#[derive(Debug, Default)]
struct MatrixText {
    text: String,
    pieces: Vec<(usize, usize)>,
}

impl MatrixText {
    fn push(&mut self, text: &str, offset: usize) {
        self.pieces.push((self.text.len(), offset));
        self.text.push_str(text);
    }

    fn offset_of(&self, position: usize) -> usize {
        let piece = self.pieces.iter().rev().find(|(start, _)| *start <= position);
        piece.map_or(0, |(start, offset)| offset + position - start)
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<RawRig, XmlError> {
    let text = encoding::decode(bytes)?;
    let cursor = (0, Place { line: 1, column: 1 });
    Parser { text: &text, rig: RawRig::default(), open: Vec::new(), depth: 0, seen: HashMap::new(), cursor }
        .run()
}

struct Parser<'a> {
    text: &'a str,
    rig: RawRig,
    /// Explicit, so that no nesting can overflow the stack.
    open: Vec<Open>,
    depth: usize,
    /// Offsets of the joints by name.
    seen: HashMap<String, usize>,
    /// The joint before and its place: counting lines from the start for each would take quadratic time.
    cursor: (usize, Place),
}

impl Parser<'_> {
    fn run(mut self) -> Result<RawRig, XmlError> {
        let mut reader = Reader::from_str(self.text);
        reader.config_mut().expand_empty_elements = true;
        let mut finished = false;
        loop {
            let at = offset(reader.buffer_position());
            let event = match reader.read_event() {
                Ok(event) => event,
                Err(error) => {
                    let place = Place::of(self.text, offset(reader.error_position()));
                    return Err(self.malformed(place, &error));
                }
            };
            match event {
                Event::Start(element) => {
                    self.start(&element, at, finished)?;
                    finished = false;
                }
                Event::End(_) => finished = self.end()?,
                // Raw text, not `xml10_content()`: dropping the CR of each CRLF would move every place behind
                // it.
                Event::Text(piece) => self.piece(&piece, at, finished)?,
                Event::CData(piece) => self.piece(&piece, at + "<![CDATA[".len(), finished)?,
                Event::GeneralRef(name) => {
                    let reference = format!("&{};", &*name);
                    let piece = escape::unescape(&reference)
                        .map_err(|error| self.malformed(self.place(at), &error))?;
                    self.piece(&piece, at, finished)?;
                }
                Event::Eof => break,
                Event::Empty(_) | Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => {}
            }
        }
        let end = self.text.len();
        if let Some(open) = self.open.last() {
            let open = match open {
                Open::JointSet => "JointSet",
                Open::Joint { .. } => "Joint",
                Open::Matrix { .. } => "Matrix",
                Open::Children { .. } => "Children",
            };
            return Err(self.error(end, XmlProblem::Truncated { open: open.to_owned() }));
        }
        if self.rig.joints.is_empty() {
            return Err(self.error(end, XmlProblem::NoJoint));
        }
        Ok(self.rig)
    }

    fn place(&self, at: usize) -> Place {
        Place::of(self.text, at)
    }

    fn error(&self, at: usize, problem: XmlProblem) -> XmlError {
        XmlError { place: self.place(at), problem }
    }

    fn malformed(&self, place: Place, error: &dyn std::error::Error) -> XmlError {
        XmlError { place, problem: XmlProblem::Malformed(error.to_string()) }
    }

    fn joint_name(&self, index: usize) -> String {
        self.rig.joints[index].name.clone()
    }

    fn start(&mut self, element: &BytesStart<'_>, at: usize, finished: bool) -> Result<(), XmlError> {
        let name = element.name();
        let name: &str = name.as_ref();
        // All attributes, also unknown ones: XML allows no repeated or damaged attribute.
        for attribute in element.attributes() {
            attribute.map_err(|error| self.malformed(self.place(at), &error))?;
        }
        let unexpected = |parser: &Self, expected| {
            Err(parser.error(at, XmlProblem::UnexpectedElement { found: name.to_owned(), expected }))
        };
        match (self.open.last_mut(), name) {
            (None, "JointSet") if !finished && self.rig.joints.is_empty() => self.open.push(Open::JointSet),
            (None, _) if finished => return unexpected(self, "the end of the file"),
            (None, _) => return unexpected(self, "<JointSet>"),
            (Some(Open::JointSet), "Joint") => self.joint(element, None, at)?,
            (Some(Open::JointSet), _) => return unexpected(self, "<Joint>"),
            (Some(Open::Children { joint }), "Joint") => {
                let parent = *joint;
                self.joint(element, Some(parent), at)?;
            }
            (Some(Open::Children { .. }), _) => return unexpected(self, "<Joint>"),
            (Some(Open::Joint { index, has_matrix, .. }), "Matrix") => {
                let (joint, repeated) = (*index, std::mem::replace(has_matrix, true));
                self.once(joint, "Matrix", repeated, at)?;
                if self.flag(element, "transposed", at)? {
                    self.rig.joints[joint].layout = MatrixLayout::Transposed;
                }
                self.open.push(Open::Matrix { joint, at, text: MatrixText::default() });
            }
            (Some(Open::Joint { index, has_children, .. }), "Children") => {
                let (joint, repeated) = (*index, std::mem::replace(has_children, true));
                self.once(joint, "Children", repeated, at)?;
                self.open.push(Open::Children { joint });
            }
            (Some(Open::Joint { .. }), _) => return unexpected(self, "<Matrix> or <Children>"),
            (Some(Open::Matrix { .. }), _) => return unexpected(self, "16 numbers"),
        }
        Ok(())
    }

    fn once(&self, joint: usize, element: &'static str, repeated: bool, at: usize) -> Result<(), XmlError> {
        if repeated {
            return Err(self.error(at, XmlProblem::Repeated { joint: self.joint_name(joint), element }));
        }
        Ok(())
    }

    fn joint(&mut self, element: &BytesStart<'_>, parent: Option<usize>, at: usize) -> Result<(), XmlError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(self.error(at, XmlProblem::TooDeep { limit: MAX_DEPTH }));
        }
        let name = self.attribute(element, "name", at)?.filter(|name| !name.trim().is_empty());
        let name = name.ok_or_else(|| self.error(at, XmlProblem::MissingName))?;
        if name.len() > MAX_NAME_BYTES {
            return Err(self.error(at, XmlProblem::NameTooLong { limit: MAX_NAME_BYTES, found: name.len() }));
        }
        if let Some(first) = self.seen.insert(name.clone(), at) {
            let first = self.place(first);
            return Err(self.error(at, XmlProblem::DuplicateName { name, first }));
        }
        let omit = self.flag(element, "omit", at)?;
        let index = self.rig.joints.len();
        let (before, place) = self.cursor;
        let place = place.advanced(&self.text[before..at]);
        self.cursor = (at, place);
        self.rig.joints.push(RawJoint {
            name,
            parent: parent.map(|parent| self.joint_name(parent)),
            parent_from_joint: Mat4::IDENTITY,
            layout: MatrixLayout::RowByRow,
            omit,
            place: Some(place),
        });
        self.open.push(Open::Joint { index, has_matrix: false, has_children: false });
        Ok(())
    }

    fn attribute(&self, element: &BytesStart<'_>, name: &str, at: usize) -> Result<Option<String>, XmlError> {
        for attribute in element.attributes() {
            let attribute = attribute.map_err(|error| self.malformed(self.place(at), &error))?;
            let key: &str = attribute.key.as_ref();
            if key == name {
                let value = attribute.normalized_value(XmlVersion::Implicit1_0);
                let value = value.map_err(|error| self.malformed(self.place(at), &error))?;
                return Ok(Some(value.into_owned()));
            }
        }
        Ok(None)
    }

    fn flag(&self, element: &BytesStart<'_>, attribute: &'static str, at: usize) -> Result<bool, XmlError> {
        match self.attribute(element, attribute, at)? {
            None => Ok(false),
            Some(value) => match value.trim() {
                "true" | "1" => Ok(true),
                "false" | "0" => Ok(false),
                _ => Err(self.error(at, XmlProblem::NotABoolean { attribute, found: value })),
            },
        }
    }

    fn piece(&mut self, piece: &str, at: usize, finished: bool) -> Result<(), XmlError> {
        let expected = match self.open.last_mut() {
            Some(Open::Matrix { text, .. }) => {
                text.push(piece, at);
                return Ok(());
            }
            None if finished => "the end of the file",
            None => "<JointSet>",
            Some(Open::JointSet | Open::Children { .. }) => "<Joint>",
            Some(Open::Joint { .. }) => "<Matrix> or <Children>",
        };
        let Some(start) = piece.find(|c: char| !c.is_whitespace()) else { return Ok(()) };
        let found = piece[start..].split_whitespace().next().unwrap_or_default().chars().take(40).collect();
        Err(self.error(at + start, XmlProblem::UnexpectedText { found, expected }))
    }

    /// Whether the whole document has ended.
    fn end(&mut self) -> Result<bool, XmlError> {
        match self.open.pop() {
            Some(Open::Matrix { joint, at, text }) => self.matrix(joint, at, &text)?,
            Some(Open::Joint { index, has_matrix, .. }) => {
                self.depth -= 1;
                if !has_matrix {
                    let problem = XmlProblem::MissingMatrix { joint: self.joint_name(index) };
                    let place = self.rig.joints[index].place.unwrap_or(Place { line: 1, column: 1 });
                    return Err(XmlError { place, problem });
                }
            }
            Some(Open::Children { .. } | Open::JointSet) | None => {}
        }
        Ok(self.open.is_empty())
    }

    fn matrix(&mut self, joint: usize, at: usize, text: &MatrixText) -> Result<(), XmlError> {
        let mut numbers = [0.0f32; 16];
        let mut found = 0;
        for word in text.text.split_whitespace() {
            // Every word is a slice of the text, so this subtraction is its position.
            let position = word.as_ptr().addr() - text.text.as_ptr().addr();
            let number = word.parse::<f32>().ok().filter(|number| number.is_finite());
            let number = number.ok_or_else(|| {
                let found = word.chars().take(40).collect();
                let problem = XmlProblem::NotANumber { joint: self.joint_name(joint), found };
                self.error(text.offset_of(position), problem)
            })?;
            if let Some(slot) = numbers.get_mut(found) {
                *slot = number;
            }
            found += 1;
        }
        if found != numbers.len() {
            return Err(self.error(at, XmlProblem::NumberCount { joint: self.joint_name(joint), found }));
        }
        let in_order = Mat4::from_cols_array(&numbers);
        let joint = &mut self.rig.joints[joint];
        joint.parent_from_joint = match joint.layout {
            MatrixLayout::Transposed => in_order,
            MatrixLayout::RowByRow => in_order.transpose(),
        };
        Ok(())
    }
}

fn offset(position: u64) -> usize {
    usize::try_from(position).unwrap_or(usize::MAX)
}
