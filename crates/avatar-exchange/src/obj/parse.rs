//! Lines of an OBJ file, one after the other.

use crate::build::srgb::linear;
use crate::build::text::{at_line, float, number, shown};
use crate::scene::ImportError;
use glam::{Vec2, Vec3};
use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};

/// More parts than this are taken for a damaged file.
const MAX_PARTS: usize = 65_536;
/// Longer names are not repeated in every part.
const MAX_NAME: usize = 1024;
/// As many keywords without meaning get a note each.
const MAX_UNKNOWN: usize = 16;

/// A file as its lines tell it; indices count from 0 and may still be out of range.
#[derive(Debug, Default)]
pub(super) struct Lines {
    pub(super) positions: Vec<Vec3>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    pub(super) corners: Vec<Corner>,
    pub(super) faces: Vec<Face>,
    pub(super) parts: Vec<PartKey>,
    pub(super) materials: Vec<String>,
    pub(super) libraries: Vec<String>,
    /// How many lines of each keyword were passed over, and the first of them.
    pub(super) unknown: BTreeMap<String, (usize, usize)>,
    /// Linear colours of the first positions; none where no line has one. Those behind the last are white.
    pub(super) colors: Vec<Vec3>,
    /// The first line whose colour has a number outside of 0 to 1.
    pub(super) odd_color: Option<usize>,
    /// The first line with a weight of a vertex other than 1.
    pub(super) rational: Option<usize>,
    pub(super) last_line: usize,
}

/// Positions in the lists of the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) position: u32,
    pub(super) uv: Option<u32>,
    pub(super) normal: Option<u32>,
}

/// A polygon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Where its corners begin; they end where those of the next face begin.
    pub(super) first_corner: usize,
    pub(super) line: usize,
    pub(super) part: usize,
    pub(super) smoothing: Smoothing,
}

/// Which faces share normals that the file does not give.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Smoothing {
    /// All of those that have no statement `s` before them.
    #[default]
    All,
    /// `s off`: none.
    Flat,
    /// `s n`.
    Group(u32),
}

/// What makes a part: object, group and material.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct PartKey {
    /// Every `o` begins a new object, even under a name that was there before.
    pub(super) object: usize,
    /// Its group, or else its object; may be empty.
    pub(super) name: String,
    /// Among the names after `usemtl`.
    pub(super) material: Option<usize>,
}

/// What the statements so far say about the next face.
#[derive(Default)]
struct State {
    object_name: String,
    key: PartKey,
    part: Option<usize>,
    parts: HashMap<PartKey, usize>,
    materials: HashMap<String, usize>,
    smoothing: Smoothing,
}

/// Reads all lines.
pub(super) fn parse(text: &str) -> Result<Lines, ImportError> {
    let mut lines = Lines::default();
    let mut state = State::default();
    let mut rows = text.lines().enumerate();
    while let Some((row, line)) = rows.next() {
        let first = row + 1;
        lines.last_line = first;
        let line = match line.strip_suffix('\\') {
            None => Cow::Borrowed(line),
            Some(start) => {
                let mut joined = start.to_owned();
                for (row, next) in rows.by_ref() {
                    lines.last_line = row + 1;
                    let more = next.strip_suffix('\\');
                    joined.push(' ');
                    joined.push_str(more.unwrap_or(next));
                    if more.is_none() {
                        break;
                    }
                }
                Cow::Owned(joined)
            }
        };
        statement(&mut lines, &mut state, first, line.trim())?;
    }
    Ok(lines)
}

fn statement(lines: &mut Lines, state: &mut State, line: usize, text: &str) -> Result<(), ImportError> {
    let (keyword, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    let rest = rest.trim();
    // Names may contain a number sign, numbers not.
    let mut words = rest.split_whitespace().take_while(|word| !word.starts_with('#'));
    match keyword {
        "" => {}
        _ if keyword.starts_with('#') => {}
        "v" => vertex(lines, line, words)?,
        "vt" => {
            let u = float(line, "u of a texture coordinate", words.next())?;
            // In 64 bits, so that turning around twice gives the same number.
            let v = words.next().map_or(Ok(0.0), |v| number(line, "v of a texture coordinate", Some(v)))?;
            let flipped = (1.0 - v) as f32;
            if !flipped.is_finite() {
                return Err(at_line(line, "v of a texture coordinate, a number of 32 bits", v.to_string()));
            }
            lines.uvs.push(Vec2::new(u, flipped));
        }
        "vn" => {
            let mut next = |what| float(line, what, words.next());
            lines.normals.push(Vec3::new(
                next("x of a normal")?,
                next("y of a normal")?,
                next("z of a normal")?,
            ));
        }
        "f" | "fo" => face(lines, state, line, words)?,
        "o" => {
            state.key.object += 1;
            state.object_name = rest.to_owned();
            rename(state, line, rest)?;
        }
        "g" => match rest {
            "" => rename(state, line, &state.object_name.clone())?,
            name => rename(state, line, name)?,
        },
        "usemtl" => {
            let material = *state.materials.entry(rest.to_owned()).or_insert_with(|| {
                lines.materials.push(rest.to_owned());
                lines.materials.len() - 1
            });
            state.key.material = Some(material);
            state.part = None;
        }
        "mtllib" => lines.libraries.push(rest.to_owned()),
        "s" => {
            state.smoothing = match words.next() {
                None | Some("off" | "0") => Smoothing::Flat,
                // Exporters that know one kind of smoothness write "on".
                Some("on") => Smoothing::Group(1),
                Some(word) => Smoothing::Group(
                    word.parse()
                        .map_err(|_| at_line(line, "the number of a smoothing group, or off", shown(word)))?,
                ),
            };
        }
        _ => {
            if lines.unknown.len() < MAX_UNKNOWN || lines.unknown.contains_key(keyword) {
                lines.unknown.entry(keyword.to_owned()).or_insert((0, line)).0 += 1;
            }
        }
    }
    Ok(())
}

fn rename(state: &mut State, line: usize, name: &str) -> Result<(), ImportError> {
    if name.len() > MAX_NAME {
        return Err(at_line(line, format!("a name of at most {MAX_NAME} bytes"), name.len().to_string()));
    }
    name.clone_into(&mut state.key.name);
    state.part = None;
    Ok(())
}

fn vertex<'a>(
    lines: &mut Lines,
    line: usize,
    mut words: impl Iterator<Item = &'a str>,
) -> Result<(), ImportError> {
    let mut next = |what| float(line, what, words.next());
    let position = Vec3::new(next("x of a vertex")?, next("y of a vertex")?, next("z of a vertex")?);
    // After them: nothing, a weight, a colour, or a weight and a colour.
    let (mut more, mut count) = ([1.0; 4], 0);
    for (value, word) in more.iter_mut().zip(words) {
        *value = float(line, "a weight or colour of a vertex", Some(word))?;
        count += 1;
    }
    let (weight, color) = match (count, more) {
        (3, [r, g, b, _]) => (1.0, Some([r, g, b])),
        (4, [weight, r, g, b]) => (weight, Some([r, g, b])),
        (_, [weight, ..]) => (weight, None),
    };
    if weight != 1.0 {
        lines.rational.get_or_insert(line);
    }
    if let Some(color) = color {
        if color.iter().any(|x| !(0.0..=1.0).contains(x)) {
            lines.odd_color.get_or_insert(line);
        }
        lines.colors.resize(lines.positions.len(), Vec3::ONE);
        // Programs that write colours of vertices write those that the screen shows: sRGB, as Blender and
        // three.js have it. The format itself has none.
        lines.colors.push(linear(color).into());
    }
    lines.positions.push(position);
    Ok(())
}

fn face<'a>(
    lines: &mut Lines,
    state: &mut State,
    line: usize,
    words: impl Iterator<Item = &'a str>,
) -> Result<(), ImportError> {
    let first_corner = lines.corners.len();
    for word in words {
        let mut indices = word.split('/');
        let position = index(line, "a vertex", indices.next().unwrap_or_default(), lines.positions.len())?;
        let mut optional = |what, length| match indices.next() {
            None | Some("") => Ok(None),
            Some(word) => index(line, what, word, length).map(Some),
        };
        let uv = optional("a texture coordinate", lines.uvs.len())?;
        let normal = optional("a normal", lines.normals.len())?;
        if indices.next().is_some() {
            return Err(at_line(line, "corners of up to three indices", shown(word)));
        }
        lines.corners.push(Corner { position, uv, normal });
    }
    let corners = lines.corners.len() - first_corner;
    if corners < 3 {
        return Err(at_line(line, "a face of at least 3 corners", corners.to_string()));
    }
    let part = match state.part {
        Some(part) => part,
        None => {
            let fresh = lines.parts.len();
            let part = *state.parts.entry(state.key.clone()).or_insert(fresh);
            if part == fresh {
                if fresh == MAX_PARTS {
                    return Err(at_line(line, format!("at most {MAX_PARTS} parts"), "one more"));
                }
                lines.parts.push(state.key.clone());
            }
            *state.part.insert(part)
        }
    };
    lines.faces.push(Face { first_corner, line, part, smoothing: state.smoothing });
    Ok(())
}

/// A position in a list: from 1 on, or back from its present end. It may lie beyond that, since some files
/// list faces first.
fn index(line: usize, what: &str, word: &str, length: usize) -> Result<u32, ImportError> {
    let expected = || format!("the number of {what}, from 1 on, or from -1 back to -{length}");
    let number: i64 = word.parse().map_err(|_| at_line(line, expected(), shown(word)))?;
    let index = if number < 0 { (length as i64).checked_add(number) } else { number.checked_sub(1) };
    let index = index.and_then(|index| u32::try_from(index).ok());
    index.ok_or_else(|| at_line(line, expected(), shown(word)))
}
