//! Records the passes of one frame.

use crate::avatar::model::AvatarModel;
use crate::avatar::state::AvatarState;
use crate::deform::posed::PosedPart;
use crate::frame::part_pipelines::{BIND_SLOT, BONE_SLOT, CURVATURE_SLOT, EXTRA_SLOT, POSED_SLOT};
use crate::frame::passes::Pass;
use crate::frame::renderer::Renderer;
use crate::frame::standard::{Sides, Step};
use crate::frame::targets::Targets;
use crate::frame::timer::{PassTimer, Span};
use crate::model::bone::GpuBone;
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
    pub(crate) clear: wgpu::Color,
    pub(crate) frame_offset: u32,
    pub(crate) shadow_offsets: [u32; SHADOW_COUNT],
    pub(crate) timer: Option<&'a PassTimer>,
    /// Whether any of the avatars has hair in this view.
    pub(crate) has_hair: bool,
    /// Pixels that a unit of the world covers at distance 1.
    pub(crate) pixels_per_unit: f32,
    pub(crate) queue: &'a wgpu::Queue,
}

/// The position of a pass among those that draw into the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PictureStep {
    /// There is no other.
    Only,
    /// It clears the picture.
    First,
    /// It draws over what is there.
    Between,
    /// It leaves the picture in the caller's view.
    Last,
}

/// A part of an avatar.
type Item<'a> = (&'a ModelPart, &'a PosedPart, &'a AvatarState);

impl<'a> Recording<'a> {
    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder, pass: Pass) {
        let (renderer, targets) = (self.renderer, self.targets);
        let pipelines = &renderer.passes;
        match pass {
            Pass::Deform => {
                let timestamps = self.timer.and_then(|timer| timer.compute_pass(pass));
                let avatars = self.avatars.iter().map(|(model, state)| state.deforming(model));
                renderer.deformer.record(encoder, timestamps, avatars);
            }
            Pass::GrowHair => {
                let timestamps = self.timer.and_then(|timer| timer.compute_pass(pass));
                renderer.grower.record(encoder, timestamps, self.growing());
            }
            Pass::Shadows => self.shadows(encoder),
            Pass::HairShadow => self.hair_shadow(encoder),
            Pass::Prepass => {
                let Some([front, both]) = &pipelines.prepass else { return };
                let depth = depth_attachment(&targets.single_depth);
                let mut pass = self.begin(encoder, pass, Some(&targets.normals), Some(depth));
                self.set_groups(&mut pass, &targets.for_prepass);
                for (kind, pipeline) in
                    [(PartKind::Skin, both), (PartKind::Surface, both), (PartKind::Eyeball, front)]
                {
                    pass.set_pipeline(pipeline);
                    self.draw_kind(&mut pass, kind);
                }
                for (sides, pipeline) in [(Sides::Front, front), (Sides::Both, both)] {
                    pass.set_pipeline(pipeline);
                    self.draw_items(&mut pass, move |part| {
                        let finish = part.finish.get();
                        finish.is_some_and(|finish| {
                            finish.opacity == Opacity::Opaque && Sides::of(finish.is_double_sided) == sides
                        })
                    });
                }
                self.draw_standard(&mut pass, Step::CutPrepass, Finish::is_cut);
            }
            Pass::Occlusion => {
                let Some(pipeline) = &pipelines.occlusion else { return };
                let mut pass = self.begin(encoder, pass, Some(&targets.occlusion), None);
                self.set_groups(&mut pass, &targets.for_occlusion);
                pass.set_pipeline(pipeline);
                pass.draw(0..3, 0..1);
            }
            Pass::SkinLight => {
                let group = &targets.for_skin_light;
                self.on_skin(encoder, pass, pipelines.skin_light.as_ref(), &targets.skin_light, group);
            }
            Pass::ScatterAcross => {
                let group = &targets.for_scattering;
                self.on_skin(encoder, pass, pipelines.scatter_across.as_ref(), &targets.scattered, group);
            }
            Pass::Picture => self.picture(encoder),
            Pass::Hair => self.strands(encoder),
            Pass::Clear => self.clear_parts(encoder),
        }
    }

    /// A pass over the skin that is seen.
    fn on_skin(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pass: Pass,
        pipeline: Option<&wgpu::RenderPipeline>,
        color: &wgpu::TextureView,
        group: &wgpu::BindGroup,
    ) {
        let Some(pipeline) = pipeline else { return };
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &self.targets.single_depth,
            // Read only: the pass reads the same texture.
            depth_ops: None,
            stencil_ops: None,
        };
        let mut pass = self.begin(encoder, pass, Some(color), Some(depth));
        self.set_groups(&mut pass, group);
        pass.set_pipeline(pipeline);
        self.draw_kind(&mut pass, PartKind::Skin);
    }

    fn shadows(&self, encoder: &mut wgpu::CommandEncoder) {
        let renderer = self.renderer;
        let Some(pipeline) = &renderer.passes.shadow else { return };
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
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &renderer.shadow_group, &[offset]);
            // Corneas are clear.
            for kind in [PartKind::Skin, PartKind::Surface, PartKind::Eyeball] {
                let is_whole = move |part: &ModelPart| {
                    part.kind == kind
                        && part.finish.get().is_none_or(|finish| finish.opacity == Opacity::Opaque)
                };
                for (part, posed, _) in self.items(is_whole) {
                    pass.set_index_buffer(part.geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
                    pass.set_vertex_buffer(0, posed.vertices.slice(..));
                    pass.draw_indexed(0..part.geometry.index_count, 0, 0..1);
                }
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
        for (drawable, pipeline) in self.renderer.picture.iter().filter(|(d, _)| !d.is_transparent) {
            pass.push_debug_group(drawable.label);
            pass.set_pipeline(pipeline);
            self.draw_kind(pass, drawable.kind);
            pass.pop_debug_group();
        }
        self.draw_standard(pass, Step::Opaque, |finish| finish.opacity == Opacity::Opaque);
        self.draw_standard(pass, Step::Cut, Finish::is_cut);
        self.draw_standard(pass, Step::Outline, |finish| finish.has_outline && !finish.is_blended());
    }

    /// Corneas and what else is blended, from far to near.
    fn draw_blended(&self, pass: &mut wgpu::RenderPass<'_>) {
        let eye = self.scene.camera.eye();
        let corneas = self.renderer.picture.iter().find(|(drawable, _)| drawable.is_transparent);
        let Some((drawable, corneas)) = corneas else { return };
        pass.push_debug_group(drawable.label);
        let mut far = self.renderer.far_to_near.lock().unwrap_or_else(PoisonError::into_inner);
        for (avatar, part) in far.sort(self.avatars, eye) {
            let Some((model, state)) = self.avatars.get(avatar) else { continue };
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
            if sides.is_empty() {
                pass.set_pipeline(corneas);
                draw_part(pass, part, posed, state);
            }
        }
        pass.pop_debug_group();
    }

    /// One of the passes that draw into the picture: the first clears it, the last leaves it in the caller's
    /// view.
    pub(crate) fn begin_picture<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        pass: Pass,
        step: PictureStep,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        use wgpu::{LoadOp, StoreOp};
        let targets = self.targets;
        let is_first = matches!(step, PictureStep::Only | PictureStep::First);
        let is_last = matches!(step, PictureStep::Only | PictureStep::Last);
        let kept = |keep| if keep { StoreOp::Store } else { StoreOp::Discard };
        let (view, resolve_target, store) = match &targets.multisampled {
            Some(several) => (several, is_last.then_some(self.view), kept(!is_last)),
            None => (self.view, None, StoreOp::Store),
        };
        let load = if is_first { LoadOp::Clear(self.clear) } else { LoadOp::Load };
        // Depth is reversed: 0 is far.
        let depth_load = if is_first { LoadOp::Clear(0.0) } else { LoadOp::Load };
        let mut begun = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(pass.label()),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations { load, store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: Some(wgpu::Operations { load: depth_load, store: kept(!is_last) }),
                stencil_ops: None,
            }),
            timestamp_writes: timestamps,
            ..Default::default()
        });
        self.set_groups(&mut begun, &targets.for_picture);
        begun
    }

    pub(crate) fn begin<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        pass: Pass,
        color: Option<&wgpu::TextureView>,
        depth: Option<wgpu::RenderPassDepthStencilAttachment<'_>>,
    ) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(pass.label()),
            color_attachments: &[color.map(|view| wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: depth,
            timestamp_writes: self.timer.and_then(|timer| timer.render_pass(pass, Span::Whole)),
            ..Default::default()
        })
    }

    pub(crate) fn set_groups(&self, pass: &mut wgpu::RenderPass<'_>, view: &wgpu::BindGroup) {
        pass.set_bind_group(0, &self.renderer.resources.bind_group, &[self.frame_offset]);
        pass.set_bind_group(1, view, &[]);
    }

    /// The parts that are wanted, those of one model together.
    fn items<F: Fn(&ModelPart) -> bool + Copy + 'a>(&self, is_wanted: F) -> impl Iterator<Item = Item<'a>> {
        let of_group = move |group: &'a [(&'a AvatarModel, &'a AvatarState)]| {
            let parts = group.first().into_iter().flat_map(|(model, _)| model.parts_with_triangles());
            let wanted = parts.filter(move |(_, part)| is_wanted(part));
            wanted.flat_map(move |(index, part)| {
                group.iter().filter_map(move |(_, state)| Some((part, state.pose.parts.get(index)?, *state)))
            })
        };
        self.avatars.chunk_by(|(a, _), (b, _)| std::ptr::eq(*a, *b)).flat_map(of_group)
    }

    /// The parts of a face of this kind.
    fn draw_kind(&self, pass: &mut wgpu::RenderPass<'_>, kind: PartKind) {
        self.draw_items(pass, move |part| part.kind == kind && part.finish.get().is_none());
    }

    fn draw_items<F: Fn(&ModelPart) -> bool + Copy + 'a>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        is_wanted: F,
    ) {
        let mut bound: Option<&ModelPart> = None;
        for (part, posed, state) in self.items(is_wanted) {
            if !bound.is_some_and(|bound| std::ptr::eq(bound, part)) {
                bind_part(pass, part);
                bound = Some(part);
            }
            draw_part(pass, part, posed, state);
        }
    }

    /// Surfaces of interchange files that are wanted.
    fn draw_standard(&self, pass: &mut wgpu::RenderPass<'_>, step: Step, is_wanted: fn(Finish) -> bool) {
        let mut bound: Option<&ModelPart> = None;
        for (part, posed, state) in self.items(move |part| part.finish.get().is_some_and(is_wanted)) {
            if !bound.is_some_and(|bound| std::ptr::eq(bound, part)) {
                let sides = match step {
                    // Open sheets cast shadows, too.
                    Step::CutShadow => Sides::Both,
                    // Back sides that show beyond the front.
                    Step::Outline => Sides::Back,
                    _ => Sides::of(part.finish.get().is_some_and(|finish| finish.is_double_sided)),
                };
                pass.set_pipeline(self.standard(step, sides, part));
                bind_part(pass, part);
                bound = Some(part);
            }
            draw_part(pass, part, posed, state);
        }
    }

    fn standard(&self, step: Step, sides: Sides, part: &ModelPart) -> &'a wgpu::RenderPipeline {
        let renderer = self.renderer;
        renderer.standard.get(&renderer.layouts, renderer.config(), step, sides, part)
    }
}

/// Depth is reversed: 0 is far.
fn depth_attachment(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}

fn bind_part(pass: &mut wgpu::RenderPass<'_>, part: &ModelPart) {
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
