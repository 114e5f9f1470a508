use super::buffer::Buffer;
use super::plan::Plan;
use crate::scene::{Channel, ChannelTarget, Interpolation, Scene};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// How far a length may be from 1 to be taken as it is; glTF's validator grants five times as much.
const UNIT_TOLERANCE: f64 = 1e-4;

fn length(values: &[f32]) -> f64 {
    values.iter().map(|x| f64::from(*x) * f64::from(*x)).sum::<f64>().sqrt()
}

/// Whether a vector has unit length, but for rounding.
pub(super) fn is_unit(values: &[f32]) -> bool {
    (length(values) - 1.0).abs() <= UNIT_TOLERANCE
}

/// A rotation of unit length; one of length 0 becomes the identity.
pub(super) fn unit(rotation: [f32; 4]) -> [f32; 4] {
    let length = length(&rotation);
    if is_unit(&rotation) {
        rotation
    } else if length > 0.0 {
        rotation.map(|x| (f64::from(x) / length) as f32)
    } else {
        [0.0, 0.0, 0.0, 1.0]
    }
}

pub(super) fn animations(scene: &Scene, plan: &Plan, buffer: &mut Buffer) -> Vec<Value> {
    let mut animations = Vec::new();
    let mut groups_at: Vec<Vec<usize>> = vec![Vec::new(); scene.nodes.len()];
    plan.groups.iter().for_each(|group| groups_at[group.node].push(group.at));
    for clip in &scene.clips {
        let start = clip.channels.iter().filter_map(|channel| channel.times.first().copied());
        let start = start.fold(0.0, f64::min);
        // Of several channels for one property, the last counts.
        let mut of_property: BTreeMap<(usize, ChannelTarget), usize> = BTreeMap::new();
        for (number, channel) in clip.channels.iter().enumerate() {
            of_property.insert((channel.node, channel.target), number);
        }
        let counting = clip
            .channels
            .iter()
            .enumerate()
            .filter(|(number, channel)| of_property.get(&(channel.node, channel.target)) == Some(number));
        let (mut channels, mut samplers) = (Vec::new(), Vec::new());
        for (_, channel) in counting {
            let nodes: Vec<usize> = match channel.target {
                ChannelTarget::Weights if scene.nodes[channel.node].weights.is_empty() => Vec::new(),
                ChannelTarget::Weights => groups_at[channel.node].clone(),
                _ => vec![channel.node],
            };
            if nodes.is_empty() {
                continue;
            }
            let sampler = samplers.len();
            samplers.push(sampler_of(scene, channel, start, buffer));
            let target = |node: usize| json!({ "node": node, "path": path(channel.target) });
            channels
                .extend(nodes.into_iter().map(|node| json!({ "sampler": sampler, "target": target(node) })));
        }
        if channels.is_empty() {
            continue;
        }
        let mut json = super::named(&clip.name);
        json.insert("channels".to_owned(), channels.into());
        json.insert("samplers".to_owned(), samplers.into());
        animations.push(Value::Object(json));
    }
    animations
}

fn path(target: ChannelTarget) -> &'static str {
    match target {
        ChannelTarget::Translation => "translation",
        ChannelTarget::Rotation => "rotation",
        ChannelTarget::Scale => "scale",
        ChannelTarget::Weights => "weights",
    }
}

fn sampler_of(scene: &Scene, channel: &Channel, start: f64, buffer: &mut Buffer) -> Value {
    let width = channel.target.width(scene.nodes[channel.node].weights.len());
    let keys = Keys::of(channel, start, width);
    let input = buffer.times(&keys.times);
    let output = match channel.target {
        ChannelTarget::Weights => buffer.vectors(keys.values.iter().map(|value| [*value]), None, false),
        ChannelTarget::Rotation => {
            buffer.vectors(keys.values.as_chunks::<4>().0.iter().copied(), None, false)
        }
        _ => buffer.vectors(keys.values.as_chunks::<3>().0.iter().copied(), None, false),
    };
    let interpolation = match keys.interpolation {
        Interpolation::Step => "STEP",
        Interpolation::Linear => "LINEAR",
        Interpolation::CubicSpline => "CUBICSPLINE",
    };
    json!({ "input": input, "interpolation": interpolation, "output": output })
}

/// Keys as glTF wants them: times from 0 that grow, rotations of unit length, splines of two keys at least.
struct Keys {
    times: Vec<f32>,
    values: Vec<f32>,
    interpolation: Interpolation,
}

impl Keys {
    fn of(channel: &Channel, start: f64, width: usize) -> Self {
        let is_spline = channel.interpolation == Interpolation::CubicSpline;
        let per_key = if is_spline { 3 * width } else { width };
        let mut times: Vec<f32> = Vec::with_capacity(channel.times.len());
        let mut values: Vec<f32> = Vec::with_capacity(channel.values.len());
        for (key, of_key) in channel.times.iter().zip(channel.values.chunks_exact(per_key.max(1))) {
            let time = (key - start) as f32;
            // Where the value jumps, the key before the jump moves to just before it; those between do not
            // count.
            if times.last() == Some(&time) {
                let earlier = time.next_down();
                let before = times.len().checked_sub(2).map(|before| times[before]);
                if earlier >= 0.0 && before.is_none_or(|before| before < earlier) {
                    let last = times.len() - 1;
                    times[last] = earlier;
                } else {
                    times.pop();
                    values.truncate(values.len() - per_key);
                }
            }
            times.push(time);
            values.extend_from_slice(of_key);
        }
        let mut keys = Self { times, values, interpolation: channel.interpolation };
        if is_spline && keys.times.len() < 2 {
            keys.values = keys.values.get(width..2 * width).unwrap_or(&[]).to_vec();
            keys.interpolation = Interpolation::Step;
        }
        if channel.target == ChannelTarget::Rotation {
            keys.normalise();
        }
        keys
    }

    fn normalise(&mut self) {
        if self.interpolation != Interpolation::CubicSpline {
            self.values.as_chunks_mut::<4>().0.iter_mut().for_each(|rotation| *rotation = unit(*rotation));
            return;
        }
        for key in self.values.as_chunks_mut::<12>().0 {
            let length = length(&key[4..8]);
            if length > 0.0 && !is_unit(&key[4..8]) {
                // The tangents are speeds of the same numbers, as far as 32 bits can hold them.
                let most = f64::from(f32::MAX);
                *key = key.map(|x| (f64::from(x) / length).clamp(-most, most) as f32);
            } else if length == 0.0 {
                key[4..8].copy_from_slice(&[0.0, 0.0, 0.0, 1.0]);
            }
        }
    }
}
