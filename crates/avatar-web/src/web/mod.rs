//! What scripts call: conversions, and nothing else.

use crate::{Avatar, Look, Show, Stage, WebError};
use avatar_groom::Hair;
use avatar_render::wgpu::SurfaceTarget;
use avatar_stage::Screen;
use js_sys::Promise;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{Clamped, JsError, JsValue};
use wasm_bindgen_futures::future_to_promise;
use web_sys::{HtmlCanvasElement, ImageData};

type Result<T> = std::result::Result<T, JsError>;

/// A device that draws on a canvas.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Device {
    screen: Screen,
}

#[wasm_bindgen]
impl Device {
    /// Opens a device for a canvas whose size in pixels is set, to draw with the look that a link tells, and
    /// hair if there is likely to be some; resolves to a `Device` for [`Face::show`]. No face is needed yet:
    /// this may go on while one is read.
    pub fn open(canvas: HtmlCanvasElement, link: &str, has_hair: bool) -> Promise {
        opened(Look::of_link(link), canvas, has_hair)
    }
}

fn opened(look: Look, canvas: HtmlCanvasElement, has_hair: bool) -> Promise {
    let size = (canvas.width(), canvas.height());
    future_to_promise(async move {
        let mut screen = look.open(SurfaceTarget::Canvas(canvas), size).await.map_err(JsError::from)?;
        let has_hair = look.hair(has_hair.then(Hair::default).as_ref()).is_some();
        screen.prepare(Show::first_step(&screen.gpu().info), has_hair).map_err(JsError::from)?;
        Ok(Device { screen }.into())
    })
}

/// A face on a canvas. `mimik.js` makes of it what a page uses; errors have the library's messages.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Face {
    stage: Stage,
    show: Option<Show>,
}

impl Face {
    fn show_mut(&mut self) -> Result<(&Stage, &mut Show)> {
        let Self { stage, show } = self;
        Ok((stage, show.as_mut().ok_or(WebError::Unseen)?))
    }
}

#[wasm_bindgen]
impl Face {
    /// A face at rest, of an avatar in the bytes of a file of this name. Nothing shows it yet.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str, bytes: &[u8]) -> Result<Self> {
        Ok(Self { stage: Stage::new(Avatar::read(name, bytes)?), show: None })
    }

    /// Opens a device for a canvas whose size in pixels is set, to draw with the look that the face has.
    pub fn open(&self, canvas: HtmlCanvasElement) -> Promise {
        opened(self.stage.look.clone(), canvas, self.stage.pack().hair().is_some())
    }

    /// Shows the face with a device, in the place of the one before.
    pub fn show(&mut self, device: Device) -> Result<()> {
        self.show = None;
        self.show = Some(Show::on(device.screen, &self.stage)?);
        self.stage.stir();
        Ok(())
    }

    /// As `show`, but `plant` has to follow, after something was waited for: the device takes what is
    /// uploaded while hair is planted.
    pub fn begin(&mut self, device: Device) -> Result<()> {
        self.show = None;
        self.show = Some(Show::without_hair(device.screen, &self.stage)?);
        self.stage.stir();
        Ok(())
    }

    /// Plants the hair that the face has.
    pub fn plant(&mut self) -> Result<()> {
        let (stage, show) = self.show_mut()?;
        let planted = show.relook(stage);
        if planted.is_err() {
            // Nothing is better than half a face.
            self.show = None;
        }
        Ok(planted?)
    }

    /// Puts another avatar in the place of this one.
    pub fn load(&mut self, name: &str, bytes: &[u8]) -> Result<()> {
        let mut stage = Stage::new(Avatar::read(name, bytes)?);
        stage.look = self.stage.look.clone();
        if let Some(show) = &mut self.show {
            show.upload(&stage)?;
        }
        self.stage = stage;
        Ok(())
    }

    /// Heads for a pose or a mixture of poses.
    pub fn press(&mut self, pose: &str) -> Result<()> {
        Ok(self.stage.press(pose)?)
    }

    /// Takes one control to a value.
    pub fn set(&mut self, control: &str, value: f32) -> Result<()> {
        Ok(self.stage.set(control, value)?)
    }

    /// Plays a clip.
    pub fn play(&mut self, clip: &str) -> Result<()> {
        Ok(self.stage.play(clip)?)
    }

    /// Comes to rest and says no more.
    pub fn stop(&mut self) {
        self.stage.stop();
    }

    /// Speaks by sounds and their times.
    pub fn speak(&mut self, timeline: &str, from_secs: f64) -> Result<()> {
        Ok(self.stage.speak(timeline, from_secs)?)
    }

    /// Speaks by samples.
    pub fn speak_sound(&mut self, samples: &[f32], rate_hz: u32, from_secs: f64) -> Result<()> {
        Ok(self.stage.speak_sound(samples, rate_hz, from_secs)?)
    }

    /// Goes to a time of the sound.
    pub fn speak_at(&mut self, secs: f64) {
        self.stage.speak_at(secs);
    }

    /// Takes the next samples of a microphone.
    #[cfg(feature = "hearing")]
    pub fn listen(&mut self, samples: &[f32], rate_hz: u32) -> Result<()> {
        Ok(self.stage.listen(samples, rate_hz)?)
    }

    /// Says no more.
    pub fn hush(&mut self) {
        self.stage.hush();
    }

    /// Whether it says something.
    pub fn is_speaking(&self) -> bool {
        self.stage.is_speaking()
    }

    /// Lives as a style does; `off` ends that.
    pub fn live(&mut self, style: &str, seed: u32) -> Result<()> {
        Ok(self.stage.live(style, seed.into())?)
    }

    /// Looks at a point; numbers that are not finite mean ahead.
    pub fn look_at(&mut self, x: f32, y: f32, z: f32) -> Result<()> {
        Ok(self.stage.look_at(Some([x, y, z]))?)
    }

    /// Looks toward a place of the canvas, −1 to 1 to the right and up.
    pub fn look_toward(&mut self, right: f32, up: f32, aspect: f32) -> Result<()> {
        Ok(self.stage.look_toward(right, up, aspect)?)
    }

    /// Names of the channels of [`Face::drive`].
    #[cfg(feature = "live")]
    pub fn channels() -> Vec<String> {
        avatar_live::channels().iter().map(|channel| channel.name.to_owned()).collect()
    }

    /// Goes where a tracker says; NaN for channels of which nothing is known.
    #[cfg(feature = "live")]
    pub fn drive(&mut self, channels: &[f32]) -> Result<()> {
        Ok(self.stage.drive(channels)?)
    }

    /// Becomes somebody else.
    pub fn become_person(&mut self, identity: &str) -> Result<()> {
        self.stage.become_person(identity)?;
        let Self { stage, show } = self;
        Ok(show.as_mut().map_or(Ok(()), |show| show.upload(stage))?)
    }

    /// Sets one option of the look.
    pub fn look(&mut self, option: &str, word: &str) -> Result<()> {
        self.stage.look.set(option, word)?;
        self.relook()
    }

    fn relook(&mut self) -> Result<()> {
        self.stage.stir();
        let Self { stage, show } = self;
        Ok(show.as_mut().map_or(Ok(()), |show| show.relook(stage))?)
    }

    /// Turns the camera, by degrees; goes nearer where `zoom` is below 1.
    pub fn orbit(&mut self, yaw_degrees: f32, pitch_degrees: f32, zoom: f32) {
        self.stage.orbit(yaw_degrees, pitch_degrees, zoom);
    }

    /// Back to the front.
    pub fn front(&mut self) {
        self.stage.look_from_the_front();
    }

    /// The face as the query of an address.
    pub fn link(&self) -> String {
        self.stage.link()
    }

    /// Goes where a link says; returns what of it does not exist here, a line each.
    pub fn follow(&mut self, link: &str) -> Result<Vec<String>> {
        let person = self.stage.identity.clone();
        let passed_over = self.stage.follow(link)?;
        if person != self.stage.identity {
            let Self { stage, show } = self;
            show.as_mut().map_or(Ok(()), |show| show.upload(stage))?;
        }
        self.relook()?;
        Ok(passed_over.iter().map(ToString::to_string).collect())
    }

    /// What there is to press, set and choose, as JSON.
    pub fn info(&self) -> String {
        let mut info = self.stage.info();
        if let (Some(fields), Some(show)) = (info.as_object_mut(), &self.show) {
            fields.insert("adapter".to_owned(), show.adapter().name.clone().into());
            fields.insert("quality".to_owned(), show.quality(&self.stage).into());
            fields.insert("strands".to_owned(), show.strands().into());
        }
        info.to_string()
    }

    /// Values of the controls as they are shown.
    pub fn values(&self) -> Vec<f32> {
        self.stage.values().to_vec()
    }

    /// Bone matrices, twelve numbers each: three columns and the translation.
    pub fn bones(&self) -> Vec<f32> {
        self.stage.bones().iter().flat_map(|bone| bone.to_cols_array()).collect()
    }

    /// Weights of the shapes.
    pub fn weights(&self) -> Vec<f32> {
        self.stage.weights().to_vec()
    }

    /// Lets time pass.
    pub fn advance(&mut self, dt_secs: f64) -> Result<()> {
        Ok(self.stage.advance(dt_secs)?)
    }

    /// Whether controls are on their way, whatever the face says or does by itself.
    pub fn is_arriving(&self) -> bool {
        !self.stage.performer.is_at_rest()
    }

    /// Whether there is anything to draw.
    pub fn is_waiting(&self) -> bool {
        self.stage.is_moving() || self.show.as_ref().is_some_and(Show::is_waiting)
    }

    /// Fits the picture to the canvas.
    pub fn resize(&mut self, width: u32, height: u32) -> Result<()> {
        self.stage.stir();
        let Some(show) = &mut self.show else { return Ok(()) };
        Ok(show.resize(width, height)?)
    }

    /// Draws a frame; returns the level of care, −1 for a frame whose time tells nothing, and −2 where
    /// nothing is drawn since nobody would see a difference.
    pub fn draw(&mut self, dt_secs: f64, whole: bool) -> Result<i32> {
        let (stage, show) = self.show_mut()?;
        if show.is_unseen(stage) {
            return Ok(-2);
        }
        let level = show.draw(stage, dt_secs, whole)?;
        self.stage.drawn();
        Ok(level.and_then(|level| i32::try_from(level).ok()).unwrap_or(-1))
    }

    /// Resolves when the device has drawn what was submitted.
    pub fn done(&self) -> Promise {
        Promise::new(&mut |resolve, _| match &self.show {
            None => drop(resolve.call0(&JsValue::UNDEFINED)),
            Some(show) => show.queue().on_submitted_work_done(move || {
                // A page that is going away does not mind.
                let _ = resolve.call0(&JsValue::UNDEFINED);
            }),
        })
    }

    /// Tells how long a frame of a level took.
    pub fn note(&mut self, level: usize, secs: f64) {
        if let Some(show) = &mut self.show {
            show.note(level, secs);
        }
    }

    /// A picture of the face as it is: resolves to `ImageData`.
    pub fn picture(&mut self, width: u32, height: u32) -> Result<Promise> {
        // Its hair may be about to be planted.
        self.plant()?;
        let (stage, show) = self.show_mut()?;
        let shot = show.picture(stage, (width, height))?;
        Ok(future_to_promise(async move {
            let picture = shot.develop().await.map_err(JsError::from)?;
            ImageData::new_with_u8_clamped_array_and_sh(Clamped(&picture.rgba), width, height).map(Into::into)
        }))
    }

    /// Whether software draws.
    pub fn is_software(&self) -> bool {
        self.show.as_ref().is_some_and(Show::is_software)
    }

    /// Whether the device is lost.
    pub fn is_lost(&self) -> bool {
        self.show.as_ref().is_some_and(Show::is_lost)
    }

    /// Loses the device, as a driver that fails does: for tests.
    pub fn lose(&self) {
        self.show.iter().for_each(Show::destroy);
    }
}
