mod error;
mod live;
mod words;
mod talk;
mod living;
mod passing;
mod speaking;
mod attending;

pub use attending::Attention;
use avatar_life::Life;
use avatar_look::Materials;
use avatar_pack::{ContentsError, FaceState, Gaze, Pack};
use avatar_render::avatar_groom::Hair;
use avatar_render::glam::{Affine3A, Vec3};
use avatar_speech::{Mouth, SpeechMap};
pub use error::PerformerError;
#[cfg(doc)]
use pose_anim::Player;
use pose_anim::{Clip, ClipSet, Layers, Pose, PoseSet, Wrap, face};
use std::sync::Arc;
use talk::Talk;
pub use words::Words;

/// Seconds in which a single control goes to its value: as fast as a hand moves a slider.
const SET_SECS: f64 = 0.12;
/// Share of the way to a point by which the head turns, and the seconds that it takes: the eyes are there
/// long before.
const HEAD_SHARE: f32 = 0.45;
const HEAD_SECS: f64 = 0.9;
/// Seconds that the eyes take.
const EYE_SECS: f64 = 0.1;
/// Degrees by which a control has to be off before it is corrected.
const OFF_DEGREES: f32 = 0.25;
/// A control that is this near to the start of a clip need not be led there.
const AT_START: f64 = 1e-3;
/// Controls that a gaze moves, at most: two of each eye, two of the head and four expressions, the first six
/// by their names once more.
const GAZE_CONTROLS: usize = 16;
/// Share of its range by which a control has to be off that follows a file's rule of looking.
const OFF_SHARE: f32 = 1e-4;

/// A face that acts: a pack, the motion of its controls, and the bones and weights that come of it.
///
/// [`Self::press`], [`Self::set`], [`Self::play`] and [`Self::look_at`] say where the face is to go;
/// [`Self::advance`] lets time pass, and then [`Self::bones`] and [`Self::weights`] are what
/// [`AvatarState::set`](avatar_render::AvatarState::set) takes. Each motion takes over smoothly from the one
/// before.
///
/// The pack is shared: `Performer::new(Arc::clone(&pack))` makes one of many faces, `Performer::new(pack)`
/// the only one. Only making a performer, replacing something of its pack, reading a mixture and starting a
/// clip allocate.
#[derive(Clone, Debug)]
pub struct Performer {
    pack: Arc<Pack>,
    layers: Layers,
    state: FaceState,
    gaze: Option<Gaze>,
    playing: Option<Playing>,
    /// Where all controls are heading, for the search of a gaze.
    targets: Vec<f32>,
    /// What a gaze found.
    found: Vec<(usize, f32)>,
    /// A pose that is filled anew for each press of single controls.
    single: Pose,
    /// What the face says, and how this avatar says it.
    talk: Talk,
    speech_map: SpeechMap,
    /// Whether it listens where it does not speak.
    listens: bool,
    /// The mouth as it was posed last; none where nothing is said.
    mouth: Option<Mouth>,
    /// Values of the controls with speech on top.
    spoken: Vec<f32>,
    /// What the face does by itself.
    life: Option<Life>,
    /// Values of the controls with speech and life on top.
    shown: Vec<f32>,
    /// Time that has passed since the face was posed last: what swings is still to follow it.
    waiting_secs: f64,
    /// Whether any has passed since the start or the last jump.
    has_moved: bool,
}

/// A clip that was started.
#[derive(Clone, Debug)]
struct Playing {
    /// What is left of it from where it was started.
    rest: Arc<Clip>,
    from_secs: f64,
    /// Seconds after which it repeats itself.
    period_secs: Option<f64>,
}

impl Performer {
    /// A face with all controls at rest at their defaults.
    pub fn new(pack: impl Into<Arc<Pack>>) -> Self {
        let pack = pack.into();
        let mut state = FaceState::new(&pack);
        let layers = Layers::new(pack.controls());
        // The defaults of a pack's own table always fit it; should they not, the face is at bind pose.
        let _ = state.pose(&pack, layers.values()).and_then(|()| state.settle(&pack));
        Self {
            gaze: Gaze::new(&pack),
            playing: None,
            targets: Vec::with_capacity(pack.controls().len()),
            found: Vec::with_capacity(GAZE_CONTROLS),
            single: Pose::new("single controls", Vec::with_capacity(GAZE_CONTROLS)),
            talk: Talk::new(),
            speech_map: SpeechMap::new(pack.controls()),
            listens: false,
            mouth: None,
            spoken: layers.values().to_vec(),
            life: None,
            shown: layers.values().to_vec(),
            layers,
            state,
            pack,
            waiting_secs: 0.0,
            has_moved: false,
        }
    }

    /// The pack.
    pub fn pack(&self) -> &Arc<Pack> {
        &self.pack
    }

    /// Heads for a pose of the pack by its name, or for a mixture such as `smile:0.5 wink-left`
    /// ([`PoseSet::mix`]).
    ///
    /// [`PoseSet::mix`]: pose_anim::PoseSet::mix
    ///
    /// # Errors
    /// No pose of this name, with the one that is probably meant; a mixture that cannot be read.
    pub fn press(&mut self, name: &str) -> Result<(), PerformerError> {
        // A name in a file may hold what separates a mixture's parts.
        match self.pack.poses().get(name) {
            Some(pose) => self.layers.base().press(pose),
            None => self.layers.base().press(&self.pack.poses().mix(name, self.pack.controls())?),
        }
        Ok(())
    }

    /// Heads for any pose, as [`Player::press`] does.
    pub fn press_pose(&mut self, pose: &Pose) {
        self.layers.base().press(pose);
    }

    /// Takes one control to a value, in the time that a hand needs for a slider; clamped to its range.
    ///
    /// # Errors
    /// No control of this name, with the one that is probably meant.
    pub fn set(&mut self, control: &str, value: f32) -> Result<(), PerformerError> {
        let controls = self.pack.controls();
        let index = controls.index(control).ok_or_else(|| PerformerError::UnknownControl {
            found: control.to_owned(),
            nearest: controls.nearest(control).map(str::to_owned),
        })?;
        self.set_control(index, value);
        Ok(())
    }

    /// As [`Self::set`], by the control's index. An index out of range and a value that is not finite change
    /// nothing.
    pub fn set_control(&mut self, control: usize, value: f32) {
        self.press_single([(control, value)].into_iter(), Some(SET_SECS));
    }

    /// Puts all controls at rest at these values, at once; they are clamped to their ranges. What swings
    /// hangs still there.
    ///
    /// # Errors
    /// Not one value per control, or a value that is not finite; then nothing changes.
    pub fn jump_to(&mut self, values: &[f32]) -> Result<(), PerformerError> {
        self.follow(values)?;
        (self.waiting_secs, self.has_moved) = (0.0, false);
        self.pose()
    }

    /// Puts all controls at these values while time goes on, as for a face that somebody else drives. The
    /// next [`Self::advance`] or [`Self::pose_with`] poses it, and what swings follows.
    ///
    /// # Errors
    /// As [`Self::jump_to`].
    pub fn follow(&mut self, values: &[f32]) -> Result<(), PerformerError> {
        self.layers.jump_to(values)?;
        self.playing = None;
        self.show()
    }

    /// Plays a clip of the pack from its start.
    ///
    /// # Errors
    /// No clip of this name, with the one that is probably meant.
    pub fn play(&mut self, name: &str) -> Result<(), PerformerError> {
        let pack = Arc::clone(&self.pack);
        let clip = pack.clips().get(name).ok_or_else(|| PerformerError::UnknownClip {
            found: name.to_owned(),
            nearest: pack.clips().nearest(name).map(str::to_owned),
        })?;
        self.play_clip(clip, 0.0)
    }

    /// Plays any clip, from a time in seconds after its start.
    ///
    /// # Errors
    /// A time that is NaN or infinite.
    pub fn play_clip(&mut self, clip: &Clip, from_secs: f64) -> Result<(), PerformerError> {
        let rest = Arc::new(clip.starting_at(from_secs)?);
        let values = self.layers.base_ref().values();
        let is_there = rest.tracks().iter().all(|track| {
            let here = values.get(track.control()).copied().unwrap_or_default();
            (f64::from(here) - track.at(0.0).value).abs() < AT_START
        });
        self.layers.base().play(&rest, is_there.then_some(0.0));
        let period_secs = match clip.wrap {
            Wrap::Once => None,
            Wrap::Loop => Some(clip.duration_secs()),
            Wrap::PingPong => Some(2.0 * clip.duration_secs()),
        };
        self.playing = Some(Playing { rest, from_secs, period_secs });
        Ok(())
    }

    /// Where the clip stands that was started last, in seconds from its start, as
    /// [`Player::clip_time_secs`] says it; `None` where it has ended or moves nothing any more.
    pub fn clip_time_secs(&self) -> Option<f64> {
        let Playing { rest, from_secs, period_secs } = self.playing.as_ref()?;
        let secs = from_secs + self.layers.base_ref().clip_time_secs(rest)?;
        Some(period_secs.map_or(secs, |period_secs| secs.rem_euclid(period_secs)))
    }

    /// Brings everything to rest where it is, as soon as is smooth. A clip ends.
    pub fn stop(&mut self) {
        self.layers.base().stop();
        self.playing = None;
    }

    /// Looks at a point in world space: the eyes at once, the head a part of the way after them. Call it
    /// before each [`Self::advance`] while the face is to follow a point that moves; it changes nothing while
    /// the face looks there already, or for a point that is not finite. Returns whether it changed anything.
    ///
    /// # Errors
    /// Control values that do not become a face.
    pub fn look_at(&mut self, point: Vec3) -> Result<bool, PerformerError> {
        let Some(gaze) = &mut self.gaze else { return Ok(false) };
        self.targets.clear();
        self.targets.extend(self.layers.base_ref().targets());
        gaze.face_toward(&self.pack, &self.targets, point, HEAD_SHARE, &mut self.found)?;
        let turns = self.lead(HEAD_SECS, false);
        let Some(gaze) = &mut self.gaze else { return Ok(turns) };
        gaze.look_at(&self.pack, self.layers.values(), point, &mut self.found)?;
        let is_exact = gaze.follows_rule();
        Ok(self.lead(EYE_SECS, is_exact) || turns)
    }

    /// Looks straight ahead again.
    pub fn look_ahead(&mut self) {
        let pack = Arc::clone(&self.pack);
        let controls = pack.controls();
        let named = face::EYES.iter().chain([&face::FACING]).flatten();
        let named = named.filter_map(|name| controls.index(name));
        let gaze = self.gaze.take();
        let ahead = named.chain(gaze.iter().flat_map(Gaze::controls));
        let ahead = ahead.filter_map(|index| Some((index, controls.controls().get(index)?.default)));
        self.press_single(ahead, None);
        self.gaze = gaze;
    }

    /// Moves controls to the values that a gaze found, except those that are nearly there, the more so where
    /// the gaze is exact. Returns whether any control has to move.
    fn lead(&mut self, secs: f64, is_exact: bool) -> bool {
        let Self { layers, found, pack, .. } = self;
        let target = |control: usize| layers.base_ref().target(control).unwrap_or_default();
        let controls = pack.controls().controls();
        let off = |control: usize| match controls.get(control).filter(|_| is_exact) {
            Some(control) => OFF_SHARE * (control.max - control.min),
            None => OFF_DEGREES,
        };
        found.retain(|(control, value)| (target(*control) - value).abs() > off(*control));
        let found = std::mem::take(&mut self.found);
        let is_off = !found.is_empty();
        if is_off {
            self.press_single(found.iter().copied(), Some(secs));
        }
        self.found = found;
        is_off
    }

    fn press_single(&mut self, values: impl Iterator<Item = (usize, f32)>, secs: Option<f64>) {
        self.single.values.clear();
        self.single.values.extend(values);
        self.single.duration_secs = secs;
        self.layers.base().press(&self.single);
    }

    /// Whether all controls have arrived, whatever the face says or does by itself.
    pub fn is_at_rest(&self) -> bool {
        self.layers.is_at_rest()
    }

    /// Bone matrices in the order of the pack's palette.
    pub fn bones(&self) -> &[Affine3A] {
        self.state.bones()
    }

    /// Blend weights in the order of the pack's shapes.
    pub fn weights(&self) -> &[f32] {
        self.state.weights()
    }

    /// Values of the controls as they are now, in degrees or as weights, without speech, life and couplings.
    pub fn values(&self) -> &[f32] {
        self.layers.values()
    }

    /// Where the controls are heading, one value each ([`Player::targets`]).
    pub fn targets(&self) -> impl ExactSizeIterator<Item = f32> {
        self.layers.base_ref().targets()
    }

    /// The face as it was posed last.
    pub fn state(&self) -> &FaceState {
        &self.state
    }

    /// The layers, to add some over the poses: breathing, speech.
    pub fn layers(&mut self) -> &mut Layers {
        &mut self.layers
    }

    /// Replaces the pack's poses. A pack that others share is copied first, here and in the three below.
    ///
    /// # Errors
    /// A pose of a control that the pack does not have; the poses then stay as they were.
    pub fn set_poses(&mut self, poses: PoseSet) -> Result<(), ContentsError> {
        Arc::make_mut(&mut self.pack).set_poses(poses)
    }

    /// Replaces the pack's clips. One that plays goes on.
    ///
    /// # Errors
    /// A track of a control that the pack does not have; the clips then stay as they were.
    pub fn set_clips(&mut self, clips: ClipSet) -> Result<(), ContentsError> {
        Arc::make_mut(&mut self.pack).set_clips(clips)
    }

    /// Replaces the pack's materials; [`crate::set_materials`] shows them.
    pub fn set_materials(&mut self, materials: Materials) {
        Arc::make_mut(&mut self.pack).set_materials(materials);
    }

    /// Replaces the pack's hair; [`crate::set_hair`] plants it.
    pub fn set_hair(&mut self, hair: Option<Hair>) {
        Arc::make_mut(&mut self.pack).set_hair(hair);
    }
}
