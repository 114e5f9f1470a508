//! Records the draws of crowds: a part of all avatars of a chunk at once.

use crate::deform::crowd_chunk::{Chosen, Chunk};
use crate::frame::pipelines::PartPipelines;
use crate::frame::record::{Recording, bind_part, sides};
use crate::frame::standard::{Sides, Step};
use crate::model::effects::Effects;
use crate::model::finish::Finish;
use crate::model::part::ModelPart;

impl<'a> Recording<'a> {
    /// The parts that are wanted, each with its pipeline: a chunk has grooves wherever an avatar of it has.
    pub(crate) fn draw_crowds(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        chosen: Chosen,
        is_wanted: impl Fn(&ModelPart) -> bool,
        pipeline: impl Fn(&'a PartPipelines, &ModelPart, Effects) -> Option<&'a wgpu::RenderPipeline>,
    ) {
        let is_seen = |chunk: &Chunk| chunk.count(chosen) > 0;
        for (model, crowd) in self.crowds.iter().filter(|(_, crowd)| crowd.pose.chunks.iter().any(is_seen)) {
            for (index, part) in model.parts_with_triangles().filter(|(_, part)| is_wanted(part)) {
                let mut set = None;
                let mut is_bound = false;
                for chunk in &crowd.pose.chunks {
                    let count = chunk.count(chosen);
                    let Some(own) = chunk.parts.get(index).filter(|_| count > 0) else { continue };
                    let effects = self.effects(part, chunk.is_wrinkled);
                    if set.replace(effects) != Some(effects) {
                        let Some(pipeline) = pipeline(self.renderer.crowd_parts(), part, effects) else {
                            break;
                        };
                        pass.set_pipeline(pipeline);
                    }
                    if !std::mem::replace(&mut is_bound, true) {
                        bind_part(pass, part);
                        pass.insert_debug_marker(&part.label);
                    }
                    pass.set_bind_group(3, own.group(chosen), &[]);
                    pass.draw_indexed(0..part.geometry.index_count, 0, 0..count);
                }
            }
        }
    }

    /// Surfaces of interchange files that are wanted.
    pub(crate) fn draw_standard_crowds(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        step: Step,
        is_wanted: fn(Finish) -> bool,
    ) {
        let chosen = if step == Step::CutShadow { Chosen::Casting } else { Chosen::Drawn };
        let is_wanted = |part: &ModelPart| part.finish.get().is_some_and(is_wanted);
        self.draw_crowds(pass, chosen, is_wanted, |parts, part, _| {
            Some(self.standard_of(parts, step, sides(step, part), part))
        });
    }

    /// Corneas, and what else is blended: part by part, the avatars of a chunk from far to near.
    pub(crate) fn draw_blended_crowds(&self, pass: &mut wgpu::RenderPass<'_>) {
        for sides in [Sides::Back, Sides::Front] {
            let is_wanted = |part: &ModelPart| {
                let finish = part.finish.get().filter(|finish| finish.is_blended());
                finish.is_some_and(|finish| finish.is_double_sided || sides == Sides::Front)
            };
            self.draw_crowds(pass, Chosen::Blended, is_wanted, |parts, part, _| {
                Some(self.standard_of(parts, Step::Blended, sides, part))
            });
        }
        for (place, drawable) in self.renderer.parts.drawables().filter(|(_, one)| one.is_transparent) {
            let is_wanted = |part: &ModelPart| part.is_face_part(drawable.kind);
            self.draw_crowds(pass, Chosen::Blended, is_wanted, |parts, _, effects| {
                parts.in_picture(&self.renderer.layouts, place, effects)
            });
        }
    }
}
