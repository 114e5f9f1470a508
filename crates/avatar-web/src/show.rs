use crate::look::is_software;
use crate::{Stage, WebError};
use avatar_groom::Hair;
use avatar_render::glam::{Affine3A, Vec3A};
use avatar_render::headless::{Canvas, Gpu};
use avatar_render::wgpu::AdapterInfo;
use avatar_render::{AvatarModel, AvatarState, HairDetail, Quality, wgpu};
use avatar_stage::{Pace, SAMPLES, Screen, ScreenError, Step, set_colors, set_hair, upload_with_hair};

/// Seconds for which locks swing on when the head has come to rest.
const SWING_SECS: f64 = 1.5;

/// Motions that are shorter than this are not seen, in pixels.
const SEEN_PIXELS: f32 = 0.3;
/// How far a shape moves a vertex, at most, as a share of the head: a smile's corners go that far.
const SHAPE_SHARE: f32 = 0.1;

/// A picture: rows from the top, four bytes a pixel, sRGB with straight alpha.
pub type Picture = avatar_render::Image;

/// What a face is drawn with: a device, the avatar on it, and a canvas or window to draw on, if there is one.
#[derive(Debug)]
pub struct Show {
    gpu: Gpu,
    screen: Option<Screen>,
    model: AvatarModel,
    avatar: AvatarState,
    /// The hair that is planted.
    hair: Option<Hair>,
    pace: Pace,
    /// Whether the last frame was a draft, so that the whole picture is still to come.
    is_draft: bool,
    /// Seconds for which hair swings on.
    swings_secs: f64,
    /// The face as it was drawn last.
    drawn: Drawn,
}

/// Bones and weights that are on the canvas.
#[derive(Debug, Default)]
struct Drawn {
    bones: Vec<Affine3A>,
    weights: Vec<f32>,
}

impl Drawn {
    /// The furthest that anything may have moved since, in the avatar's units, for an avatar of this size
    /// around this point: an upper bound for bones, an estimate for shapes.
    fn distance(&self, stage: &Stage) -> f32 {
        let (bones, weights) = (stage.bones(), stage.weights());
        if self.bones.len() != bones.len() || self.weights.len() != weights.len() {
            return f32::INFINITY;
        }
        let bounds = stage.pack().head().or_else(|| stage.pack().bounds());
        let (center, size) = bounds
            .map_or((Vec3A::ZERO, 1.0), |bounds| (Vec3A::from(bounds.center()), bounds.size().max_element()));
        let moved = self.bones.iter().zip(bones).map(|(before, now)| {
            let turned = (now.matrix3 - before.matrix3).to_cols_array().iter().map(|it| it * it).sum::<f32>();
            let at_center = now.transform_point3a(center).distance(before.transform_point3a(center));
            at_center + turned.sqrt() * size * 0.5
        });
        let shaped = self.weights.iter().zip(weights).map(|(before, now)| (now - before).abs());
        moved.fold(0.0, f32::max) + shaped.sum::<f32>() * size * SHAPE_SHARE
    }

    fn keep(&mut self, stage: &Stage) {
        self.bones.clear();
        self.bones.extend_from_slice(stage.bones());
        self.weights.clear();
        self.weights.extend_from_slice(stage.weights());
    }
}

impl Show {
    /// Shows the face on a screen that [`Look::open`](crate::Look::open) has opened.
    ///
    /// # Errors
    /// A face that the device cannot hold.
    pub fn on(mut screen: Screen, stage: &Stage) -> Result<Self, WebError> {
        screen.set_shading(stage.look.shading(&screen.gpu().info))?;
        let hair = stage.look.hair(stage.pack().hair());
        Self::new(screen.gpu().clone(), Some(screen), stage, hair)
    }

    /// As [`on`](Self::on), but hair is planted by [`relook`](Self::relook): the device can take what is
    /// uploaded meanwhile, once whoever calls has waited for something. Where software draws, it draws the
    /// face without its hair then, shows it nowhere, and has compiled what draws it.
    ///
    /// # Errors
    /// As [`on`](Self::on).
    pub fn without_hair(mut screen: Screen, stage: &Stage) -> Result<Self, WebError> {
        screen.set_shading(stage.look.shading(&screen.gpu().info))?;
        let mut show = Self::new(screen.gpu().clone(), Some(screen), stage, None)?;
        show.avatar.set(&show.gpu.queue, stage.bones(), stage.weights())?;
        let has_hair = stage.look.hair(stage.pack().hair()).is_some();
        let step = Self::first_step(&show.gpu.info).filter(|_| has_hair);
        match (&mut show.screen, step) {
            (Some(screen), Some(step)) => {
                let scene = stage.scene(screen.aspect(), show.model.hair_top());
                screen.warm_up(step, &scene, &[(&show.model, &show.avatar)])?;
            }
            // What is written to a queue goes along with what is submitted.
            _ => drop(show.gpu.queue.submit([])),
        }
        Ok(show)
    }

    /// Uploads the face to a device, for pictures alone.
    ///
    /// # Errors
    /// A face that the device cannot hold.
    pub fn without_screen(gpu: Gpu, stage: &Stage) -> Result<Self, WebError> {
        Self::new(gpu, None, stage, stage.look.hair(stage.pack().hair()))
    }

    fn new(gpu: Gpu, screen: Option<Screen>, stage: &Stage, hair: Option<Hair>) -> Result<Self, WebError> {
        let model = model(&gpu, stage, hair.as_ref())?;
        let avatar = AvatarState::new(&gpu.device, &model);
        let pace = Pace::default();
        Ok(Self {
            gpu,
            screen,
            model,
            avatar,
            hair,
            pace,
            is_draft: false,
            swings_secs: 0.0,
            drawn: Drawn::default(),
        })
    }

    /// How the first frame on this adapter is drawn: where software draws, as a draft, for which the least
    /// has to be compiled. `None` is the whole picture.
    pub fn first_step(adapter: &AdapterInfo) -> Option<Step> {
        is_software(adapter).then_some(Pace::FIRST)
    }

    /// The adapter.
    pub fn adapter(&self) -> &AdapterInfo {
        &self.gpu.info
    }

    /// The quality in which the face is drawn at rest.
    pub fn quality(&self, stage: &Stage) -> &'static str {
        match stage.look.quality(&self.gpu.info) {
            Quality::Plain => "plain",
            Quality::Low => "low",
            Quality::Medium => "medium",
            Quality::High => "high",
        }
    }

    /// Number of strands of hair.
    pub fn strands(&self) -> usize {
        self.model.strand_count()
    }

    /// Uploads the face of a stage that has another avatar or person now.
    ///
    /// # Errors
    /// A face that the device cannot hold; the one before is shown then.
    pub fn upload(&mut self, stage: &Stage) -> Result<(), WebError> {
        let hair = stage.look.hair(stage.pack().hair());
        let model = model(&self.gpu, stage, hair.as_ref())?;
        let avatar = AvatarState::new(&self.gpu.device, &model);
        self.check()?;
        (self.model, self.avatar, self.hair) = (model, avatar, hair);
        Ok(())
    }

    /// Shows the look that a stage has now.
    ///
    /// # Errors
    /// More hair than the device can hold; the one before is kept then.
    pub fn relook(&mut self, stage: &Stage) -> Result<(), WebError> {
        let Gpu { device, queue, .. } = &self.gpu;
        let hair = stage.look.hair(stage.pack().hair());
        if hair != self.hair {
            set_hair(device, queue, stage.pack(), stage.textures(), &mut self.model, hair.as_ref())?;
            self.avatar = AvatarState::new(device, &self.model);
            self.hair = hair;
        }
        set_colors(queue, stage.pack(), &self.model, &stage.look.colors())?;
        let shading = stage.look.shading(&self.gpu.info);
        if let Some(screen) = &mut self.screen {
            screen.set_shading(shading)?;
        }
        Ok(())
    }

    /// Fits the picture to a canvas or window of this size in pixels.
    ///
    /// # Errors
    /// A size that the device cannot draw.
    pub fn resize(&mut self, width: u32, height: u32) -> Result<(), WebError> {
        Ok(self.screen.as_mut().map_or(Ok(()), |screen| screen.resize(width, height))?)
    }

    /// Whether there is something to draw though nothing moves: the whole picture after drafts, or hair that
    /// swings on.
    pub fn is_waiting(&self) -> bool {
        self.is_draft || self.swings_secs > 0.0
    }

    /// Whether a living face has moved by so little since it was drawn whole that nobody would see it, and
    /// nothing else has changed: such frames need not be drawn.
    pub fn is_unseen(&self, stage: &Stage) -> bool {
        stage.only_lives() && !self.is_waiting() && self.is_near(stage)
    }

    /// Whether nobody would see what has moved since the face was drawn.
    fn is_near(&self, stage: &Stage) -> bool {
        let Some(screen) = &self.screen else { return false };
        let pixels = stage.view.pixels_per_unit(stage.pack(), screen.size());
        self.drawn.distance(stage) * pixels < SEEN_PIXELS
    }

    /// Draws a frame `dt_secs` after the one before. Where software draws, frames in motion are drafts,
    /// unless `whole` asks for the picture as it is at rest. Returns the level of care, for [`Show::note`];
    /// `None` for a frame whose time tells nothing.
    ///
    /// # Errors
    /// What the device cannot draw. After [`ScreenError::Lost`] another `Show` has to be opened.
    pub fn draw(&mut self, stage: &Stage, dt_secs: f64, whole: bool) -> Result<Option<usize>, WebError> {
        let moves = stage.is_moving();
        let is_first = self.drawn.bones.is_empty();
        // What swings has to move first.
        let sways = self.hair.is_some_and(|hair| hair.style.swings()) && self.model.strand_count() > 0;
        let sways = sways && !is_first;
        self.swings_secs = match (sways, moves) {
            (false, _) => 0.0,
            (true, true) => SWING_SECS,
            (true, false) => self.swings_secs - dt_secs,
        };
        if self.swings_secs > 0.0 {
            self.avatar.advance_hair(&self.gpu.queue, dt_secs);
        } else {
            self.avatar.still_hair();
        }
        self.avatar.set(&self.gpu.queue, stage.bones(), stage.weights())?;
        // A face that only lives moves little: coarse frames would be seen as such.
        let rests = !moves || stage.only_lives();
        let first = Self::first_step(&self.gpu.info).filter(|_| is_first && !whole);
        let whole = whole || rests || !is_software(&self.gpu.info);
        let Some(screen) = &mut self.screen else { return Ok(None) };
        let level = if whole { 0 } else { self.pace.level() };
        let step = first.or(Pace::step(level));
        let detail = stage.look.hair_detail(&self.gpu.info);
        let detail = HairDetail { draft: step.map_or(detail.draft, |step| Some(step.strands)), ..detail };
        self.avatar.set_hair_detail(detail);
        let scene = stage.scene(screen.aspect(), self.model.hair_top());
        let counts = screen.show(&scene, &[(&self.model, &self.avatar)], step)?;
        self.is_draft = step.is_some();
        self.drawn.keep(stage);
        Ok((counts && first.is_none()).then_some(level))
    }

    /// Tells how long a frame of a level took in seconds, from its beginning until the device had drawn it.
    pub fn note(&mut self, level: usize, secs: f64) {
        self.pace.note(level, secs);
    }

    /// Begins a picture of the face as it is, whatever the canvas shows.
    ///
    /// # Errors
    /// A size that the device cannot draw.
    pub fn picture(&mut self, stage: &Stage, (width, height): (u32, u32)) -> Result<Shot, WebError> {
        let canvas = Canvas::new(&self.gpu, width, height, SAMPLES, stage.look.shading(&self.gpu.info))?;
        self.avatar.set(&self.gpu.queue, stage.bones(), stage.weights())?;
        self.avatar.set_hair_detail(stage.look.hair_detail(&self.gpu.info));
        let aspect = width as f32 / height.max(1) as f32;
        let scene = stage.scene(aspect, self.model.hair_top());
        canvas.submit(&self.gpu, &scene, &[(&self.model, &self.avatar)])?;
        // Whether that will fail is not known yet.
        self.avatar.redo();
        Ok(Shot { gpu: self.gpu.clone(), canvas })
    }

    /// The queue, to wait for what was submitted.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.gpu.queue
    }

    /// Gives the device back to the system at once. Everything of it is lost, as when a driver fails.
    pub fn destroy(&self) {
        self.gpu.device.destroy();
    }

    /// Whether software draws.
    pub fn is_software(&self) -> bool {
        is_software(&self.gpu.info)
    }

    /// Whether the device is lost.
    pub fn is_lost(&self) -> bool {
        self.gpu.errors.is_lost()
    }

    fn check(&self) -> Result<(), WebError> {
        match self.gpu.errors.take() {
            None => Ok(()),
            Some(reason) => Err(ScreenError::Device { reason }.into()),
        }
    }
}

/// A picture that is being drawn, while the face goes on.
#[derive(Debug)]
pub struct Shot {
    gpu: Gpu,
    canvas: Canvas,
}

impl Shot {
    /// Waits for it.
    ///
    /// # Errors
    /// A lost device, or what it complained about.
    pub async fn develop(self) -> Result<Picture, WebError> {
        Ok(self.canvas.read(&self.gpu).await?)
    }
}

fn model(gpu: &Gpu, stage: &Stage, hair: Option<&Hair>) -> Result<AvatarModel, WebError> {
    let (device, queue, pack) = (&gpu.device, &gpu.queue, stage.pack());
    let model = upload_with_hair(device, queue, pack, stage.textures(), hair)?;
    set_colors(queue, pack, &model, &stage.look.colors())?;
    Ok(model)
}
