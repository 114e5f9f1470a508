//! Pictures of one size.

use crate::avatar::crowd::AvatarCrowd;
use crate::avatar::model::AvatarModel;
use crate::avatar::state::AvatarState;
use crate::frame::draw::DrawError;
use crate::frame::renderer::{Renderer, RendererError};
use crate::frame::targets::{SizeError, Targets};
use crate::gpu::color::{linear_table, srgb8_from_linear};
use crate::gpu::device::Gpu;
use crate::gpu::image::Image;
use crate::gpu::readback::{ReadbackError, mapped};
use crate::view::config::RendererConfig;
use crate::view::scene::Scene;
use crate::view::shading::Shading;
#[cfg(not(target_arch = "wasm32"))]
use crate::view::shading::{Quality, Style};

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderImageError {
    /// A size that cannot be drawn.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// A number of samples that cannot be drawn.
    #[error(transparent)]
    Renderer(#[from] RendererError),
    /// Avatars that do not fit together.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// The picture did not come back.
    #[error(transparent)]
    Readback(#[from] ReadbackError),
    /// The device reported an error, for example that memory ran out.
    #[error("expected a picture, found an error of the device: {reason}")]
    Device {
        /// What wgpu says.
        reason: String,
    },
}

/// Format of pictures: 8 bits, encoded by the hardware.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Everything that pictures of one size share; build it once for many pictures.
#[derive(Debug)]
pub struct Canvas {
    renderer: Renderer,
    targets: Targets,
    color: wgpu::Texture,
    view: wgpu::TextureView,
    readable: wgpu::Buffer,
    row_bytes: u32,
}

impl Canvas {
    /// Room for pictures of this size.
    ///
    /// # Errors
    /// A size or number of samples that the device cannot draw.
    pub fn new(
        gpu: &Gpu,
        width: u32,
        height: u32,
        samples: u32,
        shading: Shading,
    ) -> Result<Self, RenderImageError> {
        let device = &gpu.device;
        let config = RendererConfig { color_format: FORMAT, samples, shading };
        let renderer = Renderer::new(device, &gpu.queue, config)?;
        let targets = Targets::new(device, &renderer, width, height)?;
        let color = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view =
            color.create_view(&wgpu::TextureViewDescriptor { label: Some("picture"), ..Default::default() });
        let row_bytes = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let readable = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture: readable"),
            size: u64::from(row_bytes) * u64::from(height),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Ok(Self { renderer, targets, color, view, readable, row_bytes })
    }

    /// Draws a picture and waits for it.
    ///
    /// # Errors
    /// Avatars that do not fit together, or a lost device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn render(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) -> Result<Image, RenderImageError> {
        pollster::block_on(self.render_async(gpu, scene, avatars))
    }

    /// The same, for callers that cannot block.
    ///
    /// # Errors
    /// As above.
    pub async fn render_async(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) -> Result<Image, RenderImageError> {
        self.render_crowds_async(gpu, scene, avatars, &mut []).await
    }

    /// Draws a picture with crowds beside the other avatars, and waits for it.
    ///
    /// # Errors
    /// Avatars or crowds that do not fit together, or a lost device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn render_crowds(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
        crowds: &mut [(&AvatarModel, &mut AvatarCrowd)],
    ) -> Result<Image, RenderImageError> {
        pollster::block_on(self.render_crowds_async(gpu, scene, avatars, crowds))
    }

    /// The same, for callers that cannot block.
    ///
    /// # Errors
    /// As above.
    pub async fn render_crowds_async(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
        crowds: &mut [(&AvatarModel, &mut AvatarCrowd)],
    ) -> Result<Image, RenderImageError> {
        self.submit_crowds(gpu, scene, avatars, crowds)?;
        let picture = self.read(gpu).await;
        if picture.is_err() {
            // Whether a picture that failed deformed them is not known.
            avatars.iter().for_each(|(_, avatar)| avatar.redo());
            crowds.iter_mut().for_each(|(_, crowd)| crowd.redo());
        }
        picture
    }

    /// Begins a picture, for callers that cannot keep the avatars while they wait for it: [`Self::read`] is
    /// to follow. If that fails, call [`AvatarState::redo`].
    ///
    /// # Errors
    /// Avatars that do not fit together.
    pub fn submit(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) -> Result<(), RenderImageError> {
        self.submit_crowds(gpu, scene, avatars, &mut [])
    }

    fn submit_crowds(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
        crowds: &mut [(&AvatarModel, &mut AvatarCrowd)],
    ) -> Result<(), RenderImageError> {
        let (_, height) = self.targets.size();
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("picture") });
        let (view, targets) = (&self.view, &self.targets);
        self.renderer.draw_crowds(&mut encoder, view, targets, &gpu.queue, scene, avatars, crowds, None)?;
        encoder.copy_texture_to_buffer(
            self.color.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &self.readable,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(self.row_bytes),
                    rows_per_image: Some(height),
                },
            },
            self.color.size(),
        );
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Waits for the picture that was submitted last.
    ///
    /// # Errors
    /// A lost device, or what it complained about.
    pub async fn read(&self, gpu: &Gpu) -> Result<Image, RenderImageError> {
        let (width, height) = self.targets.size();
        let view = mapped(&gpu.device, &self.readable).await?;
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        for row in view.chunks_exact(self.row_bytes as usize) {
            let row = row.as_chunks::<4>().0.iter().take(width as usize);
            pixels.extend(row.map(|pixel| straight_from_premultiplied(*pixel)));
        }
        let rgba = pixels.into_flattened();
        drop(view);
        self.readable.unmap();
        match gpu.errors.take() {
            Some(reason) => Err(RenderImageError::Device { reason }),
            None => Ok(Image { width, height, rgba }),
        }
    }
}

/// Draws one picture: straight alpha, sRGB, in the best quality that the adapter draws smoothly. Two calls
/// with equal arguments give equal bytes on one machine.
///
/// # Errors
/// A size, samples or avatars that cannot be drawn, or a lost device.
#[cfg(not(target_arch = "wasm32"))]
pub fn render_image(
    gpu: &Gpu,
    width: u32,
    height: u32,
    samples: u32,
    scene: &Scene,
    avatars: &[(&AvatarModel, &AvatarState)],
) -> Result<Image, RenderImageError> {
    let shading = Quality::of_adapter(&gpu.info).shading(Style::Natural);
    Canvas::new(gpu, width, height, samples, shading)?.render(gpu, scene, avatars)
}

/// Straight alpha from a pixel of the target, which holds colours times alpha, encoded after the
/// multiplication.
fn straight_from_premultiplied(pixel: [u8; 4]) -> [u8; 4] {
    let [r, g, b, a] = pixel;
    match a {
        0 => [0; 4],
        255 => pixel,
        a => {
            let alpha = f32::from(a) / 255.0;
            let straight = |byte: u8| srgb8_from_linear(linear_table()[usize::from(byte)] / alpha);
            [straight(r), straight(g), straight(b), a]
        }
    }
}
