//! Results of MediaPipe's face landmarker as lines of JSON.

use crate::channel::{SHAPES, channels, find};
use crate::turn::{Matrix, head, matrix, set_head};
use crate::{DecodeError, Found, Frame};
use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::fmt;
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
        let mut frame = Frame::default();
        let mut json = serde_json::Deserializer::from_slice(line);
        Whole(&mut frame)
            .deserialize(&mut json)
            .and_then(|()| json.end())
            .map_err(|error| placed(&error, line))?;
        frame.is_tracked = !frame.is_empty();
        Ok(frame)
    }
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

#[derive(serde::Deserialize)]
#[serde(field_identifier)]
enum Key {
    #[serde(rename = "faceBlendshapes", alias = "face_blendshapes")]
    Shapes,
    #[serde(rename = "facialTransformationMatrixes", alias = "facial_transformation_matrixes")]
    Matrixes,
    #[serde(
        rename = "timestampMs",
        alias = "timestamp_ms",
        alias = "timestamp",
        alias = "timestampInMilliseconds"
    )]
    Time,
    #[serde(rename = "categories")]
    Categories,
    #[serde(rename = "categoryName", alias = "category_name")]
    Name,
    #[serde(rename = "score")]
    Score,
    #[serde(rename = "data")]
    Data,
    #[serde(other)]
    Other,
}

struct Whole<'f>(&'f mut Frame);

impl<'de> DeserializeSeed<'de> for Whole<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Whole<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a result of a face landmarker")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<(), M::Error> {
        while let Some(key) = map.next_key()? {
            match key {
                Key::Shapes => map.next_value_seed(First(Shapes(self.0)))?,
                Key::Matrixes => {
                    let mut numbers = Numbers::default();
                    map.next_value_seed(First(Collect(&mut numbers)))?;
                    if numbers.count > 0 {
                        let rows = numbers.rows().ok_or_else(|| M::Error::custom("expected a matrix"))?;
                        set_head(self.0, &rows);
                    }
                }
                Key::Time => {
                    let millis: Option<f64> = map.next_value()?;
                    self.0.time_secs =
                        millis.filter(|millis| millis.is_finite()).map(|millis| millis / 1000.0);
                }
                _ => drop(map.next_value::<IgnoredAny>()?),
            }
        }
        Ok(())
    }
}

/// The first of a list, by somebody else; there may be none.
struct First<S>(S);

impl<'de, S: DeserializeSeed<'de, Value = ()>> DeserializeSeed<'de> for First<S> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_any(self)
    }
}

impl<'de, S: DeserializeSeed<'de, Value = ()>> Visitor<'de> for First<S> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list, one for each face")
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        if list.next_element_seed(self.0)?.is_some() {
            while list.next_element::<IgnoredAny>()?.is_some() {}
        }
        Ok(())
    }
}

/// The shapes of one face: categories, or an object that has them.
struct Shapes<'f>(&'f mut Frame);

impl<'de> DeserializeSeed<'de> for Shapes<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Shapes<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("categories")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<(), M::Error> {
        while let Some(key) = map.next_key()? {
            match key {
                Key::Categories => map.next_value_seed(Shapes(self.0))?,
                _ => drop(map.next_value::<IgnoredAny>()?),
            }
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        while list.next_element_seed(Category(self.0))?.is_some() {}
        Ok(())
    }
}

struct Category<'f>(&'f mut Frame);

impl<'de> DeserializeSeed<'de> for Category<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Category<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a category with its name and score")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<(), M::Error> {
        let (mut channel, mut score) = (None, None);
        while let Some(key) = map.next_key()? {
            match key {
                Key::Name => channel = map.next_value_seed(Name)?,
                Key::Score => score = Some(map.next_value::<f32>()?),
                _ => drop(map.next_value::<IgnoredAny>()?),
            }
        }
        if let (Some(channel), Some(score)) = (channel, score) {
            self.0.set(channel, score);
        }
        Ok(())
    }
}

/// The channel of a shape's name; MediaPipe's `_neutral` has none.
struct Name;

impl<'de> DeserializeSeed<'de> for Name {
    type Value = Option<usize>;

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<Self::Value, D::Error> {
        json.deserialize_str(self)
    }
}

impl Visitor<'_> for Name {
    type Value = Option<usize>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of a shape")
    }

    fn visit_str<E>(self, name: &str) -> Result<Self::Value, E> {
        Ok(find(name.as_bytes()).filter(|channel| *channel < SHAPES))
    }
}

/// The sixteen numbers of a matrix, in the order in which they stand.
#[derive(Default)]
struct Numbers {
    numbers: [f64; 16],
    count: usize,
    /// Whether they stand in rows of their own.
    has_rows: bool,
}

impl Numbers {
    /// The rows of its rotation, without its scale.
    fn rows(&self) -> Option<Matrix> {
        if self.count != 16 || self.numbers.iter().any(|number| !number.is_finite()) {
            return None;
        }
        let at = |index: usize| self.numbers.get(index).copied().unwrap_or_default();
        // Bare numbers stand column by column, unless the places of the last row, 0 0 0 1, hold something
        // else.
        let is_by_rows = self.has_rows || [3, 7, 11].iter().any(|index| at(*index) != 0.0);
        let (row_step, column_step) = if is_by_rows { (4, 1) } else { (1, 4) };
        let mut rows = [[0.0; 3]; 3];
        for column in 0..3 {
            let numbers = [0, 1, 2].map(|row| at(row * row_step + column * column_step));
            let length = numbers.iter().map(|number| number * number).sum::<f64>().sqrt();
            if !(length.is_finite() && length > 1e-9) {
                return None;
            }
            for (row, number) in rows.iter_mut().zip(numbers) {
                *row.get_mut(column)? = number / length;
            }
        }
        Some(rows)
    }
}

struct Collect<'n>(&'n mut Numbers);

impl<'de> DeserializeSeed<'de> for Collect<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Collect<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("16 numbers")
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<(), E> {
        let slot = self.0.numbers.get_mut(self.0.count).ok_or_else(|| E::custom("more than 16 numbers"))?;
        *slot = number;
        self.0.count += 1;
        Ok(())
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<(), E> {
        self.visit_f64(number as f64)
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<(), E> {
        self.visit_f64(number as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        self.0.has_rows |= self.0.count > 0;
        while list.next_element_seed(Collect(self.0))?.is_some() {}
        Ok(())
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<(), M::Error> {
        while let Some(key) = map.next_key()? {
            match key {
                Key::Data => map.next_value_seed(Collect(self.0))?,
                _ => drop(map.next_value::<IgnoredAny>()?),
            }
        }
        Ok(())
    }
}
