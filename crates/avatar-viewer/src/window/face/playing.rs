//! Clips that play, and faces that are recorded.

use super::Face;
use crate::clips;
use anyhow::Result;
use pose_anim::{Clip, Pose, Track, Wrap};

/// A recording takes the face's values this often.
pub(in crate::window) const RECORDED_PER_SEC: f64 = 60.0;
/// Longer recordings end by themselves.
const LONGEST_RECORDING_SECS: f64 = 600.0;

/// A face whose values are noted.
pub(in crate::window) struct Recording {
    pub(in crate::window) secs: f64,
    /// Values of all controls, one row per sample.
    pub(in crate::window) samples: Vec<Vec<f32>>,
    /// Whether somebody else adds the rows.
    pub(in crate::window) is_fed: bool,
}

/// Seconds in which a face follows the playhead that is dragged.
const SCRUB_SECS: f64 = 0.08;

/// The clip that is chosen, and its playhead.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::window) struct Playback {
    /// Its index in the books.
    pub(in crate::window) clip: Option<usize>,
    playhead: Playhead,
}

/// Where the playhead is, in seconds from the start of the clip.
#[derive(Clone, Copy, Debug)]
enum Playhead {
    /// It stands.
    Stands(f64),
    /// It goes with the face, which tells the time until the clip is at its end.
    Runs { end_secs: f64 },
}

impl Default for Playhead {
    fn default() -> Self {
        Self::Stands(0.0)
    }
}

impl Playback {
    /// A clip whose playhead stands at a time.
    pub(in crate::window) const fn at(clip: usize, secs: f64) -> Self {
        Self { clip: Some(clip), playhead: Playhead::Stands(secs) }
    }
}

impl Face {
    /// Whether a clip of the books plays.
    pub(in crate::window) fn is_playing(&self) -> bool {
        matches!(self.playback.playhead, Playhead::Runs { .. }) && self.performer.clip_time_secs().is_some()
    }

    /// Where the playhead is, in seconds from the start of the clip.
    pub(in crate::window) fn playhead_secs(&self) -> f64 {
        match self.playback.playhead {
            Playhead::Stands(secs) => secs,
            Playhead::Runs { end_secs } => self.performer.clip_time_secs().unwrap_or(end_secs),
        }
    }

    /// The playhead stays where it is.
    pub(in crate::window) fn halt_playhead(&mut self) {
        self.playback.playhead = Playhead::Stands(self.playhead_secs());
    }

    /// Plays a clip, the one of this index in the books: from where the playhead stands, or from its start.
    pub(in crate::window) fn play(&mut self, index: usize, clip: &Clip) -> Result<()> {
        let stands_secs = self.playhead_secs();
        let ended = clip.wrap == Wrap::Once && stands_secs >= clip.duration_secs();
        let from_secs = if self.playback.clip == Some(index) && !ended { stands_secs } else { 0.0 };
        self.performer.play_clip(clip, from_secs)?;
        self.forget_wishes();
        self.leave_file_clip();
        let end_secs = clip.duration_secs();
        self.playback = Playback { clip: Some(index), playhead: Playhead::Runs { end_secs } };
        Ok(())
    }

    /// Halts what plays.
    pub(in crate::window) fn pause(&mut self) {
        if let Some(motion) = &mut self.motion {
            motion.playing = false;
        }
        if self.is_playing() {
            self.halt_playhead();
            self.performer.stop();
        }
    }

    /// What plays may be another clip now, or none.
    pub(in crate::window) fn forget_playback(&mut self) {
        self.pause();
        self.playback = Playback::default();
    }

    /// Shows a clip, the one of this index in the books, at a time.
    pub(in crate::window) fn scrub(&mut self, index: usize, clip: &Clip, time_secs: f64) {
        let values = clip.tracks().iter().map(|track| (track.control(), track.at(time_secs).value as f32));
        let pose = Pose::new("playhead", values.collect()).lasting(SCRUB_SECS);
        self.press(&pose);
        self.playback = Playback::at(index, time_secs);
    }

    pub(in crate::window) fn recorded_secs(&self) -> Option<f64> {
        Some(self.recording.as_ref()?.secs)
    }

    /// Begins to note the values of the controls.
    ///
    /// # Errors
    /// A clip of the file moves the face, and no control does.
    pub(in crate::window) fn start_recording(&mut self) -> Result<()> {
        if let Some(motion) = self.motion.as_ref().filter(|motion| motion.is_wanted()) {
            anyhow::bail!(
                "expected a face that its controls move, found the clip {} of its file, which moves joints themselves",
                motion.name
            );
        }
        self.recording =
            Some(Recording { secs: 0.0, samples: vec![self.performer.values().to_vec()], is_fed: false });
        Ok(())
    }

    /// The rows of the recording are fed from now on. Returns how long it runs, in seconds.
    pub(in crate::window) fn begin_to_feed(&mut self) -> Option<f64> {
        let recording = self.recording.as_mut()?;
        recording.is_fed = true;
        Some(recording.secs)
    }

    /// When the next row is due that is to be fed, in seconds from the beginning of the recording.
    pub(in crate::window) fn next_row_secs(&self) -> Option<f64> {
        let recording = self.recording.as_ref().filter(|recording| recording.is_fed)?;
        Some(recording.samples.len() as f64 / RECORDED_PER_SEC)
    }

    /// Adds a row to a recording.
    pub(in crate::window) fn feed(&mut self, values: &[f32]) {
        if let Some(recording) = &mut self.recording {
            recording.samples.push(values.to_vec());
        }
    }

    /// Whether a recording has become too long.
    pub(in crate::window) fn recording_is_full(&self) -> bool {
        self.recording.as_ref().is_some_and(|recording| recording.secs > LONGEST_RECORDING_SECS)
    }

    /// Makes a clip of the recording: one track for each control that moved, with as few keys as possible.
    /// Returns `None` if nothing was recorded.
    pub(in crate::window) fn stop_recording(&mut self, name: String) -> Result<Option<Clip>> {
        let Some(Recording { samples, .. }) = self.recording.take() else { return Ok(None) };
        let controls = self.controls().controls();
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
        Ok(Some(clips::reduced(&Clip::new(name, tracks)?, self.controls())?))
    }
}
