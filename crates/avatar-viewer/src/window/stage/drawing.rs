//! Draws the frames of the window.

use super::Stage;
use super::motion::{Motion, Wanted};
use crate::window::overlay::{Overlay, Painted};
use crate::window::shot::{Shot, kept};
use crate::window::stirring::Change;
use anyhow::{Context, Result, bail};
use avatar_render::{HairDetail, Scene, SeeThrough};
use avatar_stage::Pace;
use std::time::Instant;
use wgpu::CurrentSurfaceTexture as Acquired;

/// What a frame has drawn of the face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::window) struct Drawn {
    /// There was a surface to show it on.
    pub(in crate::window) is_shown: bool,
    pub(in crate::window) all: bool,
    pub(in crate::window) part: bool,
    /// A draft gave way to the whole picture.
    pub(in crate::window) whole_again: bool,
    /// It is known when the picture is finished: [`Stage::ready`] says so.
    pub(in crate::window) is_waited_for: bool,
}

impl Stage {
    /// Waits until a frame can be drawn at once: for the one before it where software draws, and for a
    /// picture of the surface. What the frame shows is computed after that: before, it would be a frame old
    /// when it is seen. Returns when the frame before was finished, if that was waited for.
    pub(in crate::window) fn ready(&mut self) -> Result<Option<Instant>> {
        let finished = self.motion.as_mut().and_then(|motion| motion.wait(&self.gpu.device));
        if self.targets.is_some() && self.next.is_none() {
            self.next = self.acquire()?;
        }
        Ok(finished)
    }

    /// Draws one frame, the panel over the picture; `moves` says whether another one follows at once. A
    /// surface that is not ready loses this frame, not the window.
    pub(in crate::window) fn draw(
        &mut self,
        shot: &Shot<'_>,
        panel: Option<(&mut Overlay, &Painted)>,
        moves: bool,
        change: Change,
    ) -> Result<Drawn> {
        let began = match &mut self.motion {
            Some(motion) => motion.begin(&self.gpu.device),
            None => Instant::now(),
        };
        if self.targets.is_none() {
            return Ok(Drawn::default());
        }
        let Some(frame) = self.next.take() else { return Ok(Drawn::default()) };
        let shown = self.see_through.as_ref().map_or(&frame.texture, SeeThrough::texture).clone();
        let label = Some("frame");
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
        let keeps = self.can_keep && (panel.is_some() || self.motion.is_some());
        if keeps && self.kept.is_none() {
            self.kept = Some(kept(&self.gpu.device, &self.config, shot));
        }
        let (is_same, may_patch) = match self.kept.as_ref().filter(|kept| keeps && kept.shows_view(shot)) {
            Some(kept) => (kept.shows(shot, change), self.motion.as_ref().is_some_and(Motion::is_whole)),
            None => (false, false),
        };
        let (was_draft, is_first) = (self.shows_draft(), !self.has_drawn);
        let wanted = match &mut self.motion {
            Some(motion)
                if may_patch
                    && !is_same
                    && let Change::Within(rect) = change =>
            {
                motion.patch(rect)
            }
            Some(motion) => motion.next(is_same, moves, began),
            None if is_same => Wanted::Same,
            None => Wanted::Level(0),
        };
        if wanted != Wanted::Same {
            self.draw_face(&mut encoder, &shown, shot, wanted, began)?;
        }
        if let Some(kept) = self.kept.as_mut().filter(|_| keeps) {
            match wanted {
                Wanted::Level(_) => kept.note(shot, false),
                Wanted::Part(_) => kept.note(shot, true),
                Wanted::Same | Wanted::WarmUp => {}
            }
            match &self.motion {
                Some(motion) if motion.is_draft() => {
                    let view = shown.create_view(&wgpu::TextureViewDescriptor::default());
                    motion.drafts.show(&self.gpu.device, &mut encoder, &view);
                }
                _ => {
                    let (from, to) = (kept.texture.as_image_copy(), shown.as_image_copy());
                    encoder.copy_texture_to_texture(from, to, kept.texture.size());
                }
            }
        }
        if let Some(see_through) = &self.see_through {
            let format = Some(self.panel_format);
            let view =
                frame.texture.create_view(&wgpu::TextureViewDescriptor { format, ..Default::default() });
            see_through.show(&mut encoder, &view);
        }
        if let Some((overlay, painted)) = panel {
            overlay.draw(&self.gpu, &mut encoder, &frame.texture, self.panel_format, painted);
        }
        self.gpu.queue.submit([encoder.finish()]);
        self.window.pre_present_notify();
        self.gpu.queue.present(frame);
        if is_first && self.motion.is_none() {
            // Nobody waits for wrinkles yet. Where there are drafts, these are rehearsed.
            let scene = shot.scene(self.config.width, self.config.height, &self.look);
            self.renderer.prepare(&scene, &self.model);
        }
        match self.gpu.errors.take() {
            None => Ok(Drawn {
                is_shown: true,
                all: matches!(wanted, Wanted::Level(_)),
                part: matches!(wanted, Wanted::Part(_)),
                whole_again: was_draft && !self.shows_draft(),
                is_waited_for: self.motion.is_some(),
            }),
            Some(error) => {
                // What the kept picture shows now is not known, nor whether the face was deformed.
                self.forget_kept();
                self.avatar.redo();
                self.motion.iter_mut().for_each(Motion::forget);
                bail!("expected adapter {:?} to draw the frame, found: {error}", self.gpu.info.name)
            }
        }
    }

    /// Whether the window shows less than the whole picture.
    pub(in crate::window) fn shows_draft(&self) -> bool {
        self.motion.as_ref().is_some_and(Motion::is_draft)
    }

    /// A frame has been shown after which none follows at once. Returns when one should: with the whole
    /// picture where a draft is shown.
    pub(in crate::window) fn comes_to_rest(&mut self) -> Option<Instant> {
        let motion = self.motion.as_mut()?;
        motion.wait(&self.gpu.device);
        motion.due()
    }

    /// Records what is wanted of the face.
    fn draw_face(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        surface: &wgpu::Texture,
        shot: &Shot<'_>,
        wanted: Wanted,
        began: Instant,
    ) -> Result<()> {
        let (level, is_shown) = match (wanted, &self.motion) {
            (Wanted::Level(level), _) => (level, true),
            (Wanted::WarmUp, Some(motion)) => (motion.draft(), false),
            (Wanted::Part(_), _) => (0, true),
            _ => return Ok(()),
        };
        let (width, height) = (self.config.width, self.config.height);
        self.avatar.set(&self.gpu.queue, shot.state.bones(), shot.state.weights())?;
        let scene = shot.scene(width, height, &self.look);
        if let Wanted::Part(rect) = wanted {
            return self.draw_patch(encoder, &scene, rect);
        }
        let counts = match Pace::step(level) {
            None => self.draw_whole(encoder, surface, &scene)?,
            Some(step) => {
                let Some(motion) = &mut self.motion else { return Ok(()) };
                let gpu = (&self.gpu.device, &self.gpu.queue);
                let detail = self.look.hair_detail(&self.gpu.info);
                self.avatar.set_hair_detail(HairDetail { draft: Some(step.strands), ..detail });
                let avatars = [(&self.model, &self.avatar)];
                let (size, timer) = ((width, height), self.timer.as_ref());
                if is_shown {
                    motion.drafts.draw(gpu, encoder, step, size, &scene, &avatars, timer)?
                } else {
                    motion.drafts.rehearse(gpu, encoder, step, size, &scene, &avatars)?;
                    false
                }
            }
        };
        self.is_measured |= is_shown && self.timer.is_some();
        match &mut self.motion {
            Some(motion) if is_shown => motion.shows(level, began, counts),
            Some(motion) => motion.warmed_up(),
            None => {}
        }
        Ok(())
    }

    /// Records the whole picture: on the one that is kept, or else on the surface. Returns whether it is not
    /// the first, nor the first with wrinkles.
    fn draw_whole(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        surface: &wgpu::Texture,
        scene: &Scene,
    ) -> Result<bool> {
        let Some(targets) = &self.targets else { return Ok(false) };
        self.avatar.set_hair_detail(self.look.hair_detail(&self.gpu.info));
        let texture = self.kept.as_ref().map_or(surface, |kept| &kept.texture);
        let target = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let avatars = [(&self.model, &self.avatar)];
        let timer = self.timer.as_ref();
        let is_ready = self.renderer.is_ready(scene, &avatars);
        self.renderer.draw_timed(encoder, &target, targets, &self.gpu.queue, scene, &avatars, timer)?;
        Ok(std::mem::replace(&mut self.has_drawn, true) && is_ready)
    }

    /// The picture of the surface to draw on, unless it is not ready.
    fn acquire(&mut self) -> Result<Option<wgpu::SurfaceTexture>> {
        match self.surface.get_current_texture() {
            Acquired::Success(frame) | Acquired::Suboptimal(frame) => return Ok(Some(frame)),
            Acquired::Occluded => return Ok(None),
            Acquired::Timeout => {}
            Acquired::Validation => {
                let error = self.gpu.errors.take().unwrap_or_default();
                self.forget_kept();
                bail!("expected a picture of the window to draw on, found: {error}");
            }
            Acquired::Outdated => self.resize(self.window.inner_size())?,
            Acquired::Lost => {
                self.next = None;
                self.surface =
                    self.gpu.instance.create_surface(self.window.clone()).context("the lost surface")?;
                self.resize(self.window.inner_size())?;
            }
        }
        self.window.request_redraw();
        Ok(None)
    }
}
