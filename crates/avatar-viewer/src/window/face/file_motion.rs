//! A clip that the avatar's file brings along, while it plays: it moves joints and shapes themselves, over
//! what the controls say.

use super::Face;
use anyhow::Result;
use avatar_pack::MotionSampler;

/// Seconds in which the face is led into a clip, and out of it.
const LEAD_SECS: f64 = 0.3;

/// A clip that comes, plays, is paused or goes.
pub(in crate::window) struct FileMotion {
    pub(in crate::window) clip: usize,
    pub(in crate::window) name: String,
    /// Seconds from its start.
    pub(in crate::window) time_secs: f64,
    pub(in crate::window) playing: bool,
    duration_secs: f64,
    /// How much of the face is the clip's; the rest is the controls'.
    share: f32,
    leaving: bool,
    sampler: MotionSampler,
}

impl FileMotion {
    /// Whether frames have to follow each other. Clips of a single face stand still once they are there.
    pub(in crate::window) fn moves(&self) -> bool {
        self.leaving || self.share < 1.0 || (self.playing && self.duration_secs > 0.0)
    }

    /// Whether it is what the user wants to see.
    pub(in crate::window) fn is_wanted(&self) -> bool {
        !self.leaving
    }

    /// Lets time pass; whether there is anything left of it.
    fn advance(&mut self, secs: f64) -> bool {
        let step = (secs / LEAD_SECS) as f32;
        self.share = if self.leaving { self.share - step } else { self.share + step }.clamp(0.0, 1.0);
        if self.playing && self.duration_secs > 0.0 {
            self.time_secs = (self.time_secs + secs).rem_euclid(self.duration_secs);
        }
        !self.leaving || self.share > 0.0
    }
}

impl Face {
    /// Plays a clip of the file: from where it was paused, or else from its start, over and over.
    pub(in crate::window) fn play_file_clip(&mut self, clip: usize) -> Result<()> {
        if self.pack().motion().is_none() {
            return Ok(());
        }
        self.halt_playhead();
        self.performer.stop();
        self.forget_wishes();
        if let Some(motion) = self.motion.as_mut().filter(|motion| motion.clip == clip) {
            (motion.playing, motion.leaving) = (true, false);
            return Ok(());
        }
        let Some(scene) = self.performer.pack().motion() else { return Ok(()) };
        let sampler = scene.sampler(clip)?;
        let name = scene.clips().get(clip).cloned().unwrap_or_default();
        let duration_secs = scene.duration_secs(&name)?;
        self.motion = Some(FileMotion {
            clip,
            name,
            time_secs: 0.0,
            playing: true,
            duration_secs,
            share: 0.0,
            leaving: false,
            sampler,
        });
        Ok(())
    }

    /// Leads the face from the clip back to the values of its controls.
    pub(in crate::window) fn leave_file_clip(&mut self) {
        if let Some(motion) = &mut self.motion {
            motion.leaving = true;
        }
    }

    pub(in crate::window) fn advance_motion(&mut self, secs: f64) {
        self.motion.take_if(|motion| !motion.advance(secs));
    }

    /// Brings the state to the present values, and from there towards the clip; whether there is one.
    pub(in crate::window) fn pose_motion(&mut self) -> Result<bool> {
        let Some(motion) = &mut self.motion else { return Ok(false) };
        // Slow at both ends, as transitions are.
        let share = motion.share * motion.share * (3.0 - 2.0 * motion.share);
        self.performer.pose_with(|pack, values, state| {
            let Some(scene) = pack.motion() else { return state.pose(pack, values) };
            let at = scene.sample(&mut motion.sampler, motion.time_secs);
            state.pose_toward(pack, values, at, share)
        })?;
        Ok(true)
    }
}
