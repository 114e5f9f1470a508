use super::document::{Document, in_range};
use crate::scene::quoted;
use crate::scene::{Channel, ChannelTarget, Clip, Finding, ImportError, Interpolation, RawScene};
use gltf::json::accessor::Type;
use gltf::json::animation;
use gltf::json::validation::Checked;
use std::collections::BTreeSet;

impl Document<'_> {
    pub(super) fn read_clips(&mut self, scene: &mut RawScene) -> Result<(), ImportError> {
        for (number, animation) in std::mem::take(&mut self.root.animations).into_iter().enumerate() {
            let name = animation.name.clone().unwrap_or_default();
            let mut clip = Clip { name, channels: Vec::with_capacity(animation.channels.len()) };
            let mut moved = BTreeSet::new();
            for (index, channel) in animation.channels.iter().enumerate() {
                let place = || {
                    let name = animation.name.as_ref().map_or(number.to_string(), |name| quoted(name));
                    format!("animation {name}, channel {index}")
                };
                let Some(channel) = self.channel(&animation.samplers, channel).map_err(|error| {
                    ImportError { place: format!("{}, {}", place(), error.place), ..error }
                })?
                else {
                    self.note(place(), Finding::left_out("moves something that is not represented"));
                    continue;
                };
                if !moved.insert((channel.node, channel.target)) {
                    let text = "moves what another channel moves, too; the later one counts";
                    self.note(place(), Finding::mended(text));
                }
                clip.channels.push(channel);
            }
            scene.clips.push(clip);
        }
        Ok(())
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
