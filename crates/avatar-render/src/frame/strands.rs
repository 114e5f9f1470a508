//! Records the passes that draw strands.

use crate::avatar::model::AvatarModel;
use crate::avatar::state::AvatarState;
use crate::deform::pose::Pose;
use crate::frame::passes::{Pass, PictureStep};
use crate::frame::record::Recording;
use crate::frame::timer::Span;
use crate::gpu::ring::Reserved;
use crate::hair::detail::GpuHairView;
use crate::hair::pipelines::Strands;
use crate::hair::state::HairState;
use crate::view::camera::Camera;

/// Which strands of an avatar a pass draws that draws at most `most`; `None` without any.
pub(crate) fn strands_in_view<'a>(
    (model, state): (&AvatarModel, &'a AvatarState),
    camera: &Camera,
    pixels_per_unit: f32,
    most: f32,
) -> Option<(GpuHairView, &'a HairState)> {
    let (hair, grown) = model.hair.as_ref().zip(state.hair.as_ref())?;
    let skin = model.parts.get(hair.part)?;
    let distance = state.pose.center_of(&skin.geometry).distance(camera.eye());
    let head_pixels = model.height * pixels_per_unit / distance.max(1e-6);
    let view = state.hair_detail.view(hair.strand_count, head_pixels, most).with_pieces(hair.pieces);
    (view.count() > 0).then_some((view, grown))
}

/// The strands that a pass draws: at most `most` of each avatar.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawnStrands {
    most: f32,
    /// A [`GpuHairView`] for each head.
    views: Reserved,
}

impl<'a> Recording<'a> {
    /// The avatars with hair in view, and which of their strands are drawn if at most `most` are.
    fn with_hair(&self, most: f32) -> impl Iterator<Item = (GpuHairView, &'a HairState)> {
        let wanted = self.avatars.iter().filter(|(model, state)| self.concerns(model, state));
        wanted.filter_map(move |avatar| {
            strands_in_view(*avatar, &self.scene.camera, self.pixels_per_unit, most)
        })
    }

    /// How many strands of each avatar the picture shows.
    pub(crate) fn growing(&self) -> impl Iterator<Item = (&'a Pose, &'a HairState, u32)> + Clone {
        let wanted = self.avatars.iter().filter(|(model, state)| self.concerns(model, state));
        wanted.filter_map(|avatar| {
            let camera = &self.scene.camera;
            let (view, hair) = strands_in_view(*avatar, camera, self.pixels_per_unit, f32::INFINITY)?;
            Some((&avatar.1.pose, hair, view.count() as u32))
        })
    }

    /// Writes the uniforms of a pass that draws at most `most` strands of each head.
    fn choose_strands(&self, most: f32) -> DrawnStrands {
        let ring = &self.renderer.hair_views.ring;
        let views = ring.reserve(self.with_hair(most).count() as u32);
        for (head, (view, _)) in (0..).zip(self.with_hair(most)) {
            ring.write(self.queue, views, head, &view);
        }
        DrawnStrands { most, views }
    }

    fn draw_strands(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        drawn: DrawnStrands,
        is_wanted: fn(GpuHairView) -> bool,
    ) {
        let views = &self.renderer.hair_views;
        for (head, (view, hair)) in (0..).zip(self.with_hair(drawn.most)) {
            if !is_wanted(view) {
                continue;
            }
            pass.set_bind_group(2, &hair.draw, &[]);
            pass.set_bind_group(3, &views.group, &[views.ring.offset(drawn.views, head)]);
            pass.draw(0..view.corners(), 0..view.count() as u32);
        }
    }

    /// Draws the map of hair that the key lamp sees.
    pub(crate) fn hair_shadow(&self, encoder: &mut wgpu::CommandEncoder) {
        let Some(pipeline) = &self.renderer.hair().shadow else { return };
        let map = &self.renderer.resources.hair_map;
        let shadows = self.renderer.config().shading.terms().shadows;
        let mut pass = self.begin(encoder, Pass::HairShadow, Some(map), None);
        self.set_groups(&mut pass, &self.targets.hair.for_shadow);
        pass.set_pipeline(pipeline);
        self.draw_strands(&mut pass, self.choose_strands(shadows.strands()), |_| true);
    }

    /// Hair writes depth, so that corneas lie rightly before or behind it.
    pub(crate) fn strands(&self, encoder: &mut wgpu::CommandEncoder) {
        let (renderer, drawn) = (self.renderer, self.choose_strands(f32::INFINITY));
        let hair = || self.with_hair(drawn.most).map(|(view, _)| view);
        let (has_fine, has_draft) = (hair().any(GpuHairView::is_fine), hair().any(GpuHairView::is_draft));
        // Alone with the time of the pass: whatever comes first notes the start, whatever comes last the end.
        let span = |first, last| match (first, last) {
            (true, true) => Some(Span::Whole),
            (true, false) => Some(Span::Start),
            (false, true) => Some(Span::End),
            (false, false) => None,
        };
        if has_draft {
            let pipeline = renderer.hair().draft(&renderer.device);
            self.masked_strands(encoder, pipeline, drawn, GpuHairView::is_draft, span(true, !has_fine));
        }
        if !has_fine {
            return;
        }
        match renderer.hair().fine(&renderer.device) {
            Strands::Masked(pipeline) => {
                self.masked_strands(encoder, pipeline, drawn, GpuHairView::is_fine, span(!has_draft, true));
            }
            Strands::Layered { layers, slices, blended, compose } => {
                self.strand_layers(encoder, layers, drawn, span(!has_draft, false));
                self.strand_slices(encoder, slices, drawn);
                self.blended_strands(encoder, blended, drawn);
                let times = self.timer.and_then(|timer| timer.render_pass(Pass::Hair, Span::End));
                let mut pass = self.begin_picture(encoder, Pass::Hair, PictureStep::Between, times);
                pass.set_bind_group(1, &self.targets.hair.for_composing, &[]);
                for pipeline in compose {
                    pass.set_pipeline(pipeline);
                    pass.draw(0..3, 0..1);
                }
            }
        }
    }

    /// Draws strands that cover some of a pixel's samples.
    fn masked_strands(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::RenderPipeline,
        drawn: DrawnStrands,
        is_wanted: fn(GpuHairView) -> bool,
        span: Option<Span>,
    ) {
        let times = self.timer.zip(span).and_then(|(timer, span)| timer.render_pass(Pass::Hair, span));
        let mut pass = self.begin_picture(encoder, Pass::Hair, PictureStep::Between, times);
        pass.set_bind_group(1, &self.targets.hair.for_strands, &[]);
        pass.set_pipeline(pipeline);
        self.draw_strands(&mut pass, drawn, is_wanted);
    }

    /// Draws where strands lie in each pixel.
    fn strand_layers(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::RenderPipeline,
        drawn: DrawnStrands,
        span: Option<Span>,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("hair: layers"),
            color_attachments: &[cleared(&self.targets.hair.layers, wgpu::Color::TRANSPARENT)],
            depth_stencil_attachment: Some(self.depth_to_compare()),
            timestamp_writes: (self.timer.zip(span))
                .and_then(|(timer, span)| timer.render_pass(Pass::Hair, span)),
            ..Default::default()
        });
        self.set_groups(&mut pass, &self.targets.hair.for_shadow);
        pass.set_pipeline(pipeline);
        self.draw_strands(&mut pass, drawn, GpuHairView::is_fine);
    }

    /// Draws how much strands cover at each depth.
    fn strand_slices(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::RenderPipeline,
        drawn: DrawnStrands,
    ) {
        let targets = self.targets;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("hair: slices"),
            color_attachments: &targets
                .hair
                .slices
                .each_ref()
                .map(|view| cleared(view, wgpu::Color::TRANSPARENT)),
            depth_stencil_attachment: Some(self.depth_to_compare()),
            ..Default::default()
        });
        self.set_groups(&mut pass, &targets.hair.for_slices);
        pass.set_pipeline(pipeline);
        self.draw_strands(&mut pass, drawn, GpuHairView::is_fine);
    }

    /// The depth of opaque parts, for comparing only.
    fn depth_to_compare(&self) -> wgpu::RenderPassDepthStencilAttachment<'a> {
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.targets.depth,
            depth_ops: None,
            stencil_ops: None,
        }
    }

    fn blended_strands(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::RenderPipeline,
        drawn: DrawnStrands,
    ) {
        let targets = self.targets;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("hair: blended"),
            color_attachments: &[
                cleared(&targets.hair.sum, wgpu::Color::TRANSPARENT),
                cleared(&targets.hair.clear, wgpu::Color::WHITE),
            ],
            depth_stencil_attachment: Some(self.depth_to_compare()),
            ..Default::default()
        });
        self.set_groups(&mut pass, &targets.hair.for_strands);
        pass.set_pipeline(pipeline);
        self.draw_strands(&mut pass, drawn, GpuHairView::is_fine);
    }
}

fn cleared(view: &wgpu::TextureView, color: wgpu::Color) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(color), store: wgpu::StoreOp::Store },
    })
}
