use super::books::Order;
use super::motion::Motion;
use super::playing::{RECORDED_PER_SEC, Recording};
use crate::face_args::FaceChoice;
use crate::files::Files;
use crate::store::{self, Store};
use anyhow::Result;
use avatar_pack::{FaceState, Pack, Textures};
use pose_anim::{Player, Pose};
use pose_book::{ClipBook, PoseBook};

/// Seconds in which a face follows a slider.
const SLIDER_SECS: f64 = 0.12;
/// An avatar and what it does: where its controls are, where they are heading, what plays, and its poses and clips.
pub(super) struct Face {
    pub(super) files: Files,
    pub(super) pack: Pack,
    pub(super) textures: Textures,
    pub(super) player: Player,
    pub(super) state: FaceState,
    /// The face of the command line, with its single joints; until something else is asked for.
    pub(super) start: Option<FaceChoice>,
    /// Where every control is heading: what sliders show.
    pub(super) goal: Vec<f32>,
    /// The pose that was asked for last, if nothing else was since.
    pub(super) active_pose: Option<usize>,
    pub(super) poses: PoseBook,
    pub(super) clips: ClipBook,
    pub(super) store: Store,
    pub(super) playback: Playback,
    /// A clip of the file that moves the face.
    pub(super) motion: Option<Motion>,
    /// Names and lengths in seconds of the file's clips.
    pub(super) file_clips: Vec<(String, f64)>,
    pub(super) recording: Option<Recording>,
    /// In which order the books were changed, for undo.
    pub(super) order: Order,
}

/// What plays.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Playback {
    pub(super) clip: Option<usize>,
    /// Seconds from its start.
    pub(super) time_secs: f64,
    pub(super) playing: bool,
}

impl Face {
    pub(super) fn new(
        files: Files,
        pack: Pack,
        textures: Textures,
        start: Option<FaceChoice>,
    ) -> Result<Self> {
        let mut player = Player::new(pack.controls());
        let goal = start.as_ref().map_or_else(|| pack.controls().defaults(), FaceChoice::start_values);
        player.jump_to(&goal)?;
        let store = Store::of(&files);
        let poses = PoseBook::of_set(pack.poses(), pack.controls())?;
        let clips = ClipBook::of_set(pack.clips(), pack.controls())?;
        let file_clips = pack.motion().map_or_else(Vec::new, |motion| {
            let named = |name: String| {
                let secs = motion.duration_secs(&name).unwrap_or(0.0);
                (name, secs)
            };
            motion.clips().into_iter().map(named).collect()
        });
        let mut face = Self {
            player,
            state: FaceState::new(&pack),
            start,
            goal,
            active_pose: None,
            poses,
            clips,
            store,
            playback: Playback::default(),
            motion: None,
            file_clips,
            recording: None,
            order: Order::default(),
            files,
            pack,
            textures,
        };
        // The texts with their comments; the pack holds what they mean. Those with mistakes are told of when they are followed.
        if let Ok(Some(text)) = face.store.read(store::POSES)
            && face.poses.replace(&text).is_ok()
        {
            face.store.take(store::POSES, text);
        }
        if let Ok(Some(text)) = face.store.read(store::CLIPS)
            && face.clips.replace(&text).is_ok()
        {
            face.store.take(store::CLIPS, text);
        }
        Ok(face)
    }

    /// Lets time pass. What is recorded is recorded at even times, however many frames are drawn.
    pub(super) fn advance(&mut self, secs: f64) {
        let mut left = secs;
        while let Some(recording) = &self.recording {
            let due = recording.samples.len() as f64 / RECORDED_PER_SEC - recording.secs;
            if due > left {
                break;
            }
            self.step(due);
            left -= due;
            let values = self.player.values().to_vec();
            if let Some(recording) = &mut self.recording {
                recording.samples.push(values);
            }
        }
        self.step(left);
    }

    fn step(&mut self, secs: f64) {
        // Elapsed times are neither negative nor NaN, the only errors there are.
        let _ = self.player.advance(secs);
        self.advance_motion(secs);
        if self.playback.playing {
            self.playback.time_secs += secs;
            self.goal.copy_from_slice(self.player.values());
            let clip = self.playback.clip.and_then(|index| self.clips.clips().clips.get(index));
            match clip {
                Some(clip) if clip.wrap == pose_anim::Wrap::Once => {
                    self.playback.playing = self.playback.time_secs < clip.duration_secs();
                    self.playback.time_secs = self.playback.time_secs.min(clip.duration_secs());
                }
                Some(clip) if clip.duration_secs() > 0.0 => {
                    // There and back is twice the way; the ruler shows one.
                    let period_secs = match clip.wrap {
                        pose_anim::Wrap::PingPong => 2.0 * clip.duration_secs(),
                        _ => clip.duration_secs(),
                    };
                    self.playback.time_secs = self.playback.time_secs.rem_euclid(period_secs);
                }
                _ => self.playback.playing = false,
            }
        }
        if let Some(recording) = &mut self.recording {
            recording.secs += secs;
        }
    }

    /// Whether frames have to follow each other.
    pub(super) fn moves(&self) -> bool {
        let is_led = self.motion.as_ref().is_some_and(Motion::moves);
        !self.player.is_at_rest() || is_led || self.playback.playing || self.recording.is_some()
    }

    /// Brings the state to the present values.
    pub(super) fn pose(&mut self) -> Result<()> {
        if self.pose_motion()? {
            return Ok(());
        }
        match &self.start {
            Some(start) => start.apply(&self.pack, &mut self.state),
            None => Ok(self.state.pose(&self.pack, self.player.values())?),
        }
    }

    /// What is shown, in words of the command line.
    pub(super) fn choice(&self) -> FaceChoice {
        match (&self.motion, &self.start) {
            (Some(motion), _) if motion.is_wanted() => {
                FaceChoice::of_clip(&self.pack, &motion.name, motion.time_secs)
            }
            (_, Some(start)) => start.clone(),
            _ => FaceChoice::of_values(self.player.values().to_vec()),
        }
    }

    /// Goes to a pose.
    pub(super) fn press(&mut self, pose: &Pose) {
        self.start = None;
        self.leave_file_clip();
        self.playback.playing = false;
        self.active_pose = None;
        for &(control, value) in &pose.values {
            if let (Some(goal), Some(control)) =
                (self.goal.get_mut(control), self.pack.controls().controls().get(control))
            {
                *goal = value.clamp(control.min, control.max);
            }
        }
        self.player.press(pose);
    }

    /// Takes single controls to values that somebody else finds out again and again; those that are nearly there are left alone.
    pub(super) fn lead(&mut self, values: &[(usize, f32)], secs: f64, off: f32) {
        let is_off = |(control, value): &&(usize, f32)| (self.goal[*control] - value).abs() > off;
        let values: Vec<(usize, f32)> = values.iter().filter(is_off).copied().collect();
        if values.is_empty() {
            return;
        }
        self.start = None;
        self.active_pose = None;
        values.iter().for_each(|(control, value)| self.goal[*control] = *value);
        self.player.press(&Pose::new("led", values).lasting(secs));
    }

    /// Goes to one of the poses.
    pub(super) fn go_to(&mut self, index: usize) {
        if let Some(pose) = self.poses.poses().poses.get(index).cloned() {
            self.press(&pose);
            self.active_pose = Some(index);
        }
    }

    /// Goes to the default face.
    pub(super) fn defaults(&mut self) {
        self.press(&Pose::from_values("defaults", &self.pack.controls().defaults()));
    }

    /// Takes one control to a value, as fast as a hand moves a slider.
    pub(super) fn set_control(&mut self, control: usize, value: f32) {
        self.press(&Pose::new("slider", vec![(control, value)]).lasting(SLIDER_SECS));
    }

    /// Takes one control back to its default.
    pub(super) fn reset_control(&mut self, control: usize) {
        if let Some(value) = self.pack.controls().controls().get(control).map(|control| control.default) {
            self.set_control(control, value);
        }
    }

    /// The pose that the face has or heads for, with all its controls.
    pub(super) fn present(&self, name: &str) -> Pose {
        Pose::from_values(name, &self.goal)
    }
}
