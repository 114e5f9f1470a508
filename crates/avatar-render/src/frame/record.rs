//! Records the passes of one frame.

use crate::avatar::crowd::AvatarCrowd;
use crate::avatar::model::AvatarModel;
use crate::avatar::state::AvatarState;
use crate::deform::crowd_chunk::Chosen;
use crate::deform::posed::PosedPart;
use crate::frame::part_pipelines::{BIND_SLOT, BONE_SLOT, CURVATURE_SLOT, EXTRA_SLOT, POSED_SLOT};
use crate::frame::passes::{Pass, PictureStep, depth_attachment};
use crate::frame::pipelines::PartPipelines;
use crate::frame::renderer::Renderer;
use crate::frame::sight::Sight;
use crate::frame::standard::{Sides, Step};
use crate::frame::targets::Targets;
use crate::frame::timer::{PassTimer, Span};
use crate::model::bone::GpuBone;
use crate::model::effects::Effects;
use crate::model::finish::{Finish, Opacity};
use crate::model::part::ModelPart;
use crate::view::lamps::SHADOW_COUNT;
use crate::view::scene::Scene;
use avatar_mesh::PartKind;
use std::sync::PoisonError;

/// Everything that the passes of one frame share.
pub(crate) struct Recording<'a> {
    pub(crate) renderer: &'a Renderer,
    pub(crate) view: &'a wgpu::TextureView,
    pub(crate) targets: &'a Targets,
    pub(crate) scene: &'a Scene,
    pub(crate) avatars: &'a [(&'a AvatarModel, &'a AvatarState)],
    pub(crate) crowds: &'a [(&'a AvatarModel, &'a mut AvatarCrowd)],
    pub(crate) clear: wgpu::Color,
    pub(crate) frame_offset: u32,
    pub(crate) shadow_offsets: [u32; SHADOW_COUNT],
    pub(crate) sight: Sight<'a>,
    pub(crate) timer: Option<&'a PassTimer>,
    /// Whether everything is drawn by programs that show wrinkles.
    pub(crate) rehearses: bool,
    /// Whether any of the avatars has hair in this view.
    pub(crate) has_hair: bool,
    /// Pixels that a unit of the world covers at distance 1.
    pub(crate) pixels_per_unit: f32,
    pub(crate) queue: &'a wgpu::Queue,
}

/// A part of an avatar.
type Item<'a> = (&'a ModelPart, &'a PosedPart, &'a AvatarState);

impl<'a> Recording<'a> {
    /// Whether the picture may show an avatar.
    pub(crate) fn shows(&self, model: &AvatarModel, state: &AvatarState) -> bool {
        state.bounds_with_hair(model).is_some_and(|bounds| self.sight.shows(bounds))
    }

    /// Whether it may show the avatar or its shadow. Others are neither deformed nor drawn.
    pub(crate) fn concerns(&self, model: &AvatarModel, state: &AvatarState) -> bool {
        self.sight.concerns(model, state)
    }

    /// What the program of a part has to show.
    pub(crate) fn effects(&self, part: &ModelPart, is_wrinkled: bool) -> Effects {
        part.effects(is_wrinkled || self.rehearses, self.scene.light.tone_map)
    }

    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder, pass: Pass) {
        let (renderer, targets) = (self.renderer, self.targets);
        let pipelines = &renderer.parts.passes;
        match pass {
            Pass::Deform => {
                let timestamps = self.timer.and_then(|timer| timer.compute_pass(pass));
                let wanted = self.avatars.iter().filter(|(model, state)| self.concerns(model, state));
                let avatars = wanted.map(|(model, state)| state.deforming(model));
                let crowds = self.crowds.iter().map(|(model, crowd)| (&*model.parts, &crowd.pose));
                renderer.deformer.record(encoder, timestamps, avatars, crowds);
            }
            Pass::GrowHair => {
                let timestamps = self.timer.and_then(|timer| timer.compute_pass(pass));
                renderer.grower.record_due(encoder, timestamps, self.growing());
            }
            Pass::Shadows => self.shadows(encoder),
            Pass::HairShadow => self.hair_shadow(encoder),
            Pass::Prepass => self.prepass(encoder),
            Pass::Occlusion => {
                let Some(pipeline) = &pipelines.occlusion else { return };
                let mut pass = self.begin(encoder, pass, Some(&targets.occlusion), None);
                self.set_groups(&mut pass, &targets.for_occlusion);
                pass.set_pipeline(pipeline);
                pass.draw(0..3, 0..1);
            }
            Pass::SkinLight => {
                let group = &targets.for_skin_light;
                self.on_skin(encoder, pass, &targets.skin_light, group, |parts, effects| {
                    parts.skin_light(&renderer.layouts, effects)
                });
            }
            Pass::ScatterAcross => {
                let group = &targets.for_scattering;
                self.on_skin(encoder, pass, &targets.scattered, group, |parts, _| {
                    parts.passes.scatter_across.as_ref()
                });
            }
            Pass::Picture => self.picture(encoder),
            Pass::Hair => self.strands(encoder),
            Pass::Clear => self.clear_parts(encoder),
        }
    }

    fn prepass(&self, encoder: &mut wgpu::CommandEncoder) {
        let targets = self.targets;
        let depth = depth_attachment(&targets.single_depth);
        let mut pass = self.begin(encoder, Pass::Prepass, Some(&targets.normals), Some(depth));
        self.set_groups(&mut pass, &targets.for_prepass);
        // Of skin, what has a back from both sides, and the rest from the front.
        for (kind, place) in
            [(PartKind::Skin, 1), (PartKind::Skin, 0), (PartKind::Surface, 1), (PartKind::Eyeball, 0)]
        {
            let is_wanted = move |part: &ModelPart| {
                part.is_face_part(kind) && (kind != PartKind::Skin || part.finish.has_back() == (place == 1))
            };
            self.draw_items(&mut pass, is_wanted, |parts, _| parts.passes.prepass.as_ref()?.get(place));
        }
        for (sides, place) in [(Sides::Front, 0), (Sides::Both, 1)] {
            let is_wanted = move |part: &ModelPart| {
                let finish = part.finish.get();
                finish.is_some_and(|finish| {
                    finish.opacity == Opacity::Opaque && Sides::of(finish.is_double_sided) == sides
                })
            };
            self.draw_items(&mut pass, is_wanted, |parts, _| parts.passes.prepass.as_ref()?.get(place));
        }
        self.draw_standard(&mut pass, Step::CutPrepass, Finish::is_cut);
    }

    /// A pass over the skin that is seen.
    fn on_skin(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pass: Pass,
        color: &wgpu::TextureView,
        group: &wgpu::BindGroup,
        pipeline: impl Fn(&'a PartPipelines, Effects) -> Option<&'a wgpu::RenderPipeline>,
    ) {
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &self.targets.single_depth,
            // Read only: the pass reads the same texture.
            depth_ops: None,
            stencil_ops: None,
        };
        let mut pass = self.begin(encoder, pass, Some(color), Some(depth));
        self.set_groups(&mut pass, group);
        self.draw_kind(&mut pass, PartKind::Skin, pipeline);
    }

    fn shadows(&self, encoder: &mut wgpu::CommandEncoder) {
        let renderer = self.renderer;
        let Some(pipeline) = &renderer.parts.passes.shadow else { return };
        let layers = &renderer.resources.shadow_layers;
        for (i, (layer, offset)) in layers.iter().zip(self.shadow_offsets).enumerate() {
            let span = Span::of(i, layers.len());
            let timestamps = self.timer.and_then(|timer| timer.render_pass(Pass::Shadows, span));
            let depth = wgpu::RenderPassDepthStencilAttachment {
                view: layer,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            };
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(if i == 0 { "shadow of the key" } else { "shadow of the rim" }),
                depth_stencil_attachment: Some(depth),
                timestamp_writes: timestamps,
                ..Default::default()
            });
            pass.set_bind_group(0, &renderer.shadow_group, &[offset]);
            // Corneas are clear.
            for kind in [PartKind::Skin, PartKind::Surface, PartKind::Eyeball] {
                pass.set_pipeline(pipeline);
                let is_whole = move |part: &ModelPart| {
                    part.kind == kind
                        && part.finish.get().is_none_or(|finish| finish.opacity == Opacity::Opaque)
                };
                for (part, posed, _) in self.items(Chosen::Casting, is_whole) {
                    pass.set_index_buffer(part.geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
                    pass.set_vertex_buffer(0, posed.vertices.slice(..));
                    pass.draw_indexed(0..part.geometry.index_count, 0, 0..1);
                }
                self.draw_crowds(&mut pass, Chosen::Casting, is_whole, |parts, _, _| {
                    parts.passes.shadow.as_ref()
                });
            }
            self.draw_standard(&mut pass, Step::CutShadow, |finish| finish.opacity != Opacity::Opaque);
        }
    }

    fn picture(&self, encoder: &mut wgpu::CommandEncoder) {
        // One pass where it is enough: the picture is not stored and loaded in between.
        let step = if self.has_hair { PictureStep::First } else { PictureStep::Only };
        let mut pass = self.begin_picture(encoder, Pass::Picture, step, self.times(Pass::Picture));
        self.draw_opaque(&mut pass);
        if !self.has_hair {
            self.draw_blended(&mut pass);
        }
    }

    fn clear_parts(&self, encoder: &mut wgpu::CommandEncoder) {
        let times = self.times(Pass::Clear);
        let mut pass = self.begin_picture(encoder, Pass::Clear, PictureStep::Last, times);
        self.draw_blended(&mut pass);
    }

    fn times(&self, pass: Pass) -> Option<wgpu::RenderPassTimestampWrites<'a>> {
        self.timer.and_then(|timer| timer.render_pass(pass, Span::Whole))
    }

    fn draw_opaque(&self, pass: &mut wgpu::RenderPass<'_>) {
        let layouts = &self.renderer.layouts;
        for (place, drawable) in self.renderer.parts.drawables().filter(|(_, one)| !one.is_transparent) {
            pass.push_debug_group(drawable.label);
            let is_back = drawable.is_back;
            let is_wanted = move |part: &ModelPart| {
                part.is_face_part(drawable.kind) && (!is_back || part.finish.has_back())
            };
            self.draw_items(pass, is_wanted, |parts, effects| parts.in_picture(layouts, place, effects));
            pass.pop_debug_group();
        }
        self.draw_standard(pass, Step::Opaque, |finish| finish.opacity == Opacity::Opaque);
        self.draw_standard(pass, Step::Cut, Finish::is_cut);
        self.draw_standard(pass, Step::Outline, |finish| finish.has_outline && !finish.is_blended());
    }

    /// Corneas and what else is blended, from far to near.
    fn draw_blended(&self, pass: &mut wgpu::RenderPass<'_>) {
        let eye = self.scene.camera.eye();
        let (parts, layouts) = (&self.renderer.parts, &self.renderer.layouts);
        let corneas = parts.drawables().find(|(_, drawable)| drawable.is_transparent);
        let Some((place, drawable)) = corneas else { return };
        pass.push_debug_group(drawable.label);
        let mut far = self.renderer.far_to_near.lock().unwrap_or_else(PoisonError::into_inner);
        for (avatar, part) in far.sort(self.avatars, eye) {
            let Some((model, state)) = self.avatars.get(avatar) else { continue };
            if !self.shows(model, state) {
                continue;
            }
            let (Some(part), Some(posed)) = (model.parts.get(part), state.pose.parts.get(part)) else {
                continue;
            };
            bind_part(pass, part);
            // Of what has two sides, the back lies behind.
            let sides: &[Sides] = match part.finish.get() {
                None => &[],
                Some(finish) if finish.is_double_sided => &[Sides::Back, Sides::Front],
                Some(_) => &[Sides::Front],
            };
            for sides in sides {
                pass.set_pipeline(self.standard(Step::Blended, *sides, part));
                draw_part(pass, part, posed, state);
            }
            let effects = self.effects(part, state.pose.is_wrinkled());
            if sides.is_empty()
                && let Some(pipeline) = parts.in_picture(layouts, place, effects)
            {
                pass.set_pipeline(pipeline);
                draw_part(pass, part, posed, state);
            }
        }
        self.draw_blended_crowds(pass);
        pass.pop_debug_group();
    }

    /// The parts that are wanted of the avatars that are chosen, those of one model together.
    fn items<F: Fn(&ModelPart) -> bool + Copy + 'a>(
        &self,
        chosen: Chosen,
        is_wanted: F,
    ) -> impl Iterator<Item = Item<'a>> {
        let of_group = move |group: &'a [(&'a AvatarModel, &'a AvatarState)]| {
            let parts = group.first().into_iter().flat_map(|(model, _)| model.parts_with_triangles());
            let wanted = parts.filter(move |(_, part)| is_wanted(part));
            wanted.flat_map(move |(index, part)| {
                let seen = group.iter().filter(move |(model, state)| match chosen {
                    Chosen::Drawn | Chosen::Blended => self.shows(model, state),
                    Chosen::Casting => self.concerns(model, state),
                });
                seen.filter_map(move |(_, state)| Some((part, state.pose.parts.get(index)?, *state)))
            })
        };
        self.avatars.chunk_by(|(a, _), (b, _)| std::ptr::eq(*a, *b)).flat_map(of_group)
    }

    /// The parts of faces of this kind, each with the pipeline for what has to be shown of it.
    fn draw_kind(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        kind: PartKind,
        pipeline: impl Fn(&'a PartPipelines, Effects) -> Option<&'a wgpu::RenderPipeline>,
    ) {
        self.draw_items(pass, move |part| part.is_face_part(kind), pipeline);
    }

    fn draw_items<F: Fn(&ModelPart) -> bool + Copy + 'a>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        is_wanted: F,
        pipeline: impl Fn(&'a PartPipelines, Effects) -> Option<&'a wgpu::RenderPipeline>,
    ) {
        let mut bound: Option<&ModelPart> = None;
        let mut set = None;
        for (part, posed, state) in self.items(Chosen::Drawn, is_wanted) {
            let effects = self.effects(part, state.pose.is_wrinkled());
            if set.replace(effects) != Some(effects) {
                let Some(pipeline) = pipeline(&self.renderer.parts, effects) else { break };
                pass.set_pipeline(pipeline);
            }
            if !bound.is_some_and(|bound| std::ptr::eq(bound, part)) {
                bind_part(pass, part);
                bound = Some(part);
            }
            draw_part(pass, part, posed, state);
        }
        self.draw_crowds(pass, Chosen::Drawn, is_wanted, |parts, _, effects| pipeline(parts, effects));
    }

    /// Surfaces of interchange files that are wanted.
    fn draw_standard(&self, pass: &mut wgpu::RenderPass<'_>, step: Step, is_wanted: fn(Finish) -> bool) {
        let mut bound: Option<&ModelPart> = None;
        let chosen = if step == Step::CutShadow { Chosen::Casting } else { Chosen::Drawn };
        for (part, posed, state) in self.items(chosen, move |part| part.finish.get().is_some_and(is_wanted)) {
            if !bound.is_some_and(|bound| std::ptr::eq(bound, part)) {
                pass.set_pipeline(self.standard(step, sides(step, part), part));
                bind_part(pass, part);
                bound = Some(part);
            }
            draw_part(pass, part, posed, state);
        }
        self.draw_standard_crowds(pass, step, is_wanted);
    }

    fn standard(&self, step: Step, sides: Sides, part: &ModelPart) -> &'a wgpu::RenderPipeline {
        self.standard_of(&self.renderer.parts, step, sides, part)
    }

    /// One of these pipelines.
    pub(crate) fn standard_of(
        &self,
        parts: &'a PartPipelines,
        step: Step,
        sides: Sides,
        part: &ModelPart,
    ) -> &'a wgpu::RenderPipeline {
        parts.standard.get(&self.renderer.layouts, self.renderer.config(), step, sides, part)
    }
}

/// Which sides of a part a step draws.
pub(crate) fn sides(step: Step, part: &ModelPart) -> Sides {
    match step {
        // Open sheets cast shadows, too.
        Step::CutShadow => Sides::Both,
        // Back sides that show beyond the front.
        Step::Outline => Sides::Back,
        _ => Sides::of(part.finish.get().is_some_and(|finish| finish.is_double_sided)),
    }
}

pub(crate) fn bind_part(pass: &mut wgpu::RenderPass<'_>, part: &ModelPart) {
    let geometry = &part.geometry;
    pass.set_bind_group(2, &part.look, &[]);
    pass.set_vertex_buffer(BIND_SLOT, geometry.vertices.slice(..));
    pass.set_vertex_buffer(CURVATURE_SLOT, geometry.curvatures.slice(..));
    if let Some(extras) = &geometry.extras {
        pass.set_vertex_buffer(EXTRA_SLOT, extras.slice(..));
    }
    pass.set_index_buffer(geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
}

fn draw_part(pass: &mut wgpu::RenderPass<'_>, part: &ModelPart, posed: &PosedPart, state: &AvatarState) {
    let bone = u64::from(part.geometry.rigid_bone) * size_of::<GpuBone>() as u64;
    pass.set_vertex_buffer(POSED_SLOT, posed.vertices.slice(..));
    pass.set_vertex_buffer(BONE_SLOT, state.pose.bone_buffer.slice(bone..));
    pass.insert_debug_marker(&part.label);
    let indices = |pass: &mut wgpu::RenderPass<'_>, buffer: &wgpu::Buffer| {
        pass.set_index_buffer(buffer.slice(..), wgpu::IndexFormat::Uint32);
    };
    let reversed = posed.reversed();
    reversed.iter().for_each(|reversed| indices(pass, &reversed.indices));
    pass.draw_indexed(0..part.geometry.index_count, 0, 0..1);
    // The next avatar of the model has those of the part again.
    reversed.iter().for_each(|_| indices(pass, &part.geometry.indices));
}
