//! `.md5anim`: motion of the joints of a mesh.

use super::mesh::{parent, version};
use super::words::{Words, rotation};
use crate::scene::{Channel, ChannelTarget, Clip, ImportError, Interpolation, Node};
use glam::{DQuat, DVec3};

/// Flags of the components that a joint takes from frames: x, y and z of its position, then of its rotation.
const COMPONENTS: u32 = 6;

struct Track {
    flags: u32,
    /// Where its components begin among those of a frame.
    start: usize,
    position: DVec3,
    rotation: DVec3,
}

/// Reads a clip for the joints of a mesh, which are the nodes after the first.
pub(super) fn read(words: &mut Words<'_>, name: &str, nodes: &[Node]) -> Result<Clip, ImportError> {
    let joints = nodes.len().saturating_sub(1);
    version(words)?;
    let (mut frames, mut rate, mut components) = (0, 24.0, 0);
    let mut tracks: Vec<Track> = Vec::new();
    let mut clip = Clip { name: name.to_owned(), channels: Vec::new() };
    let mut moving = Vec::new();
    let mut read_frames = 0;
    while let Some(word) = words.next() {
        match word {
            "commandline" => {
                words.word("a command line")?;
            }
            "numFrames" => frames = words.count("a number of frames")?,
            "numJoints" => {
                let found = words.count("a number of joints")?;
                if found != joints {
                    return Err(
                        words.error(format!("the {joints} joints of the mesh"), Some(&found.to_string()))
                    );
                }
            }
            "frameRate" => {
                rate = f64::from(words.float("a frame rate")?);
                if rate <= 0.0 {
                    return Err(words.error("a frame rate above 0", Some(&rate.to_string())));
                }
            }
            "numAnimatedComponents" => components = words.count("a number of components")?,
            "hierarchy" if tracks.is_empty() => tracks = hierarchy(words, nodes, components)?,
            "bounds" => bounds(words, frames)?,
            "baseframe" if !tracks.is_empty() && clip.channels.is_empty() => {
                base_frame(words, &mut tracks)?;
                clip.channels = channels(&tracks);
                // There may be many joints that no frame mentions.
                moving = (0..tracks.len()).filter(|joint| tracks[*joint].flags != 0).collect();
            }
            "frame" if !clip.channels.is_empty() => {
                let number = words.next();
                if number.and_then(|word| word.parse().ok()) != Some(read_frames) || read_frames >= frames {
                    return Err(words.error(format!("frame {read_frames} of {frames}"), number));
                }
                let time = read_frames as f64 / rate;
                frame(words, (&tracks, &moving), components, time, &mut clip)?;
                read_frames += 1;
            }
            _ => {
                return Err(words.error("hierarchy, bounds, baseframe and frames, in this order", Some(word)));
            }
        }
    }
    if clip.channels.is_empty() || read_frames != frames {
        return Err(words.error(format!("a base frame and {frames} frames, not {read_frames}"), None));
    }
    // What no frame moves stays as in the base frame, which need not be as in the mesh.
    for channel in clip.channels.iter_mut().filter(|channel| channel.times.is_empty()) {
        let track = &tracks[channel.node - 1];
        key(channel, 0.0, track.position, rotation(track.rotation));
    }
    Ok(clip)
}

fn hierarchy(words: &mut Words<'_>, nodes: &[Node], components: usize) -> Result<Vec<Track>, ImportError> {
    words.expect("{")?;
    let mut tracks = Vec::new();
    let mut taken = 0;
    for (index, node) in nodes.iter().skip(1).enumerate() {
        words.expect(&node.name)?;
        let parent = parent(words, index)?;
        if parent.map_or(0, |parent| parent + 1) != node.parent.unwrap_or(0) {
            let found = parent.map_or_else(|| "-1".to_owned(), |parent| parent.to_string());
            return Err(words.error("the parent that it has in the mesh", Some(&found)));
        }
        let flags = words.below("flags", 1 << COMPONENTS)? as u32;
        let start = words.count("the first component")?;
        let own = flags.count_ones() as usize;
        taken += own;
        // Shared components would let a short file stand for a long motion.
        if own > 0 && start.saturating_add(own) > components || taken > components {
            let found = format!("{own} from {start} on");
            return Err(words.error(format!("components of its own, below {components}"), Some(&found)));
        }
        tracks.push(Track { flags, start, position: DVec3::ZERO, rotation: DVec3::ZERO });
    }
    words.expect("}")?;
    Ok(tracks)
}

fn bounds(words: &mut Words<'_>, frames: usize) -> Result<(), ImportError> {
    words.expect("{")?;
    for _ in 0..frames {
        words.vector("the least corner")?;
        words.vector("the largest corner")?;
    }
    words.expect("}")
}

fn base_frame(words: &mut Words<'_>, tracks: &mut [Track]) -> Result<(), ImportError> {
    words.expect("{")?;
    for track in tracks {
        track.position = words.vector("a position")?;
        track.rotation = words.vector("a rotation")?;
    }
    words.expect("}")
}

/// Two for each joint, without keys yet.
fn channels(tracks: &[Track]) -> Vec<Channel> {
    let targets = [ChannelTarget::Translation, ChannelTarget::Rotation];
    let channel = |node, target| Channel {
        node,
        target,
        interpolation: Interpolation::Linear,
        times: Vec::new(),
        values: Vec::new(),
    };
    (1..=tracks.len()).flat_map(|node| targets.map(|target| channel(node, target))).collect()
}

fn key(channel: &mut Channel, time_secs: f64, position: DVec3, rotation: DQuat) {
    channel.times.push(time_secs);
    match channel.target {
        ChannelTarget::Rotation => channel.values.extend(rotation.as_quat().to_array()),
        _ => channel.values.extend(position.as_vec3().to_array()),
    }
}

fn frame(
    words: &mut Words<'_>,
    (tracks, moving): (&[Track], &[usize]),
    components: usize,
    time_secs: f64,
    clip: &mut Clip,
) -> Result<(), ImportError> {
    words.expect("{")?;
    let mut values = Vec::new();
    for _ in 0..components {
        values.push(f64::from(words.float("a component")?));
    }
    words.expect("}")?;
    for &joint in moving {
        let track = &tracks[joint];
        let channels = &mut clip.channels[2 * joint..2 * joint + 2];
        let (mut position, mut turn) = (track.position, track.rotation);
        let mut own = values.iter().skip(track.start);
        for component in (0..COMPONENTS as usize).filter(|component| track.flags & (1 << component) != 0) {
            let value = own.next().copied().unwrap_or_default();
            if component < 3 { position[component] = value } else { turn[component - 3] = value }
        }
        for (channel, flags) in channels.iter_mut().zip([0b111, 0b11_1000]) {
            if track.flags & flags != 0 {
                key(channel, time_secs, position, rotation(turn));
            }
        }
    }
    Ok(())
}
