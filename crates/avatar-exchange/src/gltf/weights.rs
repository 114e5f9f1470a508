//! Channels for single weights, as `KHR_animation_pointer` has them: one of the scene moves all of a node.

use crate::build::budget::Budget;
use crate::scene::{Channel, ChannelTarget, ImportError, Interpolation, RawScene, sample};
use std::collections::BTreeMap;

/// A channel that moves one weight of its node.
#[derive(Debug)]
pub(super) struct Single {
    /// For messages.
    pub(super) place: String,
    /// Which weight.
    pub(super) weight: usize,
    /// Its keys hold one number each, three for a spline.
    pub(super) channel: Channel,
}

/// One channel for each node; the place of a channel that cannot be told with the node's others: splines with
/// keys of their own, or several kinds of interpolation. Weights that none moves are at rest.
pub(super) fn merged(
    singles: Vec<Single>,
    scene: &RawScene,
    budget: &mut Budget,
) -> Result<Vec<Result<Channel, String>>, ImportError> {
    let mut of_nodes: BTreeMap<usize, Vec<Single>> = BTreeMap::new();
    for single in singles {
        check(&single, scene)?;
        of_nodes.entry(single.channel.node).or_default().push(single);
    }
    let mut found = Vec::with_capacity(of_nodes.len());
    for (node, singles) in of_nodes {
        let rest = &scene.nodes[node].weights;
        let Some(first) = singles.first().map(|single| single.channel.clone()) else { continue };
        let (same, others): (Vec<Single>, Vec<Single>) = singles.into_iter().partition(|single| {
            let rises = |channel: &Channel| channel.times.is_sorted_by(|a, b| a < b);
            let is_curve = first.interpolation == Interpolation::CubicSpline;
            let fits =
                single.channel.times == first.times || !is_curve && rises(&first) && rises(&single.channel);
            single.channel.interpolation == first.interpolation && fits
        });
        found.extend(others.into_iter().map(|single| Err(single.place)));
        let all: usize = same.iter().map(|single| single.channel.times.len()).sum();
        let bytes = size_of::<f64>() + 3 * size_of::<f32>() * rest.len().max(same.len());
        let place = || format!("weights of node {node}");
        budget.take(all, bytes).map_err(|exceeded| exceeded.at(place()))?;
        let mut times = first.times.clone();
        if same.iter().any(|single| single.channel.times != first.times) {
            times = same.iter().flat_map(|single| single.channel.times.iter().copied()).collect();
            times.sort_by(f64::total_cmp);
            times.dedup();
        }
        let values = values(&same, &times, rest);
        found.push(Ok(Channel { times, values, target: ChannelTarget::Weights, ..first }));
    }
    Ok(found)
}

fn check(single: &Single, scene: &RawScene) -> Result<(), ImportError> {
    let channel = &single.channel;
    let weights = scene.nodes.get(channel.node).map_or(0, |node| node.weights.len());
    if single.weight >= weights {
        let expected = format!("a weight below {weights}");
        return Err(ImportError::new(&single.place, expected, single.weight.to_string()));
    }
    let per_key = if channel.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let finite = channel.times.iter().all(|time| time.is_finite());
    if channel.times.is_empty() || !finite || channel.values.len() != per_key * channel.times.len() {
        let expected = format!("{per_key} numbers for each of its keys, at finite times");
        let found = format!("{} numbers for {} keys", channel.values.len(), channel.times.len());
        return Err(ImportError::new(&single.place, expected, found));
    }
    Ok(())
}

/// The values of all weights at these times, which are the keys of all channels or hold them.
fn values(singles: &[Single], times: &[f64], rest: &[f32]) -> Vec<f32> {
    let is_curve =
        singles.first().is_some_and(|single| single.channel.interpolation == Interpolation::CubicSpline);
    let slots = if is_curve { 3 } else { 1 };
    let mut values = Vec::with_capacity(times.len() * slots * rest.len());
    for _ in times {
        for slot in 0..slots {
            // Of a spline's three parts the tangents of what does not move are 0.
            let is_value = !is_curve || slot == 1;
            values.extend(rest.iter().map(|rest| if is_value { *rest } else { 0.0 }));
        }
    }
    for single in singles {
        for (key, time) in times.iter().enumerate() {
            for slot in 0..slots {
                let mut value = [0.0];
                if single.channel.times.len() == times.len() {
                    value[0] = single.channel.values[key * slots + slot];
                } else {
                    sample(&single.channel, *time, &mut value);
                }
                values[(key * slots + slot) * rest.len() + single.weight] = value[0];
            }
        }
    }
    values
}
