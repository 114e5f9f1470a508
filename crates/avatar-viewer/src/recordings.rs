//! Recordings of face trackers as clips of any avatar.

use crate::{reading, standard};
use anyhow::{Result, anyhow, bail};
use avatar_pack::{Pack, retarget};
use face_space::{Calibration, Standard};
use pose_anim::{Clip, ControlTable, Recording, Track};
use std::path::Path;

/// Columns that a warning names.
const TOLD: usize = 8;

/// The file beside a recording that says how its person's face rests.
const CALIBRATION: &str = "face.toml";

/// The head's angles of Live Link, the controls that a table has for them, and the sign between them.
const HEAD: [(&str, &str, f32); 3] =
    [("headYaw", "head.turn", 1.0), ("headPitch", "head.bow", -1.0), ("headRoll", "head.bend", 1.0)];

/// Reads a recording. Columns move the controls of their names, and what else the face has for what they
/// mean: joints, expressions, visemes. With a `face.toml` beside the recording, meanings go first. Says what
/// of it the face cannot show.
pub(crate) fn read(pack: &Pack, path: &Path) -> Result<Clip> {
    let Some(text) = reading::text(path)? else {
        bail!("{}: expected a recording of a face, found nothing of that name", path.display())
    };
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let beside = path.with_file_name(CALIBRATION);
    let calibration = match reading::text(&beside)? {
        Some(text) => {
            let read = Calibration::from_toml(Standard::LiveLink.space().clone(), &text);
            Some(read.map_err(|error| anyhow!("{}: {error}", beside.display()))?)
        }
        None => None,
    };
    let by_name = Recording::from_csv(&name, &text, pack.controls());
    if let (None, Ok(found)) = (&calibration, &by_name)
        && found.passed_over.is_empty()
    {
        return Ok(found.clip.clone());
    }
    let meaning_first = calibration.is_some();
    let (by_meaning, unsaid) = by_meaning(pack, &name, &text, calibration)?;
    let (own, passed_over) = match by_name {
        Ok(found) => (found.clip.tracks().to_vec(), found.passed_over),
        // Without any column by name there may be some by meaning; a wrong row stays wrong.
        Err(error) if by_meaning.is_empty() || Some(error.line) != header(&text) => {
            return Err(anyhow!("{}: {error}", path.display()));
        }
        Err(_) => (Vec::new(), Vec::new()),
    };
    let (mut tracks, others) = if meaning_first { (by_meaning, own) } else { (own, by_meaning) };
    for track in others {
        if tracks.iter().all(|other| other.control() != track.control()) {
            tracks.push(track);
        }
    }
    let space = Standard::LiveLink.space();
    let is_shown = |column: &&String| space.find(column).is_some_and(|place| !unsaid.contains(&place));
    let over: Vec<&String> = passed_over.iter().filter(|column| !is_shown(column)).collect();
    if !over.is_empty() {
        let first = over.iter().take(TOLD).map(|column| column.as_str()).collect::<Vec<_>>().join(", ");
        let more = if over.len() > TOLD { " and others" } else { "" };
        let (file, count) = (path.display(), over.len());
        standard::warn(format_args!(
            "{file}: the face has no control for {count} of the columns: {first}{more}"
        ));
    }
    Ok(Clip::new(name, tracks)?)
}

/// The line that names the columns, from 1.
fn header(text: &str) -> Option<usize> {
    text.lines().position(|line| !line.trim().is_empty()).map(|place| place + 1)
}

/// The tracks of all controls that mean something of what the columns say, and the places among Live Link's
/// values of those that the face cannot show. None of a table without columns of Live Link.
fn by_meaning(
    pack: &Pack,
    name: &str,
    text: &str,
    calibration: Option<Calibration>,
) -> Result<(Vec<Track>, Vec<usize>)> {
    let space = Standard::LiveLink.space();
    let Ok(read) = Recording::from_csv(name, text, &ControlTable::from_toml(&live_link_controls())?) else {
        return Ok((Vec::new(), (0..space.len()).collect()));
    };
    let mut retarget = retarget(pack);
    if let Some(calibration) = calibration {
        *retarget.calibration() = calibration;
    }
    let set: Vec<usize> = retarget.controls().collect();
    let arkit = Standard::ArKit.space().names();
    let unsaid = retarget.unsaid().iter().filter_map(|place| space.find(&arkit.get(*place)?.name)).collect();
    let keys = read.clip.tracks().first().map_or(&[][..], Track::keys);
    let mut samples: Vec<Vec<(f64, f64)>> = vec![Vec::new(); set.len()];
    let mut values = pack.controls().defaults();
    for key in keys {
        let mut live = space.rest();
        read.clip.sample(key.time_secs, &mut live);
        for (angle, _, sign) in HEAD {
            if let Some(slot) = space.index(angle).and_then(|place| live.get_mut(place)) {
                *slot = sign * slot.to_radians();
            }
        }
        retarget.apply(&live, &mut values);
        for (control, samples) in set.iter().zip(&mut samples) {
            samples.push((key.time_secs, values[*control].into()));
        }
    }
    let tracks = set.iter().zip(samples).map(|(control, samples)| Track::from_samples(*control, samples));
    Ok((tracks.collect::<Result<_, _>>()?, unsaid))
}

/// A table with Live Link's 61 values as controls, in their order.
fn live_link_controls() -> String {
    let control = |name: &face_space::Name| match HEAD.iter().find(|(angle, ..)| *angle == name.name) {
        Some((_, control, _)) => {
            format!(
                "[[control]]\nname = {control:?}\njoint = \"head\"\naxis = \"+x\"\nmin = -180\nmax = 180\n"
            )
        }
        None => format!("[[control]]\nname = {0:?}\nshape = {0:?}\n", name.name),
    };
    Standard::LiveLink.space().names().iter().map(control).collect()
}
