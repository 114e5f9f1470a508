//! Opening a GPU, and pictures without a window.

mod canvas;
mod gpu;

#[cfg(not(target_arch = "wasm32"))]
pub use canvas::render_image;
pub use canvas::{Canvas, RenderImageError};
pub use gpu::{Gpu, GpuErrors, GpuOptions, NoAdapter, open, open_for_surface};
#[cfg(not(target_arch = "wasm32"))]
pub use gpu::{open_blocking, open_for_surface_blocking};
