mod file_motion;
mod living;
mod playing;

use crate::face_args::FaceChoice;
use crate::life_args::Living;
use anyhow::Result;
use avatar_pack::Pack;
use avatar_stage::Performer;
use file_motion::FileMotion;
use glam::Vec3;
pub(super) use living::Lively;
pub(super) use playing::Playback;
use playing::{RECORDED_PER_SEC, Recording};
use pose_anim::{ClipSet, ControlTable, Pose, PoseSet};

/// What an avatar does: where its controls are and where they are heading, what plays, and what is recorded.
/// Its poses and clips are in the [`super::books::Books`]; the pack in here has none.
pub(in crate::window) struct Face {
    pub(in crate::window) performer: Performer,
    /// The face of the command line, with its single joints; until something else is asked for.
    start: Option<FaceChoice>,
    /// The pose that was asked for last, if nothing else was since.
    pub(in crate::window) active_pose: Option<usize>,
    pub(in crate::window) playback: Playback,
    /// A clip of the file that moves the face.
    pub(in crate::window) motion: Option<FileMotion>,
    /// Names and lengths in seconds of the file's clips.
    pub(in crate::window) file_clips: Vec<(String, f64)>,
    pub(in crate::window) recording: Option<Recording>,
    /// How it lives while it does.
    lively: Lively,
    /// Values of the controls as they are posed while the face of the command line is shown.
    values: Vec<f32>,
}

impl Face {
    /// A face at rest that starts as the command line says.
    pub(in crate::window) fn new(mut pack: Pack, mut start: FaceChoice, lively: Lively) -> Result<Self> {
        pack.set_poses(PoseSet::default())?;
        pack.set_clips(ClipSet::default())?;
        let file_clips = pack.motion().map_or_else(Vec::new, |motion| {
            let named = |name: String| {
                let secs = motion.duration_secs(&name).unwrap_or(0.0);
                (name, secs)
            };
            motion.clips().into_iter().map(named).collect()
        });
        let life = start.take_life();
        let mut performer = Performer::new(pack);
        performer.jump_to(&start.start_values())?;
        let lively = life.as_ref().map_or(lively, |life| lively.with(life));
        performer.set_life(life.map(Living::into_life))?;
        Ok(Self {
            performer,
            start: Some(start),
            active_pose: None,
            playback: Playback::default(),
            motion: None,
            file_clips,
            recording: None,
            lively,
            values: Vec::new(),
        })
    }

    pub(in crate::window) fn pack(&self) -> &Pack {
        self.performer.pack()
    }

    pub(in crate::window) fn controls(&self) -> &ControlTable {
        self.pack().controls()
    }

    /// Lets time pass. What is recorded is recorded at even times, however many frames are drawn.
    pub(in crate::window) fn advance(&mut self, secs: f64) {
        let mut left = secs;
        while let Some(recording) = self.recording.as_ref().filter(|recording| !recording.is_fed) {
            let due = recording.samples.len() as f64 / RECORDED_PER_SEC - recording.secs;
            if due > left {
                break;
            }
            self.step(due);
            left -= due;
            if let Some(recording) = &mut self.recording {
                recording.samples.push(self.performer.values().to_vec());
            }
        }
        self.step(left);
    }

    fn step(&mut self, secs: f64) {
        // Elapsed times are neither negative nor NaN, the only errors there are.
        let _ = self.performer.pass(secs);
        self.advance_motion(secs);
        if let Some(recording) = &mut self.recording {
            recording.secs += secs;
        }
    }

    /// Whether it does something that it was told, or something still swings after it: then frames follow
    /// each other. What swings with a face that lives is drawn as that life is.
    pub(in crate::window) fn acts(&self) -> bool {
        let is_led = self.motion.as_ref().is_some_and(FileMotion::moves);
        let plays = self.is_playing() || self.performer.is_speaking();
        let swings = !self.lives() && self.performer.swings();
        !self.performer.is_at_rest() || is_led || plays || swings || self.recording.is_some()
    }

    /// Brings bones and weights to the present values.
    pub(in crate::window) fn pose(&mut self) -> Result<()> {
        if self.pose_motion()? {
            return Ok(());
        }
        let Some(start) = &self.start else {
            return Ok(self.performer.pose_with(|pack, values, state| state.pose(pack, values))?);
        };
        self.values.clear();
        self.values.extend_from_slice(start.values());
        self.performer.over(start.values(), &mut self.values)?;
        self.performer.pose_with(|pack, _, state| start.apply_values(&self.values, pack, state))
    }

    /// The shown face, as options of the command line would say it.
    pub(in crate::window) fn choice(&self) -> FaceChoice {
        match (&self.motion, &self.start) {
            (Some(motion), _) if motion.is_wanted() => {
                FaceChoice::of_clip(self.pack(), &motion.name, motion.time_secs)
            }
            (_, Some(start)) if self.is_still() => start.clone(),
            (_, Some(start)) => start.clone().showing(|values, out| Ok(self.performer.over(values, out)?)),
            _ => FaceChoice::of_values(self.performer.shown().to_vec()),
        }
    }

    /// Ends clips and forgets the active pose, because the user wants another face.
    fn turn_away(&mut self) {
        self.start = None;
        self.leave_file_clip();
        self.halt_playhead();
        self.active_pose = None;
    }

    /// Forgets the face of the command line and the active pose.
    pub(in crate::window) fn forget_wishes(&mut self) {
        self.start = None;
        self.active_pose = None;
    }

    /// Goes to a pose.
    pub(in crate::window) fn press(&mut self, pose: &Pose) {
        self.turn_away();
        self.performer.press_pose(pose);
    }

    /// Goes to one of the poses.
    pub(in crate::window) fn go_to(&mut self, poses: &PoseSet, index: usize) {
        if let Some(pose) = poses.poses.get(index) {
            self.press(pose);
            self.active_pose = Some(index);
        }
    }

    /// Goes to the default face.
    pub(in crate::window) fn defaults(&mut self) {
        self.press(&Pose::from_values("defaults", &self.controls().defaults()));
    }

    /// Has these values at once: somebody else's face.
    pub(in crate::window) fn follow(&mut self, values: &[f32]) -> Result<()> {
        self.forget_wishes();
        Ok(self.performer.follow(values)?)
    }

    /// Takes one control to a value, as fast as a hand moves a slider.
    pub(in crate::window) fn set_control(&mut self, control: usize, value: f32) {
        self.turn_away();
        self.performer.set_control(control, value);
    }

    /// Takes one control back to its default.
    pub(in crate::window) fn reset_control(&mut self, control: usize) {
        if let Some(value) = self.controls().controls().get(control).map(|control| control.default) {
            self.set_control(control, value);
        }
    }

    /// Looks at a point.
    pub(in crate::window) fn look_at(&mut self, point: Vec3) {
        // Only a face of another pack would be an error.
        if self.performer.look_at(point).unwrap_or(false) {
            self.forget_wishes();
        }
    }

    /// Looks straight ahead again.
    pub(in crate::window) fn look_ahead(&mut self) {
        self.turn_away();
        self.performer.look_ahead();
    }

    /// Where every control is heading: what sliders show.
    pub(in crate::window) fn targets(&self) -> Vec<f32> {
        self.performer.targets().collect()
    }

    /// The pose that the face has or heads for, with all its controls.
    pub(in crate::window) fn present(&self, name: &str) -> Pose {
        Pose::from_values(name, &self.targets())
    }
}
