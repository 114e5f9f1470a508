//! Clips by their names: those of a file of an interchange format, those of a pack's `clips.toml`, and
//! recordings, whose names are those of files.

use crate::recordings;
use crate::usage::{unknown, usage};
use anyhow::Result;
use avatar_pack::{MotionAt, Pack, SceneMotion};
use pose_anim::{Clip, ClipError, ControlTable, Wrap};
use std::path::Path;

/// A clip that exists.
#[derive(Clone, Debug)]
pub(crate) enum FoundClip {
    /// Of joints and shapes, in a file.
    File(String),
    /// Of controls, in a pack.
    Controls(Clip),
}

/// Looks a clip up.
pub(crate) fn find(pack: &Pack, name: &str) -> Result<FoundClip> {
    if let Some(clip) = pack.clips().get(name) {
        return Ok(FoundClip::Controls(clip.clone()));
    }
    let of_file = pack.motion().map(SceneMotion::clips).unwrap_or_default();
    let is_recording = Path::new(name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
    match of_file.iter().any(|clip| clip == name) {
        true => Ok(FoundClip::File(name.to_owned())),
        false if is_recording => Ok(FoundClip::Controls(recordings::read(pack, Path::new(name))?)),
        false => {
            let of_controls = pack.clips().clips.iter().map(|clip| clip.name.as_str());
            Err(unknown("clip", name, of_file.iter().map(String::as_str).chain(of_controls)))
        }
    }
}

/// Share of a control's range by which a clip of what was recorded may stray from it.
const RECORDED_TOLERANCE: f64 = 0.005;

/// A recording with as few keys as are needed.
pub(crate) fn reduced(clip: &Clip, controls: &ControlTable) -> Result<Clip, ClipError> {
    let controls = controls.controls();
    let range =
        |control: usize| controls.get(control).map_or(1.0, |control| f64::from(control.max - control.min));
    let (mut clip, _) = clip.reduced(|control| range(control) * RECORDED_TOLERANCE)?;
    // A file takes no key beyond its control's range, not even by rounding.
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
    Ok(clip)
}

impl FoundClip {
    /// Its name.
    pub(crate) fn name(&self) -> &str {
        match self {
            Self::File(name) => name,
            Self::Controls(clip) => &clip.name,
        }
    }

    /// Seconds until the clip is at its end; or, where it repeats, at its beginning again.
    pub(crate) fn duration_secs(&self, pack: &Pack) -> f64 {
        match self {
            Self::File(name) => {
                let secs = pack.motion().and_then(|motion| motion.duration_secs(name).ok());
                secs.unwrap_or(0.0)
            }
            Self::Controls(clip) if clip.wrap == Wrap::PingPong => 2.0 * clip.duration_secs(),
            Self::Controls(clip) => clip.duration_secs(),
        }
    }

    /// Whether the end is also the beginning.
    pub(crate) fn repeats(&self) -> bool {
        matches!(self, Self::Controls(clip) if clip.wrap != Wrap::Once)
    }

    /// Evaluates the clip at a time. A clip of controls is written into `values`; what a clip of a file sets
    /// is returned.
    pub(crate) fn at(&self, pack: &Pack, time_secs: f64, values: &mut [f32]) -> Result<MotionAt> {
        match self {
            Self::Controls(clip) => {
                clip.sample(time_secs, values);
                for (value, control) in values.iter_mut().zip(pack.controls().controls()) {
                    *value = value.clamp(control.min, control.max);
                }
                Ok(MotionAt::default())
            }
            Self::File(name) => {
                let at = pack.motion().map(|motion| motion.at(name, time_secs)).transpose();
                Ok(at.map_err(|error| usage(error.to_string()))?.unwrap_or_default())
            }
        }
    }
}
