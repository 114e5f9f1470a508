//! Animations move numbers in the steps of a node's transform; clips move nodes. So transforms are computed
//! wherever something has a key, and 30 times a second where straight lines between these would not do.

use super::Reader;
use super::node::Nodes;
use super::part::WeightNodes;
use super::sampler::Sampler;
use super::transform::{Kind, Step, product};
use super::xml::At;
use crate::scene::{
    Channel, ChannelTarget, Clip, Finding, ImportError, Interpolation, Transform, Trs, widen,
};
use glam::{DAffine3, DMat4, DQuat};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Samples in a second of curves and turns, and between two keys at most.
const RATE: f64 = 30.0;
const MAX_SAMPLES: f64 = 512.0;

/// One channel with where it leads.
struct Track {
    sampler: Sampler,
    /// The enclosing animations.
    of: Vec<usize>,
    goal: Goal,
    /// The one number that it moves; all without.
    component: Option<usize>,
}

enum Goal {
    Step { node: usize, step: usize },
    Weights { nodes: Vec<usize> },
}

/// From and to when, in seconds.
type Window = (f64, f64);

impl<'a> Reader<'a> {
    pub(super) fn read_clips(&mut self, nodes: &Nodes<'a>, weights: &WeightNodes) -> Result<(), ImportError> {
        let root = self.tree.root();
        let mut tracks = Vec::new();
        let mut stack: Vec<(At<'a>, Vec<usize>)> = root
            .all("library_animations")
            .flat_map(|library| library.all("animation"))
            .map(|at| (at, vec![at.number]))
            .collect();
        stack.reverse();
        while let Some((at, of)) = stack.pop() {
            for channel in at.all("channel") {
                self.track(channel, &of, nodes, weights, &mut tracks)?;
            }
            // Deep nests would make lists of ancestors long.
            self.take(at, of.len())?;
            stack.extend(at.all("animation").map(|child| (child, [&of[..], &[child.number]].concat())));
        }
        let told: Vec<At<'a>> =
            root.all("library_animation_clips").flat_map(|library| library.all("animation_clip")).collect();
        let mut of_animation: HashMap<usize, Vec<usize>> = HashMap::new();
        for (number, track) in tracks.iter().enumerate().filter(|_| !told.is_empty()) {
            track.of.iter().for_each(|animation| of_animation.entry(*animation).or_default().push(number));
        }
        for clip in &told {
            let number = |key| {
                clip.attribute(key).and_then(|text| text.trim().parse::<f64>().ok()).filter(|x| x.is_finite())
            };
            let window = (number("start").unwrap_or(0.0), number("end").unwrap_or(f64::MAX));
            let animations =
                clip.all("instance_animation").filter_map(|at| Some(at.target("url").ok()?.number));
            let chosen: BTreeSet<usize> =
                animations.filter_map(|at| of_animation.get(&at)).flatten().copied().collect();
            self.take(*clip, chosen.len())?;
            let chosen = chosen.into_iter().filter_map(|number| tracks.get(number)).collect();
            self.clip(clip.label(), chosen, window, nodes)?;
        }
        if told.is_empty() && !tracks.is_empty() {
            self.clip("animation", tracks.iter().collect(), (0.0, f64::MAX), nodes)?;
        }
        Ok(())
    }

    fn track(
        &mut self,
        at: At<'a>,
        of: &[usize],
        nodes: &Nodes<'a>,
        weights: &WeightNodes,
        tracks: &mut Vec<Track>,
    ) -> Result<(), ImportError> {
        let target = at.attribute("target").unwrap_or("");
        let (id, path) = target.rsplit_once('/').unwrap_or(("", target));
        let (path, component) = split_component(path);
        let mut goals = Vec::new();
        if id.is_empty() {
            let source = self.tree.by_id(path).and_then(|at| weights.get(&at.number));
            goals.extend(source.map(|nodes| Goal::Weights { nodes: nodes.clone() }));
        } else if let Some(element) = self.tree.by_id(id) {
            for &node in nodes.of_element.get(&element.number).into_iter().flatten() {
                let step =
                    nodes.steps.get(&node).and_then(|steps| steps.iter().position(|step| step.sid == path));
                goals.extend(step.map(|step| Goal::Step { node, step }));
            }
        }
        if goals.is_empty() {
            let text = format!("it moves '{target}', which is left out");
            self.note(at, Finding::LeftOut(text));
        }
        for goal in goals {
            let sampler = self.sampler(at.target("source")?)?;
            self.take(at, sampler.times.len())?;
            tracks.push(Track { sampler, of: of.to_vec(), goal, component });
        }
        Ok(())
    }

    fn clip(
        &mut self,
        name: &str,
        tracks: Vec<&Track>,
        window: Window,
        nodes: &Nodes<'a>,
    ) -> Result<(), ImportError> {
        let mut of_node: BTreeMap<usize, Vec<(&Track, usize)>> = BTreeMap::new();
        let mut of_weights: BTreeMap<usize, Vec<&Track>> = BTreeMap::new();
        for track in tracks {
            match &track.goal {
                Goal::Step { node, step } => of_node.entry(*node).or_default().push((track, *step)),
                Goal::Weights { nodes } => {
                    nodes.iter().for_each(|node| of_weights.entry(*node).or_default().push(track))
                }
            }
        }
        let mut clip = Clip { name: name.to_owned(), channels: Vec::new() };
        for (node, tracks) in of_node {
            let steps = nodes.steps.get(&node).map_or(&[][..], Vec::as_slice);
            self.move_node(node, steps, &tracks, window, &mut clip)?;
        }
        for (node, tracks) in of_weights {
            let rest: Vec<f64> =
                self.scene.nodes[node].weights.iter().map(|weight| f64::from(*weight)).collect();
            let curved = tracks.iter().any(|track| track.sampler.is_curved());
            let value = |time, after| {
                let mut weights = rest.clone();
                tracks.iter().for_each(|track| track.write(time, after, &mut weights));
                weights.iter().map(|weight| *weight as f32).collect()
            };
            let (times, values) = self.sample(&tracks, curved, rest.len() + tracks.len(), window, value)?;
            push(&mut clip, node, ChannelTarget::Weights, &times, values.concat());
        }
        if !clip.channels.is_empty() {
            self.scene.clips.push(clip);
        }
        Ok(())
    }

    fn move_node(
        &mut self,
        node: usize,
        steps: &[Step],
        tracks: &[(&Track, usize)],
        window: Window,
        clip: &mut Clip,
    ) -> Result<(), ImportError> {
        // Angles that change linearly make no linear change of a rotation, nor do linear factors of a
        // product.
        let turns = |(_, step): &(&Track, usize)| {
            steps
                .get(*step)
                .is_some_and(|step| ![Kind::Matrix, Kind::Translate, Kind::Scale].contains(&step.kind))
        };
        let curved = tracks.iter().any(|track| turns(track) || track.0.sampler.is_curved());
        let cost = tracks.len() + 2 * steps.len();
        let value = |time, after| {
            let mut values: Vec<Vec<f64>> = steps.iter().map(|step| step.values.clone()).collect();
            for (track, step) in tracks {
                track.write(time, after, &mut values[*step]);
            }
            let trs = parts(product(steps.iter().zip(values.iter().map(Vec::as_slice))));
            let [t, r, s] = [
                trs.translation.extend(0.0).to_array(),
                trs.rotation.to_array(),
                trs.scale.extend(0.0).to_array(),
            ];
            [t, r, s].concat()
        };
        let samplers: Vec<&Track> = tracks.iter().map(|(track, _)| *track).collect();
        let (times, values) = self.sample(&samplers, curved, cost, window, value)?;
        let rest = self.scene.nodes[node].local;
        if let Transform::Matrix(matrix) = rest {
            let trs = parts(DMat4::from(widen(&matrix)));
            self.scene.nodes[node].local = Transform::Trs(trs);
            let name = self.scene.nodes[node].name.clone();
            let text = format!("node {node} '{name}' is moved, so the shear in its transform is left out");
            self.note(self.tree.root(), Finding::LeftOut(text));
        }
        let pick = |range: std::ops::Range<usize>| {
            values.iter().flat_map(|value| &value[range.clone()]).copied().collect()
        };
        push(clip, node, ChannelTarget::Translation, &times, pick(0..3));
        push(clip, node, ChannelTarget::Rotation, &times, pick(4..8));
        push(clip, node, ChannelTarget::Scale, &times, pick(8..11));
        Ok(())
    }

    /// Evaluates a function at the times of all keys. A jump gets two keys at its time.
    fn sample(
        &mut self,
        tracks: &[&Track],
        curved: bool,
        cost: usize,
        window: Window,
        value: impl Fn(f64, bool) -> Vec<f32>,
    ) -> Result<(Vec<f64>, Vec<Vec<f32>>), ImportError> {
        let mut keys: Vec<f64> = tracks.iter().flat_map(|track| &track.sampler.times).copied().collect();
        keys.extend([window.0, window.1].into_iter().filter(|edge| *edge != 0.0 && *edge != f64::MAX));
        keys.retain(|key| (window.0..=window.1).contains(key));
        keys.sort_by(f64::total_cmp);
        keys.dedup();
        let (mut times, mut values) = (Vec::new(), Vec::new());
        for (number, &key) in keys.iter().enumerate() {
            let (before, after) = (value(key, false), value(key, true));
            self.take(self.tree.root(), cost)?;
            if number > 0 && before != after {
                times.push(key - window.0);
                values.push(before);
            }
            times.push(key - window.0);
            values.push(after);
            let Some(next) = keys.get(number + 1).filter(|_| curved) else { continue };
            let pieces = ((next - key) * RATE).ceil().clamp(1.0, MAX_SAMPLES) as usize;
            self.take(self.tree.root(), cost.saturating_mul(pieces))?;
            for piece in 1..pieces {
                let time = key + (next - key) * piece as f64 / pieces as f64;
                times.push(time - window.0);
                values.push(value(time, true));
            }
        }
        Ok((times, values))
    }
}

impl Track {
    /// Overwrites what it moves.
    fn write(&self, time: f64, after: bool, values: &mut [f64]) {
        match self.component {
            Some(component) => {
                if let Some(value) = values.get_mut(component) {
                    *value = self.sampler.at(time, after, 0);
                }
            }
            None => {
                for (dimension, value) in values.iter_mut().enumerate().take(self.sampler.width) {
                    *value = self.sampler.at(time, after, dimension);
                }
            }
        }
    }
}

fn push(clip: &mut Clip, node: usize, target: ChannelTarget, times: &[f64], values: Vec<f32>) {
    if !times.is_empty() {
        let (times, interpolation) = (times.to_vec(), Interpolation::Linear);
        clip.channels.push(Channel { node, target, interpolation, times, values });
    }
}

/// What follows a `sid`: `.X`, `.ANGLE`, `(2)`, `(column)(row)`.
fn split_component(path: &str) -> (&str, Option<usize>) {
    if let Some((sid, member)) = path.rsplit_once('.') {
        let component = match member {
            "X" | "U" | "R" => Some(0),
            "Y" | "V" | "G" => Some(1),
            "Z" | "B" => Some(2),
            "W" | "A" | "ANGLE" => Some(3),
            _ => None,
        };
        return if component.is_some() { (sid, component) } else { (path, None) };
    }
    let Some((sid, rest)) = path.split_once('(') else { return (path, None) };
    let numbers: Vec<usize> =
        rest.trim_end_matches(')').split(")(").filter_map(|text| text.parse().ok()).collect();
    match numbers[..] {
        [one] => (sid, Some(one)),
        // Matrices are stored by rows.
        [column, row] if column < 4 && row < 4 => (sid, Some(4 * row + column)),
        _ => (path, None),
    }
}

/// Translation, rotation and scale of a matrix; what a shear or a flat matrix has beyond them is lost.
fn parts(matrix: DMat4) -> Trs {
    match Transform::from_matrix(matrix) {
        Transform::Trs(trs) => trs,
        Transform::Matrix(_) => {
            let affine = DAffine3::from_mat4(matrix);
            let (scale, rotation, translation) = affine.to_scale_rotation_translation();
            let rotation = if rotation.is_finite() { rotation } else { DQuat::IDENTITY };
            let (translation, scale) = (translation.as_vec3(), scale.as_vec3());
            Trs { translation, rotation: rotation.as_quat(), scale }
        }
    }
}
