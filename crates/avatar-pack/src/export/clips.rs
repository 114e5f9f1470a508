//! Poses as clips.

use super::{trs, widen};
use crate::Pack;
use avatar_exchange::{Channel, ChannelTarget, Clip, Finding, Interpolation, Node, Note, Transform};
use glam::Affine3A;
use pose_anim::{Drive, Pose};
use std::collections::BTreeSet;
use std::ops::Range;

/// The shapes of a part at its node.
pub(super) struct ShapesOfNode {
    pub(super) node: usize,
    /// Where in [`Pack::shapes`].
    pub(super) shapes: Range<usize>,
    /// The weights of the targets behind them, in all clips.
    pub(super) resting: Vec<f32>,
}

/// Joints and weights where control values take them, after the couplings.
pub(super) fn posed(pack: &Pack, values: &[f32]) -> Option<(Vec<Affine3A>, Vec<f32>)> {
    let mut effective = vec![0.0; values.len()];
    pack.binding().couple(values, &mut effective);
    let (mut locals, mut weights) = (pack.rig().locals(), vec![0.0; pack.shapes().len()]);
    match pack.sliders() {
        None => pack.binding().apply(&effective, &mut locals, &mut weights).ok()?,
        Some(sliders) => {
            sliders.mix(pack.controls(), &mut effective);
            let mut values = vec![0.0; sliders.names.len()];
            pack.binding().apply(&effective, &mut locals, &mut values).ok()?;
            sliders.follow_controls(&effective, &mut values);
            sliders.run(&values, &mut weights).ok()?;
        }
    }
    Some((locals.as_slice().to_vec(), weights))
}

pub(super) fn clips(
    pack: &Pack,
    nodes: &[Node],
    shapes: &[ShapesOfNode],
    notes: &mut Vec<Note>,
) -> Vec<Clip> {
    let driven: BTreeSet<usize> = (pack.controls().controls().iter())
        .filter_map(|control| match &control.drives {
            Drive::Joint { joint, .. } => Some(pack.rig().joint(joint)?.index()),
            _ => None,
        })
        .collect();
    let mut clips = Vec::new();
    for pose in &pack.poses().poses {
        match clip(pack, pose, nodes, &driven, shapes) {
            Some(clip) => clips.push(clip),
            None => {
                let place = format!("pose {:?}", pose.name);
                notes.push(Note::new(place, Finding::left_out("does not fit the controls, and is left out")));
            }
        }
    }
    clips
}

/// One key for everything that controls move, be it at rest or not: programs that mix clips need them all.
fn clip(
    pack: &Pack,
    pose: &Pose,
    nodes: &[Node],
    driven: &BTreeSet<usize>,
    shapes: &[ShapesOfNode],
) -> Option<Clip> {
    let mut values = pack.controls().defaults();
    for (control, value) in &pose.values {
        *values.get_mut(*control)? = *value;
    }
    let (locals, weights) = posed(pack, &values)?;
    let mut channels = Vec::new();
    let mut key = |node: usize, target: ChannelTarget, values: Vec<f32>| {
        channels.push(Channel {
            node,
            target,
            interpolation: Interpolation::Linear,
            times: vec![0.0],
            values,
        });
    };
    for &joint in driven {
        let (bind, local) = (pack.rig().parent_from_joint().get(joint)?, locals.get(joint)?);
        let Transform::Trs(rest) = nodes.get(joint)?.local else { continue };
        let moved = trs(widen(*bind) * widen(*local));
        // The joint at rest is at rest to the bit.
        let rotation = if moved.rotation == -rest.rotation { rest.rotation } else { moved.rotation };
        key(joint, ChannelTarget::Translation, moved.translation.to_array().to_vec());
        key(joint, ChannelTarget::Rotation, rotation.to_array().to_vec());
    }
    for ShapesOfNode { node, shapes, resting } in shapes {
        let values = [weights.get(shapes.clone())?, resting].concat();
        if !values.is_empty() {
            key(*node, ChannelTarget::Weights, values);
        }
    }
    Some(Clip { name: pose.name.clone(), channels })
}
