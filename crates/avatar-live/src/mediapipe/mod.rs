//! Results of MediaPipe's face landmarker as lines of JSON.

mod json;
mod numbers;

use crate::channel::{SHAPES, channels};
use crate::template::Template;
use crate::turn::{head, matrix, set_head};
use crate::{DecodeError, Found, Frame};
use json::Reading;
use numbers::Numbers;
use std::io::Write;

/// A result of MediaPipe's face landmarker, one line of JSON for each frame, as its JavaScript returns it
/// (`JSON.stringify(result)`) or in Python's words:
///
/// ```json
/// {"timestampMs": 33.4,
///  "faceBlendshapes": [{"categories": [{"categoryName": "jawOpen", "score": 0.3}]}],
///  "facialTransformationMatrixes": [{"rows": 4, "columns": 4, "data": [1, 0, 0, 0,  …]}]}
/// ```
///
/// `face_blendshapes` may be lists of categories without a name around them, matrices 16 numbers or four
/// rows. Only the first face counts; landmarks are passed over. The time is not MediaPipe's: whoever writes
/// the line may say it as `timestampMs`, `timestamp` or `timestampInMilliseconds`.
///
/// MediaPipe's space has +Y up and the camera looks along −Z, so a face without rotation looks at it; the
/// shapes are the subject's own left and right, in a picture that is not mirrored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MediaPipe;

impl MediaPipe {
    /// Reads a line.
    ///
    /// # Errors
    /// What is no JSON, numbers where others are expected, matrices that are none. `at` is a byte of the
    /// line.
    pub fn decode(line: &[u8]) -> Result<Frame, DecodeError> {
        let mut reading = Reading::default();
        reading.whole(line).map_err(|error| placed(&error, line))?;
        Ok(tracked(reading.frame))
    }
}

/// What a number of a line means.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Meaning {
    /// The score of this channel. Without a channel it changes nothing, but has to be within `f32`.
    Score(Option<usize>),
    /// The next one of the matrix.
    OfMatrix,
    /// The time in milliseconds.
    Time,
}

/// Reads the lines of one sender, as [`MediaPipe::decode`] does and four times as fast: a line that differs
/// from the last one in nothing but its numbers is not taken apart again.
///
/// ```
/// # use avatar_live::{MediaPipe, MediaPipeReader};
/// let mut reader = MediaPipeReader::default();
/// for score in [0.1, 0.25] {
///     let line = format!(
///         r#"{{"faceBlendshapes":[{{"categories":[{{"score":{score},"categoryName":"jawOpen"}}]}}]}}"#
///     );
///     assert_eq!(reader.read(line.as_bytes())?, MediaPipe::decode(line.as_bytes())?);
/// }
/// # Ok::<(), avatar_live::DecodeError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct MediaPipeReader {
    template: Template<Meaning>,
    /// Whether the matrix of the line that is remembered has rows of its own.
    has_rows: bool,
    /// What the numbers mean of the line that is being learned.
    meanings: Vec<(usize, Meaning)>,
}

impl MediaPipeReader {
    /// Reads a line.
    ///
    /// # Errors
    /// As [`MediaPipe::decode`].
    pub fn read(&mut self, line: &[u8]) -> Result<Frame, DecodeError> {
        if let Some(frame) = self.read_as_last(line) {
            return Ok(frame);
        }
        if !self.template.is_to_learn(line) {
            return MediaPipe::decode(line);
        }
        self.meanings.clear();
        let mut reading = Reading::learning(&mut self.meanings);
        if reading.whole(line).is_err() {
            // `decode` passes over mistakes in what it does not need, such as numbers that are too large.
            return MediaPipe::decode(line);
        }
        let Reading { frame, times, matrixes, has_rows, .. } = reading;
        // Where a key stands twice, what stands last counts. Nobody writes so.
        if times <= 1 && matrixes <= 1 {
            self.has_rows = has_rows;
            self.template.learn(line, &self.meanings);
        }
        Ok(tracked(frame))
    }

    fn read_as_last(&mut self, line: &[u8]) -> Option<Frame> {
        let mut frame = Frame::default();
        let mut matrix = Numbers::default();
        matrix.has_rows = self.has_rows;
        let is_read = self.template.read(line, &mut |meaning, number| {
            match meaning {
                Meaning::Score(channel) => {
                    let score = number.to_f32()?;
                    if let Some(channel) = channel {
                        frame.set(channel, score);
                    }
                }
                Meaning::OfMatrix => matrix.push(number.to_f64()?)?,
                Meaning::Time => frame.time_secs = Some(number.to_f64()? / 1000.0),
            }
            Some(())
        });
        if !is_read {
            return None;
        }
        if !matrix.is_empty() {
            set_head(&mut frame, &matrix.rows()?);
        }
        Some(tracked(frame))
    }
}

/// Where there is no face, there is nothing in the line.
fn tracked(mut frame: Frame) -> Frame {
    frame.is_tracked = !frame.is_empty();
    frame
}

/// Appends a frame to bytes as a line of JSON, with its end, as MediaPipe's JavaScript would say it.
pub fn mediapipe_line(frame: &Frame, out: &mut Vec<u8>) {
    // Writing to memory does not fail.
    let _ = out.write_all(b"{");
    if let Some(time) = frame.time_secs {
        let _ = write!(out, "\"timestampMs\":{},", time * 1000.0);
    }
    let _ = out.write_all(b"\"faceBlendshapes\":[{\"categories\":[");
    let shapes = frame.iter().take_while(|(channel, _)| *channel < SHAPES);
    for (count, (channel, score)) in shapes.enumerate() {
        let name = channels().get(channel).map_or("", |channel| channel.name);
        let comma = if count == 0 { "" } else { "," };
        let _ =
            write!(out, "{comma}{{\"index\":{},\"score\":{score},\"categoryName\":\"{name}\"}}", count + 1);
    }
    let _ = out.write_all(b"]}],\"facialTransformationMatrixes\":[");
    if (SHAPES..SHAPES + 3).any(|channel| frame.get(channel).is_some())
        && let Some(rows) = matrix(head(frame))
    {
        let _ = out.write_all(b"{\"rows\":4,\"columns\":4,\"data\":[");
        for column in 0..3 {
            for row in rows {
                let _ = write!(out, "{},", row.get(column).copied().unwrap_or_default());
            }
            let _ = out.write_all(b"0,");
        }
        let _ = out.write_all(b"0,0,-40,1]}");
    }
    let _ = out.write_all(b"]}\n");
}

fn placed(error: &serde_json::Error, line: &[u8]) -> DecodeError {
    let before: usize =
        line.split(|byte| *byte == b'\n').take(error.line().saturating_sub(1)).map(|l| l.len() + 1).sum();
    let at = (before + error.column().saturating_sub(1)).min(line.len());
    let found = match error.classify() {
        serde_json::error::Category::Eof => Found::End,
        _ => line.get(at).map_or(Found::End, |byte| Found::Byte(*byte)),
    };
    DecodeError::new(at, "a line of JSON with faceBlendshapes and facialTransformationMatrixes", found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The quick way is taken, and says what the other one says: also where numbers change that mean nothing.
    #[test]
    fn lines_with_other_numbers_are_read_as_the_last_one() {
        let line = |score: f32, neutral: f32, count: usize| {
            format!(
                r#"{{"frame":{count},"faceBlendshapes":[{{"categories":[{{"index":0,"score":{neutral},"categoryName":"_neutral"}},{{"index":25,"score":{score},"categoryName":"jawOpen"}}]}}],"facialTransformationMatrixes":[{{"rows":4,"columns":4,"data":[{score},0,-1,0,0,1,0,0,1,0,{score},0,0,0,-40,1]}}],"timestampMs":{count}.5}}"#
            )
        };
        let mut reader = MediaPipeReader::default();
        for (index, count) in [7, 7, 7, 8, 9, 10].into_iter().enumerate() {
            let line = line(0.1 + index as f32 / 16.0, index as f32 / 1000.0, count);
            let expected = MediaPipe::decode(line.as_bytes());
            let is_quick = reader.clone().read_as_last(line.as_bytes()).is_some();
            // The first line is learned, and the first one with another count.
            assert_eq!(is_quick, index != 0 && index != 3, "{index}");
            assert_eq!(reader.read(line.as_bytes()), expected);
            assert_eq!(expected.map(|frame| frame.named("jawOpen").is_some()), Ok(true));
        }
    }

    /// Scores that are too large are refused in both ways, whoever they belong to.
    #[test]
    fn scores_have_32_bits() {
        let line = |known: &str, unknown: &str| {
            format!(
                r#"{{"faceBlendshapes":[{{"categories":[{{"score":{known},"categoryName":"jawOpen"}},{{"score":{unknown},"categoryName":"x"}}]}}]}}"#
            )
        };
        let mut reader = MediaPipeReader::default();
        for (known, unknown, is_read) in [
            ("0.5", "0.25", true),
            ("0.5000000298023223877", "0.2500000149011611939", true),
            ("1e39", "0", false),
            ("0.5", "3.5e38", false),
            ("0.5", "1e999", false),
            ("0.25", "0.75", true),
        ] {
            let line = line(known, unknown);
            let expected = MediaPipe::decode(line.as_bytes());
            assert_eq!(expected.is_ok(), is_read, "{line}");
            assert_eq!(reader.read(line.as_bytes()), expected, "{line}");
        }
    }
}
