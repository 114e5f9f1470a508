//! Opening a GPU, and pictures without a window.

mod canvas;

pub use crate::gpu::device::{Gpu, GpuErrors, GpuOptions, NoAdapter, open, open_for_surface};
#[cfg(not(target_arch = "wasm32"))]
pub use crate::gpu::device::{open_blocking, open_for_surface_blocking};
#[cfg(not(target_arch = "wasm32"))]
pub use canvas::render_image;
pub use canvas::{Canvas, RenderImageError};
