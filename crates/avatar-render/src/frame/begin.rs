//! Begins the passes of a frame.

use crate::frame::passes::{Pass, PictureStep};
use crate::frame::record::Recording;
use crate::frame::timer::Span;

impl<'a> Recording<'a> {
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
}
