//! Takes. The library evaluates them; which times it is asked for is the matter of [`super::curves`].

use super::curves::{Curves, MAX_CYCLES, MAX_FRAMES_BETWEEN, Moment, Source, connections};
use super::shapes::Blend;
use super::{note, quat, vec3};
use crate::build::budget::{Budget, Exceeded};
use crate::scene::{Channel, ChannelTarget, Clip, Finding, ImportError, Interpolation, RawScene, quoted};
use std::collections::HashMap;

/// The property of a blend channel that is its weight in percent.
const WEIGHT: &str = "DeformPercent";
/// What moves, turns and scales a node.
const TRANSLATION: &str = "Lcl Translation";
const ROTATION: &str = "Lcl Rotation";
const SCALE: &str = "Lcl Scaling";
/// What turns a node besides its rotation.
const AXES: [&str; 3] = ["PreRotation", "PostRotation", "RotationOrder"];
/// Where they are not 0, rotation and scale move a node, too.
const PIVOTS: [&str; 4] = ["RotationOffset", "RotationPivot", "ScalingOffset", "ScalingPivot"];
/// Frames in a second where the file names none, and the most that are sampled.
const USUAL_RATE: f64 = 30.0;
const MAX_RATE: f64 = 1000.0;
/// Nodes above a node whose scale can act on it.
const MAX_CHAIN: usize = 1024;

/// Reads all takes that move something. Each begins at 0.
pub(super) fn read(
    fbx: &ufbx::Scene,
    blends: &[Blend<'_>],
    scene: &mut RawScene,
    budget: &mut Budget,
) -> Result<(), ImportError> {
    let rate = fbx.settings.frames_per_second;
    let rate = if rate > 0.0 && rate.is_finite() { rate.min(MAX_RATE) } else { USUAL_RATE };
    let connections = connections(fbx);
    let of_channel: HashMap<u32, &ufbx::BlendChannel> =
        fbx.blend_channels.iter().map(|channel| (channel.element.element_id, &**channel)).collect();
    for (number, stack) in fbx.anim_stacks.iter().enumerate() {
        let place = format!("take {number} '{}'", &*stack.element.name);
        let wrong = |exceeded: Exceeded| exceeded.at(place.as_str());
        let anim = &*stack.anim;
        let range = Some((anim.time_begin, anim.time_end)).filter(|(begin, end)| begin < end);
        let begin = range.map_or(0.0, |range| range.0);
        let mut curves = Curves::new(anim, &connections, rate, range);
        let mut channels = Vec::new();
        for node in &fbx.nodes {
            node_channels(anim, node, begin, &mut curves, &mut channels, budget).map_err(wrong)?;
        }
        let mut keys: HashMap<u32, Vec<(f64, f64)>> = HashMap::new();
        for (element, _) in blends.iter().flat_map(|blend| &blend.channels) {
            let Some(channel) = of_channel.get(element).filter(|_| !keys.contains_key(element)) else {
                continue;
            };
            let moments = curves.moments(&[(*element, WEIGHT, false)], budget).map_err(wrong)?;
            let key = |at: &Moment| (at.time - begin, ufbx::evaluate_blend_weight(anim, channel, at.asked()));
            keys.extend(moments.map(|moments| (*element, moments.iter().map(key).collect())));
        }
        for blend in blends.iter().filter(|blend| !scene.nodes[blend.node].weights.is_empty()) {
            channels.extend(weights(blend, &keys, budget).map_err(wrong)?);
        }
        note_what_is_lost(&curves, &place, scene);
        if let Some((begin, end)) = range {
            last_until(&mut channels, end - begin);
        }
        if !channels.is_empty() {
            scene.clips.push(Clip { name: stack.element.name.to_string(), channels });
        }
    }
    Ok(())
}

/// A take lasts as long as the file says, also where its curves end earlier: they hold from there, so one key
/// more says it.
fn last_until(channels: &mut [Channel], duration_secs: f64) {
    let last = |channel: &Channel| channel.times.last().copied().unwrap_or(0.0);
    let longest = channels.iter_mut().max_by(|a, b| last(a).total_cmp(&last(b)));
    let Some(channel) = longest.filter(|channel| last(channel) < duration_secs) else { return };
    let width = channel.values.len() / channel.times.len().max(1);
    let held = channel.values.len() - width;
    channel.times.push(duration_secs);
    channel.values.extend_from_within(held..);
}

fn note_what_is_lost(curves: &Curves<'_>, place: &str, scene: &mut RawScene) {
    const SHOWN: usize = 8;
    if !curves.going_on.is_empty() {
        let text = format!(
            "{} curves go on beyond their keys (cycles or slopes): they do so until the take ends, and hold there",
            curves.going_on.len()
        );
        note(&mut scene.notes, place, Finding::Converted(text));
    }
    if curves.is_cut {
        let text = "keys before its beginning or behind its end, as the file tells them, are left out";
        note(&mut scene.notes, place, Finding::left_out(text));
    }
    if curves.is_thinned {
        let text = format!(
            "between keys that are more than {MAX_FRAMES_BETWEEN} frames apart, only every second frame or fewer are kept"
        );
        note(&mut scene.notes, place, Finding::Converted(text));
    }
    if curves.has_fewer_cycles {
        let text = format!("only the {MAX_CYCLES} repetitions next to the keys are kept");
        note(&mut scene.notes, place, Finding::LeftOut(text));
    }
    let unused = curves.unused();
    if !unused.is_empty() {
        let names: Vec<String> = unused.iter().take(SHOWN).map(|name| quoted(name)).collect();
        let more = if unused.len() > SHOWN { " and more" } else { "" };
        let text = format!("motion of {}{more} is left out", names.join(", "));
        note(&mut scene.notes, place, Finding::LeftOut(text));
    }
}

/// What a take moves of a node: one channel each for translation, rotation and scale.
fn node_channels<'a>(
    anim: &ufbx::Anim,
    node: &'a ufbx::Node,
    begin: f64,
    curves: &mut Curves<'a>,
    channels: &mut Vec<Channel>,
    budget: &mut Budget,
) -> Result<(), Exceeded> {
    let own = node.element.element_id;
    // The scale of nodes above that this one does not inherit: it has a node of its own there, and moves
    // those beside that.
    let helpers: Vec<Source<'a>> =
        scales_above(node).into_iter().map(|helper| (helper, SCALE, true)).collect();
    let has_pivots = PIVOTS.iter().any(|name| {
        let pivot = ufbx::find_prop(&node.element.props, name).map(|prop| prop.value_vec4);
        pivot.is_some_and(|at| at.x != 0.0 || at.y != 0.0 || at.z != 0.0)
    });
    let turns: Vec<Source<'a>> = [ROTATION].iter().chain(&AXES).map(|name| (own, *name, true)).collect();
    let pivots: Vec<Source<'a>> = PIVOTS.iter().map(|name| (own, *name, true)).collect();
    let moves_pivots = curves.moments(&pivots, budget)?.is_some();
    let mut translation = vec![(own, TRANSLATION, !helpers.is_empty())];
    if !node.is_scale_helper {
        translation.extend(&helpers);
    }
    if has_pivots || moves_pivots {
        translation.extend(pivots.iter().chain(&turns).chain(&[(own, SCALE, true)]));
    }
    let mut scale = vec![(own, SCALE, node.is_scale_helper && !helpers.is_empty())];
    if node.is_scale_helper {
        scale.extend(&helpers);
    }
    for (target, sources) in [
        (ChannelTarget::Translation, translation),
        (ChannelTarget::Rotation, turns),
        (ChannelTarget::Scale, scale),
    ] {
        let Some(moments) = curves.moments(&sources, budget)? else { continue };
        let (mut times, mut values): (Vec<f64>, Vec<f32>) = (Vec::new(), Vec::new());
        for moment in moments {
            let local = ufbx::evaluate_transform(anim, node, moment.asked());
            times.push(moment.time - begin);
            match target {
                ChannelTarget::Translation => values.extend(vec3(local.translation).to_array()),
                ChannelTarget::Rotation => values.extend(quat(local.rotation).to_array()),
                _ => values.extend(vec3(local.scale).to_array()),
            }
        }
        let width = if target == ChannelTarget::Rotation { 4 } else { 3 };
        if values.chunks_exact(width).all(|value| value == &values[..width]) {
            times.truncate(1);
            values.truncate(width);
        }
        let node = node.element.typed_id as usize;
        channels.push(Channel { node, target, interpolation: Interpolation::Linear, times, values });
    }
    Ok(())
}

/// Nodes that hold a scale which acts on a node's place, or, where the node is such a one itself, on its
/// scale.
fn scales_above(node: &ufbx::Node) -> Vec<u32> {
    let Some(parent) = &node.parent else { return Vec::new() };
    let beside = parent.scale_helper.as_ref().filter(|_| !node.is_scale_helper);
    let mut found: Vec<u32> = beside.map(|helper| helper.element.element_id).into_iter().collect();
    let mut above = parent.inherit_scale_node.as_ref();
    while let Some(helper) =
        above.and_then(|above| above.scale_helper.as_ref()).filter(|_| found.len() < MAX_CHAIN)
    {
        found.push(helper.element.element_id);
        above = above.and_then(|above| above.inherit_scale_node.as_ref());
    }
    found
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
    use super::super::{load, read_nodes};
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
            read(&fbx, &[], &mut scene, &mut Budget::with_vertices_left(left)).map(|()| scene.clips.len())
        };
        assert_eq!(read_with(1000), Ok(1));
        // A key counts once, however many curves and properties share its time.
        let scene = crate::fbx::read("face.fbx", bytes, &mut |_| Err("no files".to_owned())).expect("good");
        let keys: usize =
            scene.clips.iter().flat_map(|clip| &clip.channels).map(|channel| channel.times.len()).sum();
        assert_eq!(read_with(keys as u64), Ok(1));
        assert_eq!(read_with(1).expect_err("too many keys").place, "take 0 'nod'");
    }
}
