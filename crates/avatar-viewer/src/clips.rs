//! Clips by their names: those of a file of an interchange format, those of a pack's `clips.toml`, and
//! recordings, whose names are those of files.

use crate::usage::{unknown, usage};
use crate::{reading, standard};
use anyhow::{Result, anyhow, bail};
use avatar_pack::{MotionAt, Pack, SceneMotion};
use pose_anim::{Clip, Recording, Wrap};
use std::path::Path;

/// Columns that a warning names.
const TOLD: usize = 8;

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
        false if is_recording => Ok(FoundClip::Controls(recording(pack, Path::new(name))?)),
        false => {
            let of_controls = pack.clips().clips.iter().map(|clip| clip.name.as_str());
            Err(unknown("clip", name, of_file.iter().map(String::as_str).chain(of_controls)))
        }
    }
}

/// Reads the recording of a face tracker, and says what of it the face cannot show.
fn recording(pack: &Pack, path: &Path) -> Result<Clip> {
    let Some(text) = reading::text(path)? else {
        bail!("{}: expected a recording of a face, found nothing of that name", path.display())
    };
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let recording = Recording::from_csv(&name, &text, pack.controls());
    let recording = recording.map_err(|error| anyhow!("{}: {error}", path.display()))?;
    let over = &recording.passed_over;
    if !over.is_empty() {
        let first = over.iter().take(TOLD).map(String::as_str).collect::<Vec<_>>().join(", ");
        let more = if over.len() > TOLD { " and others" } else { "" };
        let (file, count) = (path.display(), over.len());
        standard::warn(format_args!(
            "{file}: the face has no control for {count} columns, which are passed over: {first}{more}"
        ));
    }
    Ok(recording.clip)
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
