//! A part of the picture, drawn anew on the picture that is kept: where eyes blink, the rest of the face need
//! not be drawn again.

use super::Stage;
use anyhow::Result;
use avatar_render::{Scene, Targets};
use glam::Vec2;

/// Sides of patches are multiples of this, so that one may follow another of nearly the same size.
const STEP: u32 = 32;

/// Room for a part of the picture.
pub(super) struct Patch {
    texture: wgpu::Texture,
    targets: Targets,
}

impl Stage {
    /// Records what the scene shows in a rectangle of the window (left, top, width and height in pixels), on
    /// the picture that is kept.
    pub(super) fn draw_patch(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene,
        rect: [u32; 4],
    ) -> Result<()> {
        let whole = (self.config.width, self.config.height);
        let [left, top, width, height] = widened(rect, whole);
        let Some(kept) = &self.kept else { return Ok(()) };
        let patch = match self.patch.take().filter(|patch| patch.targets.size() == (width, height)) {
            Some(patch) => patch,
            None => {
                let texture = self.gpu.device.create_texture(&wgpu::TextureDescriptor {
                    label: Some("patch"),
                    size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format: self.config.format,
                    usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                    view_formats: &[],
                });
                let targets = Targets::new(&self.gpu.device, &self.renderer, width, height)?;
                Patch { texture, targets }
            }
        };
        let Patch { texture, targets } = self.patch.insert(patch);
        let (min, size) = (Vec2::new(left as f32, top as f32), Vec2::new(width as f32, height as f32));
        let all = Vec2::new(whole.0 as f32, whole.1 as f32);
        let scene = Scene { camera: scene.camera.part(all, min, min + size), ..*scene };
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.avatar.set_hair_detail(self.look.hair_detail(&self.gpu.info));
        let avatars = [(&self.model, &self.avatar)];
        self.renderer.draw_timed(encoder, &view, targets, &self.gpu.queue, &scene, &avatars, None)?;
        let mut to = kept.texture.as_image_copy();
        to.origin = wgpu::Origin3d { x: left, y: top, z: 0 };
        encoder.copy_texture_to_texture(texture.as_image_copy(), to, texture.size());
        Ok(())
    }
}

/// The rectangle with sides of whole steps, within a picture of this size.
fn widened([left, top, width, height]: [u32; 4], (all_across, all_down): (u32, u32)) -> [u32; 4] {
    let wide = |from: u32, side: u32, all: u32| {
        let side = side.max(1).next_multiple_of(STEP).min(all);
        (from.min(all - side), side)
    };
    let ((left, width), (top, height)) = (wide(left, width, all_across), wide(top, height, all_down));
    [left, top, width, height]
}

#[cfg(test)]
mod tests {
    use super::widened;

    #[test]
    fn patches_enclose_what_they_are_for_and_lie_in_the_picture() {
        assert_eq!(widened([100, 50, 70, 32], (640, 360)), [100, 50, 96, 32]);
        assert_eq!(widened([600, 350, 40, 10], (640, 360)), [576, 328, 64, 32]);
        assert_eq!(widened([0, 0, 640, 360], (640, 360)), [0, 0, 640, 360]);
        assert_eq!(widened([5, 5, 3, 3], (20, 10)), [0, 0, 20, 10]);
    }
}
