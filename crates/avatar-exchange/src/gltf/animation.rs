use super::document::{Document, in_range};
use super::pointer::Special;
use super::weights::{Single, merged};
use crate::scene::quoted;
use crate::scene::{Channel, ChannelTarget, Clip, Finding, ImportError, Interpolation, RawScene};
use gltf::json::accessor::Type;
use gltf::json::animation;
use gltf::json::validation::Checked;
use std::collections::BTreeSet;

impl Document<'_> {
    /// `showers` are, for each mesh, the nodes that show it and have no weights of their own.
    pub(super) fn read_clips(
        &mut self,
        scene: &mut RawScene,
        showers: &[Vec<usize>],
    ) -> Result<(), ImportError> {
        for (animation, pointer) in std::mem::take(&mut self.pointers.left_out) {
            let text = format!("moves {}, which is not represented", quoted(&pointer));
            self.note(format!("animation {animation}"), Finding::LeftOut(text));
        }
        for (number, animation) in std::mem::take(&mut self.root.animations).into_iter().enumerate() {
            let name = animation.name.clone().unwrap_or_default();
            let mut clip = Clip { name, channels: Vec::with_capacity(animation.channels.len()) };
            let (mut moved, mut singles) = (BTreeSet::new(), Vec::new());
            for (index, channel) in animation.channels.iter().enumerate() {
                let place = || {
                    let name = animation.name.as_ref().map_or(number.to_string(), |name| quoted(name));
                    format!("animation {name}, channel {index}")
                };
                let at = |error: ImportError| ImportError {
                    place: format!("{}, {}", place(), error.place),
                    ..error
                };
                let Some(channel) = self.channel(&animation.samplers, channel).map_err(at)? else {
                    self.note(place(), Finding::left_out("moves something that is not represented"));
                    continue;
                };
                let special = self.pointers.special.remove(&(number, index)).unwrap_or_default();
                let nodes = self.moved_nodes(&channel, special, showers).map_err(at)?;
                if nodes.is_empty() {
                    let text = "moves the weights of a mesh that no node shows with them";
                    self.note(place(), Finding::left_out(text));
                }
                let bytes = size_of::<f64>() * channel.times.len() + size_of::<f32>() * channel.values.len();
                self.take(&place(), nodes.len().saturating_sub(1), bytes)?;
                for node in nodes {
                    let channel = Channel { node, ..channel.clone() };
                    if let Some(weight) = special.weight {
                        singles.push(Single { place: place(), weight, channel });
                        continue;
                    }
                    if !moved.insert((channel.node, channel.target)) {
                        let text = "moves what another channel moves, too; the later one counts";
                        self.note(place(), Finding::mended(text));
                    }
                    clip.channels.push(channel);
                }
            }
            for single in merged(singles, scene, &mut self.budget)? {
                match single {
                    Ok(channel) => clip.channels.push(channel),
                    Err(place) => {
                        let text = "moves one weight between other keys than the node's other weights: it is left out";
                        self.note(place, Finding::left_out(text));
                    }
                }
            }
            scene.clips.push(clip);
        }
        Ok(())
    }

    /// The nodes that a channel moves: its own, with all its instances where it moves weights, or those that
    /// show a mesh.
    fn moved_nodes(
        &mut self,
        channel: &Channel,
        special: Special,
        showers: &[Vec<usize>],
    ) -> Result<Vec<usize>, ImportError> {
        let own = match special.mesh {
            None => std::slice::from_ref(&channel.node),
            Some(mesh) => in_range("meshes", showers, mesh)?,
        };
        let mut nodes = own.to_vec();
        if channel.target == ChannelTarget::Weights {
            nodes.extend(own.iter().filter_map(|node| self.instances.get(node)).cloned().flatten());
        }
        Ok(nodes)
    }

    /// `None` for a property that is not known here.
    fn channel(
        &mut self,
        samplers: &[animation::Sampler],
        channel: &animation::Channel,
    ) -> Result<Option<Channel>, ImportError> {
        let target = match channel.target.path {
            Checked::Valid(animation::Property::Translation) => ChannelTarget::Translation,
            Checked::Valid(animation::Property::Rotation) => ChannelTarget::Rotation,
            Checked::Valid(animation::Property::Scale) => ChannelTarget::Scale,
            Checked::Valid(animation::Property::MorphTargetWeights) => ChannelTarget::Weights,
            Checked::Invalid => return Ok(None),
        };
        let number = channel.sampler.value();
        let sampler = in_range("samplers", samplers, number)?;
        let interpolation = match sampler.interpolation {
            Checked::Valid(animation::Interpolation::Linear) => Interpolation::Linear,
            Checked::Valid(animation::Interpolation::Step) => Interpolation::Step,
            Checked::Valid(animation::Interpolation::CubicSpline) => Interpolation::CubicSpline,
            Checked::Invalid => {
                let expected = "LINEAR, STEP or CUBICSPLINE";
                return Err(ImportError::new(format!("sampler {number}"), expected, "another interpolation"));
            }
        };
        let times = self.floats::<1, [f32; 1]>(sampler.input, Type::Scalar)?;
        self.take(&format!("sampler {number}"), times.len(), size_of::<f64>())?;
        let times = times.into_iter().map(|[time]| f64::from(time)).collect();
        let values = match target {
            ChannelTarget::Rotation => {
                self.floats::<4, [f32; 4]>(sampler.output, Type::Vec4)?.into_flattened()
            }
            ChannelTarget::Weights => {
                self.floats::<1, [f32; 1]>(sampler.output, Type::Scalar)?.into_flattened()
            }
            _ => self.floats::<3, [f32; 3]>(sampler.output, Type::Vec3)?.into_flattened(),
        };
        Ok(Some(Channel { node: channel.target.node.value(), target, interpolation, times, values }))
    }
}
