//! Clips that play, and faces that are recorded.

use super::face::{Face, Playback};
use anyhow::Result;
use pose_anim::{Clip, Pose, Track};
use std::sync::Arc;

/// A recording is reduced to keys that stray by at most this share of a control's range.
const RECORDED_TOLERANCE: f64 = 0.005;
/// A recording takes the face's values this often.
pub(super) const RECORDED_PER_SEC: f64 = 60.0;
/// Longer recordings end by themselves.
const LONGEST_RECORDING_SECS: f64 = 600.0;

/// A face whose values are noted.
pub(super) struct Recording {
    pub(super) secs: f64,
    /// Values of all controls, one row per sample.
    pub(super) samples: Vec<Vec<f32>>,
}

/// Seconds in which a face follows the playhead that is dragged.
const SCRUB_SECS: f64 = 0.08;

impl Face {
    /// Plays a clip from where the playhead stands, or from its start.
    pub(super) fn play(&mut self, index: usize) -> Result<()> {
        let Some(clip) = self.clips.clips().clips.get(index) else { return Ok(()) };
        let ended = clip.wrap == pose_anim::Wrap::Once && self.playback.time_secs >= clip.duration_secs();
        let from_secs = match self.playback.clip == Some(index) && !ended {
            true => self.playback.time_secs,
            false => 0.0,
        };
        let rest = clip.starting_at(from_secs)?;
        // Where the face is at the clip's place already, it need not be led there.
        let is_there = rest.tracks().iter().all(|track| {
            let here = self.player.values().get(track.control()).copied().unwrap_or_default();
            (f64::from(here) - track.at(0.0).value).abs() < 1e-3
        });
        self.start = None;
        self.leave_file_clip();
        self.active_pose = None;
        self.player.play(&Arc::new(rest), is_there.then_some(0.0));
        self.playback = Playback { clip: Some(index), time_secs: from_secs, playing: true };
        Ok(())
    }

    /// Halts what plays.
    pub(super) fn pause(&mut self) {
        if let Some(motion) = &mut self.motion {
            motion.playing = false;
        }
        if self.playback.playing {
            self.playback.playing = false;
            self.player.stop();
            self.goal.copy_from_slice(self.player.values());
        }
    }

    /// Shows a clip at a time.
    pub(super) fn scrub(&mut self, index: usize, time_secs: f64) {
        let Some(clip) = self.clips.clips().clips.get(index) else { return };
        let values = clip.tracks().iter().map(|track| (track.control(), track.at(time_secs).value as f32));
        let pose = Pose::new("playhead", values.collect()).lasting(SCRUB_SECS);
        self.press(&pose);
        self.playback = Playback { clip: Some(index), time_secs, playing: false };
    }

    pub(super) fn recorded_secs(&self) -> Option<f64> {
        Some(self.recording.as_ref()?.secs)
    }

    /// Begins to note the values of the controls.
    ///
    /// # Errors
    /// A clip of the file moves the face, and no control does.
    pub(super) fn start_recording(&mut self) -> Result<()> {
        if let Some(motion) = self.motion.as_ref().filter(|motion| motion.is_wanted()) {
            anyhow::bail!(
                "expected a face that its controls move, found the clip {} of its file, which moves joints themselves",
                motion.name
            );
        }
        self.recording = Some(Recording { secs: 0.0, samples: vec![self.player.values().to_vec()] });
        Ok(())
    }

    /// Whether a recording has become too long.
    pub(super) fn recording_is_full(&self) -> bool {
        self.recording.as_ref().is_some_and(|recording| recording.secs > LONGEST_RECORDING_SECS)
    }

    /// Makes a clip of what was recorded: of those controls that moved, with as few keys as say it.
    pub(super) fn stop_recording(&mut self) -> Result<()> {
        let Some(Recording { samples, .. }) = self.recording.take() else { return Ok(()) };
        let controls = self.pack.controls().controls();
        let moved = |control: &usize| samples.iter().any(|row| row[*control] != samples[0][*control]);
        let tracks = (0..controls.len()).filter(moved).map(|control| {
            let sample =
                |(k, row): (usize, &Vec<f32>)| (k as f64 / RECORDED_PER_SEC, f64::from(row[control]));
            Track::from_samples(control, samples.iter().enumerate().map(sample))
        });
        let tracks = tracks.collect::<Result<Vec<_>, _>>()?;
        if tracks.is_empty() {
            anyhow::bail!("expected a face that moves while it is recorded, found one at rest");
        }
        let range = |control: usize| f64::from(controls[control].max - controls[control].min);
        let (mut clip, _) = Clip::new(self.free_name("recording"), tracks)?
            .reduced(|control| range(control) * RECORDED_TOLERANCE)?;
        // A cubic may swing a little beyond its keys, and a file takes no key beyond its control's range.
        for (index, control) in controls.iter().enumerate() {
            let Some(track) = clip.track_mut(index) else { continue };
            let (min, max) = (f64::from(control.min), f64::from(control.max));
            for index in 0..track.keys().len() {
                let key = track.keys()[index];
                if key.value.clamp(min, max) != key.value {
                    track.move_key(index, key.time_secs, key.value.clamp(min, max))?;
                }
            }
        }
        self.add_clip(&clip)
    }
}
