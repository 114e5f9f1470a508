//! Takes. The library samples them where straight lines between keys do not do.

use super::shapes::Blend;
use super::{allocator, quat, vec3};
use crate::build::budget::{Budget, Exceeded};
use crate::scene::{Channel, ChannelTarget, Clip, ImportError, Interpolation, RawScene};
use std::collections::HashMap;

/// The property of a blend channel that is its weight in percent.
const WEIGHT: &str = "DeformPercent";

/// Reads all takes that move something.
pub(super) fn read(
    fbx: &ufbx::Scene,
    blends: &[Blend<'_>],
    scene: &mut RawScene,
    budget: &mut Budget,
    memory_limit: usize,
) -> Result<(), ImportError> {
    for (number, stack) in fbx.anim_stacks.iter().enumerate() {
        let place = format!("take {number} '{}'", &*stack.element.name);
        let options = ufbx::BakeOpts {
            temp_allocator: allocator(memory_limit),
            result_allocator: allocator(memory_limit),
            trim_start_time: true,
            resample_rate: 30.0,
            step_handling: ufbx::BakeStepHandling::IdenticalTime,
            ..ufbx::BakeOpts::default()
        };
        let baked = ufbx::bake_anim(fbx, &stack.anim, options).map_err(|error| {
            ImportError::new(place.as_str(), "motion that can be sampled", &*error.description)
        })?;
        let mut channels = Vec::new();
        let wrong = |exceeded: Exceeded| exceeded.at(place.as_str());
        for node in &baked.nodes {
            let keys = node.translation_keys.len() + node.rotation_keys.len() + node.scale_keys.len();
            budget.take(keys, 1).map_err(wrong)?;
            node_channels(node, &mut channels);
        }
        let keys = keys_of_weights(&baked);
        for blend in blends.iter().filter(|blend| !scene.nodes[blend.node].weights.is_empty()) {
            channels.extend(weights(blend, &keys, budget).map_err(wrong)?);
        }
        if !channels.is_empty() {
            scene.clips.push(Clip { name: stack.element.name.to_string(), channels });
        }
    }
    Ok(())
}

fn node_channels(node: &ufbx::BakedNode, channels: &mut Vec<Channel>) {
    let mut push = |target, keys: Vec<(f64, Vec<f32>)>, constant: bool| {
        let kept = if constant { 1 } else { keys.len() };
        let (times, values): (Vec<f64>, Vec<Vec<f32>>) = keys.into_iter().take(kept).unzip();
        if !times.is_empty() {
            let node = node.typed_id as usize;
            let interpolation = Interpolation::Linear;
            channels.push(Channel { node, target, interpolation, times, values: values.concat() });
        }
    };
    let of = |keys: &ufbx::List<ufbx::BakedVec3>| {
        keys.iter().map(|key| (key.time, vec3(key.value).to_array().to_vec())).collect()
    };
    push(ChannelTarget::Translation, of(&node.translation_keys), node.constant_translation);
    let turns =
        node.rotation_keys.iter().map(|key| (key.time, quat(key.value).to_array().to_vec())).collect();
    push(ChannelTarget::Rotation, turns, node.constant_rotation);
    push(ChannelTarget::Scale, of(&node.scale_keys), node.constant_scale);
}

/// Times and weights of blend channels, by their element numbers.
fn keys_of_weights(baked: &ufbx::BakedAnim) -> HashMap<u32, Vec<(f64, f64)>> {
    let mut keys = HashMap::new();
    for element in &baked.elements {
        let weight = element.props.iter().find(|prop| &*prop.name == WEIGHT);
        if let Some(weight) = weight.filter(|weight| !weight.keys.is_empty()) {
            let percent = weight.keys.iter().map(|key| (key.time, key.value.x / 100.0));
            keys.insert(element.element_id, percent.collect());
        }
    }
    keys
}

/// The weights of a node's shapes: with keys wherever one of its channels has one, and where a shape begins
/// or stops to fade.
fn weights(
    blend: &Blend<'_>,
    keys: &HashMap<u32, Vec<(f64, f64)>>,
    budget: &mut Budget,
) -> Result<Option<Channel>, Exceeded> {
    let mut times: Vec<f64> = Vec::new();
    for ((element, _), kinks) in blend.channels.iter().zip(&blend.kinks) {
        let Some(keys) = keys.get(element) else { continue };
        times.extend(keys.iter().map(|key| key.0));
        for pair in keys.windows(2) {
            let ((from, a), (to, b)) = (pair[0], pair[1]);
            let crossed = kinks.iter().filter(|kink| (a.min(b) < **kink) && (**kink < a.max(b)));
            times.extend(crossed.map(|kink| from + (to - from) * (kink - a) / (b - a)));
        }
    }
    times.retain(|time| time.is_finite());
    times.sort_by(f64::total_cmp);
    times.dedup();
    let Some(&first) = times.first() else { return Ok(None) };
    let mut channel = Channel {
        node: blend.node,
        target: ChannelTarget::Weights,
        interpolation: Interpolation::Linear,
        times: Vec::new(),
        values: Vec::new(),
    };
    for time in times {
        let at = |after: bool| {
            let value = |(element, rest): &(u32, f32)| match keys.get(element) {
                Some(keys) => value_at(keys, time, after) as f32,
                None => *rest,
            };
            blend.weights(&blend.channels.iter().map(value).collect::<Vec<_>>())
        };
        let (before, after) = (at(false), at(true));
        budget.take(before.len(), 1)?;
        // A jump needs two keys.
        if before != after && time > first {
            channel.times.push(time);
            channel.values.extend(before);
        }
        channel.times.push(time);
        channel.values.extend(after);
    }
    Ok(Some(channel))
}

/// The value on the line between keys, just before or from a time on.
fn value_at(keys: &[(f64, f64)], time: f64, after: bool) -> f64 {
    let next = keys.partition_point(|key| if after { key.0 <= time } else { key.0 < time });
    match (next.checked_sub(1).and_then(|at| keys.get(at)), keys.get(next)) {
        (Some(a), Some(b)) if b.0 > a.0 => a.1 + (b.1 - a.1) * (time - a.0) / (b.0 - a.0),
        (Some(key), _) | (None, Some(key)) => key.1,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "a test may panic")]
mod tests {
    use super::super::{load, memory, read_nodes};
    use super::read;
    use crate::build::budget::Budget;
    use crate::scene::RawScene;

    #[test]
    fn keys_of_nodes_count_against_the_budget() {
        let bytes = include_bytes!("../../tests/all/fbx/face.fbx");
        let fbx = load(bytes).expect("a good file");
        let read_with = |left| {
            let mut scene = RawScene::default();
            read_nodes(&fbx, &mut scene).expect("nodes");
            read(&fbx, &[], &mut scene, &mut Budget::with_vertices_left(left), memory(bytes.len()))
                .map(|()| scene.clips.len())
        };
        assert_eq!(read_with(1000), Ok(1));
        assert_eq!(read_with(1).expect_err("too many keys").place, "take 0 'nod'");
    }
}
