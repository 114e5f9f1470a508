//! Frames in motion that are drawn small and shown larger.

use crate::pace::Step;
use avatar_render::wgpu::util::{TextureBlitter, TextureBlitterBuilder};
use avatar_render::{
    AvatarModel, AvatarState, DrawError, PassTimer, Renderer, RendererConfig, RendererError, Scene, Shading,
    Shadows, SizeError, Targets, Terms, wgpu,
};

/// Why there is no draft.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DraftError {
    /// A format that cannot be drawn.
    #[error(transparent)]
    Renderer(#[from] RendererError),
    /// A size that the device cannot draw.
    #[error(transparent)]
    Size(#[from] SizeError),
    /// Avatars that do not fit their models.
    #[error(transparent)]
    Draw(#[from] DrawError),
}

/// Draws frames with less care than the whole picture ([`Step`]): one sample a pixel, fewer pixels, at most
/// the terms of [`Terms::LOW`]. What it needs is made when it is first needed.
#[derive(Debug)]
pub struct Drafts {
    format: wgpu::TextureFormat,
    shading: Shading,
    /// One for each shading that was needed.
    renderers: Vec<Renderer>,
    picture: Option<Picture>,
    enlarging: TextureBlitter,
}

#[derive(Debug)]
struct Picture {
    view: wgpu::TextureView,
    targets: Targets,
    shading: Shading,
}

impl Drafts {
    /// Drafts for targets of this format, of pictures that have this shading at rest.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat, shading: Shading) -> Self {
        let enlarging =
            TextureBlitterBuilder::new(device, format).sample_type(wgpu::FilterMode::Linear).build();
        Self { format, shading, renderers: Vec::new(), picture: None, enlarging }
    }

    /// Records a draft of a picture of this size. Returns whether all of what draws it was there before: the
    /// time of a frame for which something had to be compiled tells nothing about the next.
    ///
    /// Hair is drawn as the avatar's [`HairDetail`](avatar_render::HairDetail) says: set
    /// [`draft`](avatar_render::HairDetail::draft) to the step's strands before.
    ///
    /// # Errors
    /// A format or size that cannot be drawn, avatars that do not fit their models.
    #[allow(clippy::too_many_arguments, reason = "those of `Renderer::draw_timed`")]
    pub fn draw(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        step: Step,
        size: (u32, u32),
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
        timer: Option<&PassTimer>,
    ) -> Result<bool, DraftError> {
        let (picture, renderer, mut was_there) = self.made(gpu, step, size)?;
        was_there &= renderer.is_ready(scene, avatars);
        let Picture { view, targets, .. } = picture;
        renderer.draw_timed(encoder, view, targets, gpu.1, scene, avatars, timer)?;
        Ok(was_there)
    }

    /// Records a draft that is not to be shown, and another one by the programs that show wrinkles
    /// ([`Renderer::rehearse`]), so that nothing has to be compiled in the middle of a motion.
    ///
    /// # Errors
    /// As [`Drafts::draw`].
    pub fn rehearse(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        step: Step,
        size: (u32, u32),
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) -> Result<(), DraftError> {
        let (Picture { view, targets, .. }, renderer, _) = self.made(gpu, step, size)?;
        renderer.draw(encoder, view, targets, gpu.1, scene, avatars)?;
        Ok(renderer.rehearse(encoder, view, targets, gpu.1, scene, avatars)?)
    }

    /// What draws a draft, and whether it was there before.
    fn made(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        step: Step,
        size: (u32, u32),
    ) -> Result<(&Picture, &Renderer, bool), DraftError> {
        let shading = of_draft(self.shading, step);
        let (place, mut was_there) = self.place(gpu, shading)?;
        let renderer = &self.renderers[place];
        let size = step.size(size);
        let fits = |picture: &Picture| picture.targets.size() == size && picture.shading == shading;
        let picture = match self.picture.take().filter(fits) {
            Some(picture) => picture,
            None => {
                was_there = false;
                let targets = Targets::new(gpu.0, renderer, size.0, size.1)?;
                Picture { view: picture_to_show(gpu.0, "draft", self.format, size), targets, shading }
            }
        };
        Ok((self.picture.insert(picture), renderer, was_there))
    }

    /// Builds what draws drafts of this care, unless it is there.
    ///
    /// # Errors
    /// A format that cannot be drawn.
    pub fn prepare(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        step: Step,
    ) -> Result<&Renderer, DraftError> {
        let (place, _) = self.place(gpu, of_draft(self.shading, step))?;
        Ok(&self.renderers[place])
    }

    /// Where the renderer of this shading is, and whether it was there before.
    fn place(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        shading: Shading,
    ) -> Result<(usize, bool), DraftError> {
        let found = self.renderers.iter().position(|renderer| renderer.config().shading == shading);
        if let Some(place) = found {
            return Ok((place, true));
        }
        let config = RendererConfig { color_format: self.format, samples: 1, shading };
        self.renderers.push(Renderer::new(device, queue, config)?);
        Ok((self.renderers.len() - 1, false))
    }

    /// Records that the last draft is shown on a target of any size, of the format given to [`Drafts::new`].
    /// Without a draft nothing happens.
    pub fn show(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
    ) {
        if let Some(picture) = &self.picture {
            self.enlarging.copy(device, encoder, &picture.view, target);
        }
    }
}

impl Step {
    /// The size of the draft of a picture of this size: never larger, and not empty.
    pub fn size(self, (width, height): (u32, u32)) -> (u32, u32) {
        let shorter = width.min(height).max(1);
        let most = self.shorter_side.clamp(1, shorter);
        let scaled = |side: u32| (f64::from(side) * f64::from(most) / f64::from(shorter)).round() as u32;
        (scaled(width).max(1), scaled(height).max(1))
    }
}

/// The shading of drafts of pictures that have this one.
fn of_draft(shading: Shading, step: Step) -> Shading {
    match shading {
        // Cartoons are what they are by their shadows.
        Shading::Plain | Shading::Toon => shading,
        Shading::Natural(_) if step.is_plain => Shading::Plain,
        Shading::Natural(terms) => {
            let shadows = match step.has_shadows && terms.shadows != Shadows::Off {
                true => Terms::LOW.shadows,
                false => Shadows::Off,
            };
            Shading::Natural(Terms { shadows, eye_optics: terms.eye_optics, ..Terms::NONE })
        }
    }
}

/// A picture that is drawn on, and then shown elsewhere.
pub(crate) fn picture_to_show(
    device: &wgpu::Device,
    label: &str,
    format: wgpu::TextureFormat,
    size: (u32, u32),
) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size.0, height: size.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor { label: Some(label), ..Default::default() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pace::Pace;

    #[test]
    fn drafts_keep_the_shape_of_the_picture_and_are_never_larger() {
        let step = |shorter_side| Step { shorter_side, ..Pace::STEPS[0] };
        assert_eq!(step(360).size((1280, 720)), (640, 360));
        assert_eq!(step(360).size((720, 1280)), (360, 640));
        assert_eq!(step(180).size((3840, 2160)), (320, 180));
        assert_eq!(step(720).size((160, 120)), (160, 120));
        assert_eq!(step(0).size((40, 10)), (4, 1));
        assert_eq!(step(1).size((1, 1)), (1, 1));
        assert_eq!(step(180).size((0, 0)), (1, 1));
        assert_eq!(step(u32::MAX).size((u32::MAX, 1)), (u32::MAX, 1));
    }

    #[test]
    fn drafts_have_no_terms_that_the_picture_lacks() {
        let shaded = |shading, has_shadows| of_draft(shading, Step { has_shadows, ..Pace::STEPS[0] });
        assert_eq!(shaded(Shading::Plain, true), Shading::Plain);
        assert_eq!(shaded(Shading::Toon, false), Shading::Toon);
        assert_eq!(shaded(Shading::Natural(Terms::HIGH), true), Shading::Natural(Terms::LOW));
        let dark = Shading::Natural(Terms { shadows: Shadows::Off, ..Terms::LOW });
        assert_eq!(shaded(Shading::Natural(Terms::LOW), false), dark);
        assert_eq!(shaded(dark, true), dark);
        assert_eq!(shaded(Shading::Natural(Terms::NONE), true), Shading::Natural(Terms::NONE));
        assert_eq!(of_draft(Shading::Natural(Terms::LOW), Pace::FIRST), Shading::Plain);
        assert_eq!(of_draft(Shading::Toon, Pace::FIRST), Shading::Toon);
    }
}
