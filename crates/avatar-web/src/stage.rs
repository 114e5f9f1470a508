use crate::person::person;
#[cfg(feature = "hearing")]
use crate::voice::Microphone;
use crate::voice::heard;
use crate::{Avatar, Look, WebError};
use avatar_life::{Life, Style};
use avatar_pack::{Pack, Textures};
use avatar_render::Scene;
use avatar_render::glam::{Affine3A, Vec2, Vec3};
use avatar_speech::{HeardSpeech, Means, Speech, Timeline};
use avatar_stage::{Attention, Framing, Performer, View};
use std::sync::Arc;

/// How far up or down the camera may go: at the poles "up" would flip.
const MAX_PITCH_DEGREES: f32 = 85.0;
/// How near and far, as multiples of the distance that shows the whole head.
const DISTANCES: std::ops::RangeInclusive<f32> = 0.2..=4.0;
/// Seconds that a page may have slept; what is longer is cut.
const LONGEST_SECS: f64 = 1.0;
/// Seconds by which the mouth may be off from a sound that is played: less is not seen.
const OFF_SECS: f64 = 0.06;

/// A face on a page: an avatar, what it does, how it looks and from where it is seen. It knows no browser and
/// no device.
#[derive(Debug)]
pub struct Stage {
    pub(crate) avatar: Avatar,
    /// The person that is made of the avatar, as it was told.
    pub(crate) identity: String,
    pub(crate) performer: Performer,
    /// How it is shown.
    pub look: Look,
    /// From where it is seen.
    pub(crate) view: View,
    pub(crate) seed: u64,
    /// The sound that it speaks by.
    sound: Option<Arc<HeardSpeech>>,
    look_at: Option<Vec3>,
    #[cfg(feature = "live")]
    driven: crate::driven::Driven,
    #[cfg(feature = "hearing")]
    microphone: Option<Microphone>,
    /// Whether what comes next from a microphone begins anew.
    #[cfg(feature = "hearing")]
    has_left: bool,
    /// Whether something is to be drawn that is not drawn yet.
    is_stirred: bool,
}

impl Stage {
    /// A face at rest, seen from the front.
    pub fn new(avatar: Avatar) -> Self {
        let pack = Arc::clone(&avatar.pack);
        Self {
            identity: String::new(),
            performer: Performer::new(Arc::clone(&pack)),
            look: Look::default(),
            view: View { framing: Framing::Portrait, ..View::FRONT },
            seed: 0,
            sound: None,
            look_at: None,
            #[cfg(feature = "live")]
            driven: crate::driven::Driven::new(pack.controls()),
            #[cfg(feature = "hearing")]
            microphone: None,
            #[cfg(feature = "hearing")]
            has_left: false,
            is_stirred: true,
            avatar,
        }
    }

    /// The avatar as it is shown: as the person that was made of it.
    pub fn pack(&self) -> &Arc<Pack> {
        self.performer.pack()
    }

    /// The avatar's pictures.
    pub fn textures(&self) -> &Textures {
        &self.avatar.textures
    }

    /// Heads for a pose or a mixture of poses.
    ///
    /// # Errors
    /// No pose of this name.
    pub fn press(&mut self, pose: &str) -> Result<(), WebError> {
        Ok(self.performer.press(pose)?)
    }

    /// Takes one control to a value, clamped to its range.
    ///
    /// # Errors
    /// No control of this name; a value that is no number.
    pub fn set(&mut self, control: &str, value: f32) -> Result<(), WebError> {
        if !value.is_finite() {
            return Err(WebError::number(control, "a finite number", &value.to_string()));
        }
        Ok(self.performer.set(control, value)?)
    }

    /// Plays a clip from its start.
    ///
    /// # Errors
    /// No clip of this name.
    pub fn play(&mut self, clip: &str) -> Result<(), WebError> {
        Ok(self.performer.play(clip)?)
    }

    /// Brings everything to rest where it is, and says no more.
    pub fn stop(&mut self) {
        self.performer.stop();
        self.hush();
    }

    /// Speaks by sounds and their times, in any format of `avatar-speech`.
    ///
    /// # Errors
    /// A text that cannot be read; the face goes on as it did.
    pub fn speak(&mut self, timeline: &str, from_secs: f64) -> Result<(), WebError> {
        let speech = Speech::new(&Timeline::read(timeline, None)?);
        self.stop_listening();
        self.sound = None;
        self.performer.speak(speech, from_secs);
        Ok(())
    }

    /// Speaks by a sound of one channel, −1 to 1, from a time in seconds after its beginning.
    ///
    /// # Errors
    /// A rate that cannot be heard.
    pub fn speak_sound(&mut self, samples: &[f32], rate_hz: u32, from_secs: f64) -> Result<(), WebError> {
        let speech = Arc::new(heard(samples, rate_hz)?);
        self.stop_listening();
        self.performer.speak(Arc::clone(&speech), from_secs);
        self.sound = Some(speech);
        Ok(())
    }

    /// Brings the mouth to a time of the sound that it speaks by, in seconds: that of what is played.
    pub fn speak_at(&mut self, secs: f64) {
        let (Some(speech), Some(mouth_secs)) = (&self.sound, self.performer.speech_secs()) else { return };
        let is_off = (mouth_secs - secs).abs() > OFF_SECS;
        if is_off && secs.is_finite() {
            self.performer.speak(Arc::clone(speech), secs);
        }
    }

    /// Speaks by what comes from a microphone: the next samples of one channel, −1 to 1.
    ///
    /// # Errors
    /// A rate that cannot be heard.
    #[cfg(feature = "hearing")]
    pub fn listen(&mut self, samples: &[f32], rate_hz: u32) -> Result<(), WebError> {
        let same = |before: &Microphone| before.rate_hz() == rate_hz && !self.has_left;
        let microphone = match self.microphone.take_if(|before| same(before)) {
            Some(microphone) => microphone,
            None => Microphone::new(rate_hz, self.microphone.as_ref())?,
        };
        self.has_left = false;
        self.sound = None;
        self.microphone.insert(microphone).hear(samples, &mut self.performer);
        Ok(())
    }

    /// What comes next from a microphone begins anew.
    fn stop_listening(&mut self) {
        #[cfg(feature = "hearing")]
        {
            self.has_left = true;
        }
    }

    /// Says no more.
    pub fn hush(&mut self) {
        self.stop_listening();
        self.sound = None;
        self.performer.hush();
    }

    /// Whether it says something, or listens to a microphone.
    pub fn is_speaking(&self) -> bool {
        self.performer.speech_secs().is_some() || self.performer.is_hearing()
    }

    /// Whether the avatar has anything to speak with.
    pub fn can_speak(&self) -> bool {
        self.performer.speech_means() != Means::Nothing
    }

    /// Lets the face live as a style of this name does, from the life of this number on; `off` ends that.
    ///
    /// # Errors
    /// No style of this name.
    pub fn live(&mut self, style: &str, seed: u64) -> Result<(), WebError> {
        let life = match style {
            "off" | "" => None,
            _ => {
                let names: Vec<&str> = Style::PRESETS.iter().map(|style| style.name).collect();
                let found = Style::preset(style);
                let found = found.ok_or_else(|| WebError::word("life", style, names, " or off"))?;
                Some(Life::new(self.pack().controls(), found, seed))
            }
        };
        self.performer.set_life(life)?;
        self.seed = seed;
        self.is_stirred = true;
        Ok(())
    }

    /// How it lives.
    pub fn life(&self) -> &'static str {
        self.performer.life().map_or("off", |life| life.style().name)
    }

    /// Looks at a point in the avatar's space, or ahead again. What is not finite means ahead.
    ///
    /// # Errors
    /// Control values that do not become a face.
    pub fn look_at(&mut self, point: Option<[f32; 3]>) -> Result<(), WebError> {
        self.look_at = point.map(Vec3::from).filter(|point| point.is_finite());
        if self.look_at.is_none() {
            self.performer.attend(0, None)?;
            self.performer.look_ahead();
        }
        Ok(())
    }

    /// Looks toward a place of the picture: −1 to 1 to the right and up, on a plane between camera and face.
    ///
    /// # Errors
    /// Control values that do not become a face.
    pub fn look_toward(&mut self, right: f32, up: f32, aspect: f32) -> Result<(), WebError> {
        let camera = self.view.camera(self.pack(), aspect);
        let center = self.pack().head().or_else(|| self.pack().bounds()).map(|bounds| bounds.center());
        let middle = center.unwrap_or(Vec3::ZERO).distance(camera.eye()) / 2.0;
        let point = camera.eye() + camera.toward(Vec2::new(right, up)) * middle;
        self.look_at(Some(point.to_array()))
    }

    /// Puts the face where a tracker says: one value for each channel of `avatar-live`, NaN for what is not
    /// known.
    ///
    /// # Errors
    /// Another number of channels.
    #[cfg(feature = "live")]
    pub fn drive(&mut self, channels: &[f32]) -> Result<(), WebError> {
        let values = self.driven.follow(channels, self.performer.values())?;
        self.performer.follow(values)?;
        self.is_stirred = true;
        Ok(())
    }

    /// Makes somebody else of the avatar: `seed:7`, or axes as `jaw=0.5`; the empty text is the avatar
    /// itself. What is drawn has to be uploaded anew.
    ///
    /// # Errors
    /// An avatar of which nobody else can be made, axes that do not exist.
    pub fn become_person(&mut self, identity: &str) -> Result<(), WebError> {
        let pack = match person(&self.avatar.pack, identity)? {
            Some(pack) => Arc::new(pack),
            None => Arc::clone(&self.avatar.pack),
        };
        let life = (self.life(), self.seed);
        let targets: Vec<f32> = self.performer.targets().collect();
        self.performer = Performer::new(pack);
        self.performer.jump_to(&targets)?;
        self.identity = identity.trim().to_owned();
        self.live(life.0, life.1)?;
        self.is_stirred = true;
        Ok(())
    }

    /// Turns the camera around the face, by degrees to the character's left and up; goes nearer where `zoom`
    /// is below 1. What is not finite does nothing.
    pub fn orbit(&mut self, yaw_degrees: f32, pitch_degrees: f32, zoom: f32) {
        let view = &mut self.view;
        if !(yaw_degrees.is_finite() && pitch_degrees.is_finite() && zoom.is_finite()) {
            return;
        }
        view.yaw_degrees = (view.yaw_degrees + yaw_degrees + 180.0).rem_euclid(360.0) - 180.0;
        view.pitch_degrees =
            (view.pitch_degrees + pitch_degrees).clamp(-MAX_PITCH_DEGREES, MAX_PITCH_DEGREES);
        view.distance = (view.distance * zoom).clamp(*DISTANCES.start(), *DISTANCES.end());
        self.is_stirred = true;
    }

    /// Back to the front.
    pub fn look_from_the_front(&mut self) {
        self.view = View { framing: Framing::Portrait, ..View::FRONT };
        self.is_stirred = true;
    }

    /// Draws once more whatever happens.
    pub fn stir(&mut self) {
        self.is_stirred = true;
    }

    /// Puts all controls at rest at these values, one for each.
    ///
    /// # Errors
    /// Not one value per control, or one that is not finite.
    pub fn jump_to(&mut self, values: &[f32]) -> Result<(), WebError> {
        self.performer.jump_to(values)?;
        self.is_stirred = true;
        Ok(())
    }

    /// Whether there will be something to draw: something moves, or has changed since [`Stage::drawn`].
    pub fn is_moving(&self) -> bool {
        let performer = &self.performer;
        let moves = !performer.is_at_rest() || performer.swings() || performer.life().is_some();
        self.is_stirred || moves || performer.is_speaking()
    }

    /// Whether the face lives, and does nothing else that [`Stage::is_moving`] knows of.
    pub(crate) fn only_lives(&self) -> bool {
        let performer = &self.performer;
        let others = !performer.is_at_rest() || performer.is_speaking();
        performer.life().is_some() && !others && !self.is_stirred
    }

    /// Tells that everything that had changed is drawn.
    pub fn drawn(&mut self) {
        self.is_stirred = false;
    }

    /// Lets time pass and poses the face; times that are no positive numbers, and more than a second at
    /// once, are not believed.
    ///
    /// # Errors
    /// Control values that do not become a face.
    pub fn advance(&mut self, dt_secs: f64) -> Result<(), WebError> {
        let dt_secs = if dt_secs > 0.0 { dt_secs.min(LONGEST_SECS) } else { 0.0 };
        if let Some(point) = self.look_at {
            match self.performer.life() {
                Some(_) => self.performer.attend(0, Some(Attention::face(point)))?,
                None => {
                    self.performer.look_at(point)?;
                }
            }
        }
        Ok(self.performer.advance(dt_secs)?)
    }

    /// Values of the controls as they are shown.
    pub fn values(&self) -> &[f32] {
        self.performer.shown()
    }

    /// Bone matrices as they were posed last.
    pub fn bones(&self) -> &[Affine3A] {
        self.performer.bones()
    }

    /// Weights of the shapes as they were posed last.
    pub fn weights(&self) -> &[f32] {
        self.performer.weights()
    }

    /// What a picture of this aspect (width by height) shows; `hair_top` is how high the hair reaches.
    pub fn scene(&self, aspect: f32, hair_top: Option<f32>) -> Scene {
        let view = View { hair_top, ..self.view };
        view.scene(self.pack(), aspect, self.look.background(), self.look.light())
    }
}
