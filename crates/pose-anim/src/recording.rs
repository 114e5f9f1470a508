//! Recordings of a face as a table of weights.

use crate::{Clip, ClipError, ControlTable, Track, face};
use placed_toml::nearest;

/// Angles of the head: a column, the control that it moves, and the sign between them.
///
/// Which way the angles turn is not documented. In recordings whose eyes stay on the camera, they turn
/// against the head by about as much (and their direction is known by `EyeLook…`): so a positive yaw turns
/// the head to its own left, a positive pitch lifts it. The roll follows from these two where the axes are
/// those of one frame whose sides are swapped: a positive one bends the head to its left.
const HEAD: [(&str, &str, f64); 3] = [
    ("HeadYaw", face::HEAD_TURN, 1.0),
    ("HeadPitch", face::HEAD_BOW, -1.0),
    ("HeadRoll", face::HEAD_BEND, 1.0),
];

/// Columns that say when a row was: a number of frames, its fraction, and how many frames a second has, as a
/// quotient.
const TIME: [&str; 4] = ["FrameNumber", "SubFrame", "Numerator", "Denominator"];

/// What says the same as other columns: `EyeLook…` move the eyes, and a count is no weight.
const TOLD_OTHERWISE: [&str; 7] = [
    "BlendShapeCount",
    "LeftEyeYaw",
    "LeftEyePitch",
    "LeftEyeRoll",
    "RightEyeYaw",
    "RightEyePitch",
    "RightEyeRoll",
];

/// A recording as a clip of a face.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Recording {
    /// From the first row at 0 s to the last; straight from row to row.
    pub clip: Clip,
    /// Names of the columns that the face has no control for.
    pub passed_over: Vec<String>,
}

/// Why a text is no recording.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}: expected {expected}, found {found}")]
#[non_exhaustive]
pub struct RecordingError {
    /// Line, from 1.
    pub line: usize,
    /// What would have been right.
    pub expected: String,
    /// What is there instead.
    pub found: String,
}

impl Recording {
    /// Reads a table of comma-separated values, a row for each frame, as the app Live Link Face writes it
    /// from ARKit's face tracker: columns that say the time, one for each blend shape with its weight
    /// (`EyeBlinkLeft` is the control `eyeBlinkLeft`), and the head's yaw, pitch and roll in radians. Values
    /// are kept within the ranges of the controls.
    ///
    /// ```
    /// use pose_anim::{ControlTable, Recording};
    /// let controls = ControlTable::from_toml("[[control]]\nname = \"jawOpen\"\nshape = \"jawOpen\"")?;
    /// let text = "FrameNumber,SubFrame,Numerator,Denominator,JawOpen\n9,0.5,60,1,0.25\n12,0.5,60,1,0.75\n";
    /// let clip = Recording::from_csv("talk", text, &controls)?.clip;
    /// assert_eq!(clip.duration_secs(), 0.05);
    /// assert_eq!(clip.at(0, 0.025).map(|jet| jet.value), Some(0.5));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A column of the time that is missing, no column that the face has a control for, a row of another
    /// length than the first one, what is no finite number, a time that is not after the one before, no row
    /// at all; with the line.
    pub fn from_csv(name: &str, text: &str, controls: &ControlTable) -> Result<Self, RecordingError> {
        let wrong = |line: usize, expected: &str, found: String| RecordingError {
            line,
            expected: expected.to_owned(),
            found,
        };
        // Some programs begin a text with this mark.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
        let (first, header) =
            lines.next().ok_or_else(|| wrong(1, "names of columns", "nothing".to_owned()))?;
        let columns: Vec<&str> = header.split(',').map(str::trim).collect();
        let place = |name: &str| {
            columns.iter().position(|column| *column == name).ok_or_else(|| {
                let like =
                    nearest(name, columns.iter().copied()).map(|like| format!("; {like:?} is like it"));
                let found = format!("{} others{}", columns.len(), like.unwrap_or_default());
                wrong(first, &format!("a column {name}"), found)
            })
        };
        let [frame, part, numerator, denominator] =
            [place(TIME[0])?, place(TIME[1])?, place(TIME[2])?, place(TIME[3])?];
        let mut used = Vec::new();
        let mut passed_over = Vec::new();
        for (index, column) in columns.iter().enumerate() {
            if TIME.contains(column) || TOLD_OTHERWISE.contains(column) {
                continue;
            }
            match target(column, controls) {
                Some((control, _)) if used.iter().any(|(_, other, _)| *other == control) => {
                    return Err(wrong(first, "each column once", format!("{column} again")));
                }
                Some((control, factor)) => used.push((index, control, factor)),
                None => passed_over.push((*column).to_owned()),
            }
        }
        if used.is_empty() {
            let expected = "a column that the face has a control for, such as EyeBlinkLeft";
            return Err(wrong(first, expected, "none".to_owned()));
        }
        let mut samples: Vec<Vec<(f64, f64)>> = vec![Vec::new(); used.len()];
        let (mut start, mut latest) = (None, -1.0);
        for (line, row) in lines {
            let fields: Vec<&str> = row.split(',').map(str::trim).collect();
            if fields.len() != columns.len() {
                return Err(wrong(line, &format!("{} values", columns.len()), fields.len().to_string()));
            }
            let number = |index: usize| -> Result<f64, RecordingError> {
                let value = fields[index].parse().ok().filter(|value: &f64| value.is_finite());
                value.ok_or_else(|| {
                    let found = fields[index].chars().take(40).collect::<String>();
                    wrong(line, &format!("a number as {}", columns[index]), format!("{found:?}"))
                })
            };
            // Frames are counted from midnight: their fractions would be lost in a sum.
            let (frames, parts) = (number(frame)?, number(part)?);
            let (first_frame, first_part) = *start.get_or_insert((frames, parts));
            let since = (frames - first_frame) + (parts - first_part);
            let since_secs = since * number(denominator)? / number(numerator)?;
            if !(since_secs.is_finite() && since_secs > latest) {
                let expected = "a time after that of the row before, of a rate that is not 0";
                return Err(wrong(line, expected, format!("{since_secs} s after the first row")));
            }
            latest = since_secs;
            for ((index, control, factor), samples) in used.iter().zip(&mut samples) {
                let control = &controls.controls()[*control];
                let value = (number(*index)? * factor).clamp(control.min.into(), control.max.into());
                samples.push((since_secs, value));
            }
        }
        let unsound = |error: ClipError| wrong(first, "rows of a clip", error.to_string());
        let tracks = used
            .iter()
            .zip(samples)
            .map(|((_, control, _), samples)| Track::from_samples(*control, samples).map_err(unsound));
        let clip = Clip::new(name, tracks.collect::<Result<_, _>>()?).map_err(unsound)?;
        Ok(Self { clip, passed_over })
    }
}

/// The control that a column moves, and by how much for each of its units.
fn target(column: &str, controls: &ControlTable) -> Option<(usize, f64)> {
    if let Some((_, control, sign)) = HEAD.iter().find(|(name, ..)| *name == column) {
        return Some((controls.index(control)?, sign.to_degrees()));
    }
    let mut letters = column.chars();
    let name: String = letters.next()?.to_lowercase().chain(letters).collect();
    Some((controls.index(&name).or_else(|| controls.index(column))?, 1.0))
}
