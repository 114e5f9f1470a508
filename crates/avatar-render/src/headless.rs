//! Opening a GPU, and pictures without a window.

use crate::color::{linear_table, srgb8_from_linear};
use crate::readback::{ReadbackError, mapped};
use crate::{
    AvatarModel, AvatarState, DrawError, Image, Renderer, RendererConfig, RendererError, Scene, SizeError,
    Targets,
};

/// An opened GPU.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// Where surfaces come from.
    pub instance: wgpu::Instance,
    /// The chosen adapter.
    pub adapter: wgpu::Adapter,
    /// Its device, with WebGPU's default limits and no optional features.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Name, kind and driver of the adapter.
    pub info: wgpu::AdapterInfo,
}

/// Which adapters to consider.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GpuOptions {
    /// Graphics interfaces to look for adapters of.
    pub backends: wgpu::Backends,
    /// Only software adapters.
    pub software: bool,
}

impl Default for GpuOptions {
    /// Everything that this build knows; hardware is preferred, software accepted.
    fn default() -> Self {
        Self { backends: wgpu::Instance::enabled_backend_features(), software: false }
    }
}

/// Why there is no GPU.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoAdapter {
    /// Nothing was found.
    #[error("expected a GPU adapter ({looked_for}), found none: {reason}")]
    NotFound {
        /// What was looked for.
        looked_for: String,
        /// What wgpu says.
        reason: String,
    },
    /// The adapter has less than WebGPU promises.
    #[error("adapter {adapter:?}: expected {limit} of {expected}, as WebGPU promises, found {found}")]
    Limit {
        /// Name of the adapter.
        adapter: String,
        /// Name of the limit.
        limit: &'static str,
        /// WebGPU's default.
        expected: u64,
        /// What the adapter has.
        found: u64,
    },
    /// The adapter gives no device.
    #[error("adapter {adapter:?}: expected a device, found: {reason}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// What wgpu says.
        reason: String,
    },
}

/// Opens the best adapter, hardware before software.
///
/// # Errors
/// No adapter, or one with less than WebGPU's default limits.
pub async fn open(options: GpuOptions) -> Result<Gpu, NoAdapter> {
    // wgpu panics without a backend.
    if wgpu::Instance::enabled_backend_features().is_empty() {
        let reason = "this build has no backend for this platform".to_owned();
        return Err(NoAdapter::NotFound { looked_for: looked_for(options, false), reason });
    }
    let descriptor = wgpu::InstanceDescriptor {
        backends: options.backends,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    };
    open_with(wgpu::Instance::new(descriptor), options, None).await
}

/// Opens the best adapter that can show pictures on a surface of this instance.
///
/// # Errors
/// As [`open()`].
pub async fn open_for_surface(
    instance: wgpu::Instance,
    surface: &wgpu::Surface<'_>,
    options: GpuOptions,
) -> Result<Gpu, NoAdapter> {
    open_with(instance, options, Some(surface)).await
}

/// [`open()`] for callers without an executor.
///
/// # Errors
/// As [`open()`].
#[cfg(not(target_arch = "wasm32"))]
pub fn open_blocking(options: GpuOptions) -> Result<Gpu, NoAdapter> {
    crate::readback::block_on(open(options))
}

/// [`open_for_surface()`] for callers without an executor.
///
/// # Errors
/// As [`open()`].
#[cfg(not(target_arch = "wasm32"))]
pub fn open_for_surface_blocking(
    instance: wgpu::Instance,
    surface: &wgpu::Surface<'_>,
    options: GpuOptions,
) -> Result<Gpu, NoAdapter> {
    crate::readback::block_on(open_for_surface(instance, surface, options))
}

fn looked_for(options: GpuOptions, for_surface: bool) -> String {
    let kind = if options.software { "software" } else { "hardware or software" };
    let purpose = if for_surface { " that presents to the window" } else { "" };
    let backends: Vec<_> = options.backends.iter_names().map(|(name, _)| name.to_lowercase()).collect();
    format!("{kind}{purpose}, through {}", backends.join(", "))
}

async fn open_with(
    instance: wgpu::Instance,
    options: GpuOptions,
    surface: Option<&wgpu::Surface<'_>>,
) -> Result<Gpu, NoAdapter> {
    let request = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        force_fallback_adapter: options.software,
        compatible_surface: surface,
        ..Default::default()
    };
    let adapter = instance.request_adapter(&request).await.map_err(|error| NoAdapter::NotFound {
        looked_for: looked_for(options, surface.is_some()),
        reason: error.to_string(),
    })?;
    let info = adapter.get_info();
    let mut missing = None;
    wgpu::Limits::default().check_limits_with_fail_fn(&adapter.limits(), true, |limit, expected, found| {
        missing = Some(NoAdapter::Limit { adapter: info.name.clone(), limit, expected, found });
    });
    if let Some(missing) = missing {
        return Err(missing);
    }
    let descriptor = wgpu::DeviceDescriptor { label: Some("avatars"), ..Default::default() };
    let (device, queue) = adapter
        .request_device(&descriptor)
        .await
        .map_err(|error| NoAdapter::NoDevice { adapter: info.name.clone(), reason: error.to_string() })?;
    Ok(Gpu { instance, adapter, device, queue, info })
}

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
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
    pub fn new(gpu: &Gpu, width: u32, height: u32, samples: u32) -> Result<Self, RenderImageError> {
        let device = &gpu.device;
        let renderer = Renderer::new(device, RendererConfig { color_format: FORMAT, samples })?;
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
        let view = color.create_view(&Default::default());
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
        crate::readback::block_on(self.render_async(gpu, scene, avatars))
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
        let (width, height) = self.targets.size();
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("picture") });
        self.renderer.draw(&mut encoder, &self.view, &self.targets, &gpu.queue, scene, avatars)?;
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
        let view = mapped(&gpu.device, &self.readable).await?;
        let rows = view.chunks_exact(self.row_bytes as usize);
        let pixels = rows.flat_map(|row| row.chunks_exact(4).take(width as usize));
        let rgba = pixels.flat_map(|p| straight_from_premultiplied([p[0], p[1], p[2], p[3]])).collect();
        drop(view);
        self.readable.unmap();
        Ok(Image { width, height, rgba })
    }
}

/// Draws one picture: straight alpha, sRGB. Two calls with equal arguments give equal bytes on one machine.
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
    Canvas::new(gpu, width, height, samples)?.render(gpu, scene, avatars)
}

/// The target holds colours times alpha, encoded after the product.
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
