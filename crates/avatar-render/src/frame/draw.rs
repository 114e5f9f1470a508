//! Draws frames.

use crate::avatar::crowd::AvatarCrowd;
use crate::avatar::model::AvatarModel;
use crate::avatar::state::AvatarState;
use crate::frame::passes::{FRAME_PASSES, Pass};
use crate::frame::record::Recording;
use crate::frame::renderer::Renderer;
use crate::frame::sight::Sight;
use crate::frame::strands::strands_in_view;
use crate::frame::targets::Targets;
use crate::frame::timer::PassTimer;
use crate::gpu::color::srgb_from_linear;
use crate::hair::pipelines::MOST_HEADS;
use crate::view::scene::Scene;
use crate::view::seen::{Frustum, Seen};
use crate::view::shadows::{GpuShadowView, ShadowViews};
use crate::view::uniforms::{GpuFrame, pixels_per_unit};

/// Why a frame was not drawn. Nothing was recorded then.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawError {
    /// The state of another model, or one from before the model got its present hair.
    #[error("avatar {avatar}: expected the state of its model, found that of another one")]
    StateOfAnotherModel {
        /// Position in the slice of avatars.
        avatar: usize,
    },
    /// A crowd of another model.
    #[error("crowd {crowd}: expected the crowd of its model, found that of another one")]
    CrowdOfAnotherModel {
        /// Position in the slice of crowds.
        crowd: usize,
    },
    /// More heads of hair than one frame can hold.
    #[error("expected at most {limit} avatars with hair in view, found {found}")]
    TooManyHeads {
        /// Avatars with hair of which strands would be drawn.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
    /// Targets that were made for another renderer.
    #[error("expected targets made for this renderer, found those of another one")]
    TargetsOfAnotherRenderer,
    /// A view that cannot be drawn into with these targets.
    #[error(
        "expected a single-sampled view of {width}×{height} pixels in {format:?} that can be drawn into, found {found_width}×{found_height} in {found_format:?}"
    )]
    View {
        /// Width of the targets.
        width: u32,
        /// Height of the targets.
        height: u32,
        /// Format of the renderer.
        format: wgpu::TextureFormat,
        /// Width of the view's texture.
        found_width: u32,
        /// Height of the view's texture.
        found_height: u32,
        /// Format of the view's texture.
        found_format: wgpu::TextureFormat,
    },
    /// A view in another format than the renderer's, or of a mip level of another size than the targets, as
    /// [`Renderer::check_view`] found.
    #[error(
        "expected a view in {format:?} of the targets' size, found one that does not fit, of a texture in {texture_format:?}"
    )]
    ViewFormat {
        /// Format of the renderer.
        format: wgpu::TextureFormat,
        /// Format of the view's texture.
        texture_format: wgpu::TextureFormat,
    },
}

impl Renderer {
    /// Records one frame: clears `view`, then draws all avatars. Colours are premultiplied by alpha in the
    /// view.
    ///
    /// Shadow maps are fitted around the avatars in the picture, except for those that look less than an
    /// eighth as large as the largest; outside of the map nothing casts shadows. All avatars between a lamp
    /// and the map cast shadows, in the picture or not. The softness of shadows and the reach of ambient
    /// occlusion follow from the height of the avatar that looks largest.
    ///
    /// An avatar that has not moved since the last frame is not deformed again, nor does its hair grow again
    /// if it does not swing either. One of which the picture shows neither itself nor its shadow is neither
    /// deformed, grown nor drawn. A frame takes what it deforms for deformed: submit what was recorded, in
    /// the order of recording. If an encoder is dropped instead, call [`AvatarState::redo`] of its avatars,
    /// which otherwise show the pose before until they move. Hair of an avatar that was out of
    /// view for more than half a second hangs still when it comes back.
    ///
    /// Neighbours in `avatars` that share a model share its bindings as well. Up to 256 frames may be
    /// recorded before a submission, with 6144 heads of hair in all. They share one environment, that of the
    /// last; a change of the environment takes some milliseconds.
    ///
    /// The view must have the renderer's format. wgpu does not tell the format of a view: see
    /// [`Renderer::check_view`].
    ///
    /// # Errors
    /// A view, targets or states that do not belong together, or too many heads of hair; nothing is recorded
    /// then.
    pub fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &wgpu::TextureView,
        targets: &Targets,
        queue: &wgpu::Queue,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) -> Result<(), DrawError> {
        self.draw_timed(encoder, view, targets, queue, scene, avatars, None)
    }

    /// [`Renderer::draw`] that notes when each pass starts and ends.
    ///
    /// # Errors
    /// As above.
    #[allow(clippy::too_many_arguments, reason = "those of `draw` and one more")]
    pub fn draw_timed(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &wgpu::TextureView,
        targets: &Targets,
        queue: &wgpu::Queue,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
        timer: Option<&PassTimer>,
    ) -> Result<(), DrawError> {
        self.draw_crowds(encoder, view, targets, queue, scene, avatars, &mut [], timer)
    }

    /// [`Renderer::draw_timed`] with crowds beside the other avatars.
    ///
    /// Blended parts of crowds are drawn after those of the others, part by part in the order of the model,
    /// its corneas last, and each for the avatars from far to near: of two blended parts that overlap, the
    /// nearer may be drawn first. A crowd that stands in several frames must be submitted with each of them
    /// before the next one is recorded: a frame writes what of the crowd it shows, and takes its avatars for
    /// deformed from then on.
    ///
    /// # Errors
    /// As above, or a crowd of another model.
    #[allow(clippy::too_many_arguments, reason = "those of `draw_timed` and one more")]
    pub fn draw_crowds(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &wgpu::TextureView,
        targets: &Targets,
        queue: &wgpu::Queue,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
        crowds: &mut [(&AvatarModel, &mut AvatarCrowd)],
        timer: Option<&PassTimer>,
    ) -> Result<(), DrawError> {
        self.record(encoder, view, targets, queue, scene, avatars, crowds, timer, false)
    }

    /// [`Renderer::draw`] by the programs that show wrinkles, whether there are any or not: the same picture.
    /// [`Renderer::prepare`] makes what wrinkles need, but some adapters, software above all, compile it when
    /// it first draws. Draw such a frame when nobody waits, and the first smile waits for nothing.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn rehearse(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &wgpu::TextureView,
        targets: &Targets,
        queue: &wgpu::Queue,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) -> Result<(), DrawError> {
        self.record(encoder, view, targets, queue, scene, avatars, &mut [], None, true)
    }

    #[allow(clippy::too_many_arguments, reason = "those of `draw_crowds` and one more")]
    fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &wgpu::TextureView,
        targets: &Targets,
        queue: &wgpu::Queue,
        scene: &Scene,
        avatars: &[(&AvatarModel, &AvatarState)],
        crowds: &mut [(&AvatarModel, &mut AvatarCrowd)],
        timer: Option<&PassTimer>,
        rehearses: bool,
    ) -> Result<(), DrawError> {
        self.check(view, targets, avatars)?;
        if let Some(crowd) = crowds.iter().position(|(model, crowd)| !crowd.fits(model)) {
            return Err(DrawError::CrowdOfAnotherModel { crowd });
        }
        let pixels_per_unit = pixels_per_unit(&scene.camera, targets.size());
        let terms = self.config().shading.terms();
        let boxes = avatars.iter().map(|(model, state)| (state.bounds(model), model.height));
        let of_crowds = crowds
            .iter()
            .flat_map(|(model, crowd)| crowd.pose.bounds().map(|bounds| (Some(bounds), model.height)));
        let boxes = boxes.chain(of_crowds);
        let seen = Seen::new(&scene.camera, boxes.clone());
        let casters = boxes.filter_map(|(bounds, _)| bounds);
        let shadows = ShadowViews::new(&scene.light, seen.bounds, casters, terms.shadows);
        let lamps = shadows.0.get(..terms.shadows.lamps() as usize).unwrap_or_default();
        let sight = Sight { frustum: Frustum::new(&scene.camera), lamps };
        let has_strands = |avatar: &&(&AvatarModel, &AvatarState)| {
            sight.concerns(avatar.0, avatar.1)
                && strands_in_view(**avatar, &scene.camera, pixels_per_unit, f32::INFINITY).is_some()
        };
        let heads = avatars.iter().filter(has_strands).count();
        if heads > MOST_HEADS as usize {
            return Err(DrawError::TooManyHeads { found: heads, limit: MOST_HEADS as usize });
        }
        let has_hair = heads > 0;
        for (_, crowd) in crowds.iter_mut() {
            let shows = |bounds| sight.shows(bounds);
            crowd.pose.choose(queue, scene.camera.eye(), shows, |bounds| sight.casts(bounds));
        }
        let irradiance = self.resources.environment.irradiance(queue, &scene.light.environment, terms);
        let mut gpu_frame = GpuFrame::new(scene, &irradiance, &shadows, targets.size(), seen.height);
        if has_hair {
            gpu_frame.set_hair(&scene.camera, seen.bounds, Pass::HairShadow.runs(terms, has_hair));
        }
        let frame = Recording {
            renderer: self,
            view,
            targets,
            scene,
            avatars,
            crowds,
            clear: self.clear_color(scene.background),
            frame_offset: self.resources.frames.push(queue, &gpu_frame),
            shadow_offsets: shadows.0.map(|view| {
                let shadow_from_world = view.shadow_from_world.to_cols_array_2d();
                self.shadow_views.push(queue, &GpuShadowView { shadow_from_world })
            }),
            sight,
            timer,
            rehearses,
            has_hair,
            pixels_per_unit,
            queue,
        };
        let passes = || FRAME_PASSES.into_iter().filter(|pass| pass.runs(terms, has_hair));
        for pass in passes() {
            frame.record(encoder, pass);
        }
        if let Some(timer) = timer {
            timer.finish(encoder, passes());
        }
        Ok(())
    }

    fn clear_color(&self, [r, g, b, a]: [f32; 4]) -> wgpu::Color {
        let channel = |linear: f32| {
            let encoded = if self.config().encodes_in_shader() { srgb_from_linear(linear) } else { linear };
            f64::from(encoded * a)
        };
        wgpu::Color { r: channel(r), g: channel(g), b: channel(b), a: f64::from(a) }
    }

    pub(crate) fn check(
        &self,
        view: &wgpu::TextureView,
        targets: &Targets,
        avatars: &[(&AvatarModel, &AvatarState)],
    ) -> Result<(), DrawError> {
        if targets.renderer != self.id() {
            return Err(DrawError::TargetsOfAnotherRenderer);
        }
        let texture = view.texture();
        // A view of a smaller mip level has another size than its texture, which wgpu does not tell.
        let size_fits = texture.mip_level_count() > 1
            || (texture.width() == targets.width && texture.height() == targets.height);
        // A view may differ from its texture in being sRGB.
        let format_fits =
            texture.format().remove_srgb_suffix() == self.config().color_format.remove_srgb_suffix();
        let drawable = texture.usage().contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
        if !(size_fits && format_fits && drawable && texture.sample_count() == 1) {
            return Err(DrawError::View {
                width: targets.width,
                height: targets.height,
                format: self.config().color_format,
                found_width: texture.width(),
                found_height: texture.height(),
                found_format: texture.format(),
            });
        }
        match avatars.iter().position(|(model, state)| !state.fits(model)) {
            Some(avatar) => Err(DrawError::StateOfAnotherModel { avatar }),
            None => Ok(()),
        }
    }
}
