use super::stirring::Change;
use crate::cli::Size;
use crate::look_args::LookArgs;
use avatar_pack::{FaceState, Pack};
use avatar_render::Scene;
use avatar_stage::View;
use glam::{Affine3A, Vec2};

/// What a frame shows.
pub(super) struct Shot<'a> {
    pub(super) pack: &'a Pack,
    pub(super) state: &'a FaceState,
    pub(super) view: View,
    pub(super) background: [u8; 4],
    /// Left, top, right and bottom of what the panel leaves, in pixels; `None` for the whole window.
    pub(super) free: Option<[f32; 4]>,
}

impl Shot<'_> {
    /// The scene of a picture of this size.
    pub(super) fn scene(&self, width: u32, height: u32, look: &LookArgs) -> Scene {
        let whole = Vec2::new(width as f32, height as f32);
        let (min, max) = match self.free {
            Some([left, top, right, bottom]) => (Vec2::new(left, top), Vec2::new(right, bottom).min(whole)),
            None => (Vec2::ZERO, whole),
        };
        let free = (max - min).max(Vec2::ONE);
        let size = Size { width: free.x as u32, height: free.y as u32 };
        let mut scene = self.view.scene(self.pack, size.aspect(), self.background, look.light());
        // Not even by rounding: where nothing covers it, the picture is the one of `render`.
        if (min, max) != (Vec2::ZERO, whole) {
            scene.camera = scene.camera.within(whole, min, max);
        }
        scene
    }
}

/// A picture of the face, with the bones, weights and view that it shows.
pub(super) struct Kept {
    pub(super) texture: wgpu::Texture,
    bones: Vec<Affine3A>,
    weights: Vec<f32>,
    view: View,
    background: [u8; 4],
    free: Option<[f32; 4]>,
    /// Whether it shows what the model, its looks and its hair are now.
    pub(super) is_fresh: bool,
    /// Whether parts of it have been drawn later than the rest.
    is_patched: bool,
}

impl Kept {
    /// Whether it shows the same from the same place, whatever the face does.
    pub(super) fn shows_view(&self, shot: &Shot<'_>) -> bool {
        self.is_fresh
            && self.view == shot.view
            && self.background == shot.background
            && self.free == shot.free
    }

    /// Whether nobody could tell its face from that of the shot, of which so much has changed.
    pub(super) fn shows(&self, shot: &Shot<'_>, change: Change) -> bool {
        let is_posed = || self.weights == shot.state.weights() && self.bones == shot.state.bones();
        change == Change::Nothing || (is_posed() && (change != Change::Any || !self.is_patched))
    }

    /// The shot has been drawn: all of it, or a part over what was there.
    pub(super) fn note(&mut self, shot: &Shot<'_>, is_part: bool) {
        self.is_patched = is_part;
        self.bones.clear();
        self.bones.extend_from_slice(shot.state.bones());
        self.weights.clear();
        self.weights.extend_from_slice(shot.state.weights());
        (self.view, self.background, self.free) = (shot.view, shot.background, shot.free);
        self.is_fresh = true;
    }
}

/// A picture to keep, with nothing on it yet.
pub(super) fn kept(device: &wgpu::Device, config: &wgpu::SurfaceConfiguration, shot: &Shot<'_>) -> Kept {
    let size = wgpu::Extent3d { width: config.width, height: config.height, depth_or_array_layers: 1 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("kept picture"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: config.format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let (view, background, free) = (shot.view, shot.background, shot.free);
    Kept {
        texture,
        bones: Vec::new(),
        weights: Vec::new(),
        view,
        background,
        free,
        is_fresh: false,
        is_patched: false,
    }
}
