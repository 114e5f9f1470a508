//! Biovision hierarchies: a skeleton, and its motion as one clip.
//!
//! The format states neither axes nor units: they stay as they are. At rest a joint stands at its offset; in
//! a frame its position channels take the offset's place, as in Blender and in the files of programs that
//! write positions for every joint. Its rotation is the product of its rotation channels in their order, so
//! that the last one acts first.
//!
//! ```
//! let text = "HIERARCHY\nROOT hip\n{\nOFFSET 0 1 0\nCHANNELS 1 Zrotation\nEnd Site\n{\nOFFSET 0 2 0\n}\n}\n\
//!     MOTION\nFrames: 2\nFrame Time: 0.5\n0\n90\n";
//! let scene = avatar_exchange::bvh::read("turn.bvh", text.as_bytes())?;
//! let end = scene.worlds(&scene.at(0, 0.5)?)[1].translation;
//! assert!(end.abs_diff_eq(glam::DVec3::new(-2.0, 1.0, 0.0), 1e-6));
//! # Ok::<(), avatar_exchange::ImportError>(())
//! ```

use crate::build::text::{at_line, decode, float, number, shown, stem};
use crate::scene::{
    Channel, ChannelTarget, Clip, Finding, ImportError, Interpolation, Node, Note, RawScene, Scene,
    Transform, Trs, quoted,
};
use glam::{DQuat, DVec3, Quat, Vec3};

/// Reads a file as a scene of nodes and one clip, which has the file's name. End sites become nodes, too.
///
/// # Errors
/// The first line that is wrong.
pub fn read(file: &str, bytes: &[u8]) -> Result<Scene, ImportError> {
    let raw = read_raw(file, bytes)?;
    Scene::from_raw(raw).map_err(|error| error.in_file(file))
}

/// The same, unchecked.
///
/// # Errors
/// The first line that is wrong.
pub fn read_raw(file: &str, bytes: &[u8]) -> Result<RawScene, ImportError> {
    let text = decode(bytes);
    let mut lines = Lines { rows: text.lines().enumerate(), line: 0 };
    hierarchy(&mut lines)
        .and_then(|joints| motion(&mut lines, stem(file), joints))
        .map_err(|error| error.in_file(file))
}

/// Lines that are not empty, trimmed.
struct Lines<'a> {
    rows: std::iter::Enumerate<std::str::Lines<'a>>,
    /// The latest one, from 1 on.
    line: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<&'a str> {
        for (row, text) in self.rows.by_ref() {
            self.line = row + 1;
            if !text.trim().is_empty() {
                return Some(text.trim());
            }
        }
        None
    }

    fn expect(&mut self, what: &str) -> Result<&'a str, ImportError> {
        self.next().ok_or_else(|| at_line(self.line, what, "the end of the file"))
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Moves {
    Position(usize),
    Rotation(usize),
}

const CHANNELS: [(&str, Moves); 6] = [
    ("Xposition", Moves::Position(0)),
    ("Yposition", Moves::Position(1)),
    ("Zposition", Moves::Position(2)),
    ("Xrotation", Moves::Rotation(0)),
    ("Yrotation", Moves::Rotation(1)),
    ("Zrotation", Moves::Rotation(2)),
];

struct Joint {
    node: Node,
    offset: DVec3,
    channels: Vec<Moves>,
}

impl Joint {
    /// Whether a place differs from an offset that is not 0, by more than its file's digits: roots often have
    /// an offset of 0 and positions in the room, which is what everybody expects.
    fn is_moved_off(&self, translation: Vec3) -> bool {
        let distance = translation.as_dvec3().distance(self.offset);
        self.offset != DVec3::ZERO && distance > 1e-3 * self.offset.length()
    }
}

/// All joints, up to and including the line MOTION.
fn hierarchy(lines: &mut Lines<'_>) -> Result<Vec<Joint>, ImportError> {
    let first = lines.expect("HIERARCHY")?;
    if !first.eq_ignore_ascii_case("HIERARCHY") {
        return Err(at_line(lines.line, "HIERARCHY", shown(first)));
    }
    let mut joints: Vec<Joint> = Vec::new();
    // The joints whose braces are open. A file can nest them deeper than a call stack is.
    let mut open: Vec<usize> = Vec::new();
    loop {
        let text = lines.expect("a joint or MOTION")?;
        // Braces may stand on the line of what they belong to.
        let body = text.strip_suffix('{').unwrap_or(text).trim_end();
        let mut words = body.split_whitespace();
        let keyword = words.next().unwrap_or_default().to_ascii_uppercase();
        let parent = open.last().copied();
        let line = lines.line;
        match (keyword.as_str(), parent) {
            ("ROOT", None) | ("JOINT" | "END", Some(_)) => {
                let name = match (keyword.as_str(), parent) {
                    ("END", Some(parent)) => end_name(line, &joints[parent].node.name)?,
                    _ => body[keyword.len()..].trim().to_owned(),
                };
                if body.len() == text.len() {
                    let brace = lines.expect("{")?;
                    if brace != "{" {
                        return Err(at_line(lines.line, "{", shown(brace)));
                    }
                }
                open.push(joints.len());
                let node = Node { name, parent, ..Node::default() };
                joints.push(Joint { node, offset: DVec3::ZERO, channels: Vec::new() });
            }
            ("OFFSET", Some(joint)) => {
                let mut next = |what| number(line, what, words.next());
                joints[joint].offset =
                    DVec3::new(next("x of an offset")?, next("y of an offset")?, next("z of an offset")?);
            }
            ("CHANNELS", Some(joint)) => joints[joint].channels = channels(line, words)?,
            ("}", Some(_)) => {
                open.pop();
            }
            ("MOTION", None) if !joints.is_empty() => return Ok(joints),
            (_, None) => return Err(at_line(line, "ROOT or MOTION", shown(text))),
            (_, Some(_)) => return Err(at_line(line, "OFFSET, CHANNELS, JOINT, End Site or }", shown(text))),
        }
    }
}

/// The name of a node for an end site. Nothing hangs from one; and long names are not multiplied.
fn end_name(line: usize, parent: &str) -> Result<String, ImportError> {
    const END: &str = "End Site";
    match parent.len() {
        _ if parent.ends_with(END) => Err(at_line(line, "nothing below an End Site", END)),
        0..=64 => Ok(format!("{parent} {END}")),
        _ => Ok(END.to_owned()),
    }
}

fn channels<'a>(line: usize, mut words: impl Iterator<Item = &'a str>) -> Result<Vec<Moves>, ImportError> {
    let stated = words.next().unwrap_or_default();
    let mut channels = Vec::new();
    for word in words {
        let known = CHANNELS.iter().find(|(name, _)| name.eq_ignore_ascii_case(word));
        match known {
            Some((_, moves)) if !channels.contains(moves) => channels.push(*moves),
            _ => return Err(at_line(line, "Xposition to Zrotation, each once", shown(word))),
        }
    }
    match stated.parse() == Ok(channels.len()) {
        true => Ok(channels),
        false => Err(at_line(line, format!("{} channels", shown(stated)), channels.len().to_string())),
    }
}

fn motion(lines: &mut Lines<'_>, name: &str, joints: Vec<Joint>) -> Result<RawScene, ImportError> {
    let frames = stated(lines, "Frames:")?;
    let frames: usize =
        frames.parse().map_err(|_| at_line(lines.line, "a number of frames", shown(frames)))?;
    let time = stated(lines, "Frame Time:")?;
    let frame_secs = number(lines.line, "seconds of a frame", Some(time))?;
    if frame_secs < 0.0 {
        return Err(at_line(lines.line, "seconds of a frame, from 0 on", shown(time)));
    }
    let numbers: usize = joints.iter().map(|joint| joint.channels.len()).sum();
    let mut raw = RawScene::default();
    let mut clip = Clip { name: name.to_owned(), channels: Vec::new() };
    for (node, joint) in joints.iter().enumerate() {
        let mut channel = |target| {
            let interpolation = Interpolation::Linear;
            clip.channels.push(Channel {
                node,
                target,
                interpolation,
                times: Vec::new(),
                values: Vec::new(),
            });
        };
        if joint.channels.iter().any(|moves| matches!(moves, Moves::Position(_))) {
            channel(ChannelTarget::Translation);
        }
        if joint.channels.iter().any(|moves| matches!(moves, Moves::Rotation(_))) {
            channel(ChannelTarget::Rotation);
        }
    }
    // Where the first frame puts joints elsewhere than the rest pose does.
    let mut moved = Vec::new();
    // Without channels a frame is an empty line, and empty lines are skipped.
    for frame in 0..if numbers == 0 { 0 } else { frames } {
        let text = lines.expect(&format!("frame {frame} of {frames}"))?;
        let line = lines.line;
        let time = frame as f64 * frame_secs;
        let mut words = text.split_whitespace();
        let mut channels = clip.channels.iter_mut().peekable();
        for (node, joint) in joints.iter().enumerate() {
            let (translation, rotation) = local(line, joint, &mut words)?;
            if frame == 0 && joint.is_moved_off(translation) {
                moved.push(joint.node.name.as_str());
            }
            while let Some(channel) = channels.next_if(|channel| channel.node == node) {
                channel.times.push(time);
                match channel.target {
                    ChannelTarget::Rotation => channel.values.extend(rotation.to_array()),
                    _ => channel.values.extend(translation.to_array()),
                }
            }
        }
        if let Some(word) = words.next() {
            return Err(at_line(line, format!("{numbers} numbers"), format!("{} after them", shown(word))));
        }
    }
    if let [first, ..] = moved[..] {
        let text = format!(
            "positions take the place of offsets: the first frame has {} joints elsewhere than at rest, the first is {}",
            moved.len(),
            quoted(first)
        );
        raw.notes.push(Note::new("the frames", Finding::Converted(text)));
    }
    // Recorders are known to write a frame more than they tell.
    if lines.next().is_some() && numbers > 0 {
        let text = format!("what follows the {frames} frames is left out");
        raw.notes.push(Note::new(format!("line {}", lines.line), Finding::LeftOut(text)));
    }
    raw.nodes = joints
        .into_iter()
        .map(|joint| {
            let trs = Trs { translation: joint.offset.as_vec3(), ..Trs::default() };
            Node { local: Transform::Trs(trs), ..joint.node }
        })
        .collect();
    if frames > 0 && numbers > 0 {
        raw.clips.push(clip);
    }
    Ok(raw)
}

/// What follows a keyword on its line.
fn stated<'a>(lines: &mut Lines<'a>, keyword: &str) -> Result<&'a str, ImportError> {
    let text = lines.expect(keyword)?;
    let start = text.get(..keyword.len()).filter(|start| start.eq_ignore_ascii_case(keyword));
    match start {
        Some(start) => Ok(text[start.len()..].trim()),
        None => Err(at_line(lines.line, keyword, shown(text))),
    }
}

/// A joint's transform in a frame, from its numbers there.
fn local<'a>(
    line: usize,
    joint: &Joint,
    words: &mut impl Iterator<Item = &'a str>,
) -> Result<(Vec3, Quat), ImportError> {
    let mut translation = joint.offset;
    let mut rotation = DQuat::IDENTITY;
    for moves in &joint.channels {
        let value = f64::from(float(line, "a number for each channel", words.next())?);
        match *moves {
            Moves::Position(axis) => translation[axis] = value,
            Moves::Rotation(axis) => {
                rotation *= DQuat::from_axis_angle(DVec3::AXES[axis], value.to_radians())
            }
        }
    }
    Ok((translation.as_vec3(), rotation.as_quat()))
}
