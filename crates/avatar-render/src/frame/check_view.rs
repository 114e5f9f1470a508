//! Lets the device check the format of a view, since the view itself does not reveal it.

use crate::frame::draw::DrawError;
use crate::frame::renderer::Renderer;
use crate::frame::targets::Targets;
use crate::model::effects::Effects;

impl Renderer {
    /// Checks that [`Renderer::draw`] can draw into this view. `draw` checks everything that wgpu tells of a
    /// view, which is all but its format: a view in the sRGB twin of the renderer's format passes there, and
    /// becomes an error of the device when the encoder is finished, which panics unless the program listens
    /// for such errors. This method lets the device try, without drawing anything. Call it once for each way
    /// in which a program makes views.
    ///
    /// # Errors
    /// A view or targets that do not belong to this renderer.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn check_view(
        &self,
        device: &wgpu::Device,
        view: &wgpu::TextureView,
        targets: &Targets,
    ) -> Result<(), DrawError> {
        pollster::block_on(self.check_view_async(device, view, targets))
    }

    /// The same, for callers that cannot block.
    ///
    /// # Errors
    /// As above.
    pub async fn check_view_async(
        &self,
        device: &wgpu::Device,
        view: &wgpu::TextureView,
        targets: &Targets,
    ) -> Result<(), DrawError> {
        self.check(view, targets, &[])?;
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let mut encoder =
            device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("check a view") });
        let (color, resolve_target) = match &targets.multisampled {
            Some(several) => (several, Some(view)),
            None => (view, None),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("check a view"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: color,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        if let Some(pipeline) = self.parts.in_picture(&self.layouts, 0, Effects::NONE) {
            pass.set_pipeline(pipeline);
        }
        drop(pass);
        // Never submitted.
        drop(encoder.finish());
        match scope.pop().await {
            None => Ok(()),
            Some(_) => Err(DrawError::ViewFormat {
                format: self.config().color_format,
                texture_format: view.texture().format(),
            }),
        }
    }
}
