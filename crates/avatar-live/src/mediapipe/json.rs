//! A line as JSON.

use super::Meaning;
use super::numbers::Numbers;
use crate::Frame;
use crate::channel::{SHAPES, find};
use crate::turn::set_head;
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor,
};
use std::fmt;

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

/// A line that is being read.
#[derive(Debug, Default)]
pub(super) struct Reading<'m> {
    pub(super) frame: Frame,
    /// Whether the last matrix has rows of its own.
    pub(super) has_rows: bool,
    /// How many times and matrices there were.
    pub(super) times: usize,
    pub(super) matrixes: usize,
    /// How many numbers of the line have been passed; counted only for those who learn what they mean.
    passed: usize,
    /// For each number that means something: how many numbers of the line stand before it, and what it means.
    meanings: Option<&'m mut Vec<(usize, Meaning)>>,
}

impl<'m> Reading<'m> {
    /// Remembers what the numbers mean.
    pub(super) fn learning(meanings: &'m mut Vec<(usize, Meaning)>) -> Self {
        Self { meanings: Some(meanings), ..Self::default() }
    }

    /// Reads all of a line.
    pub(super) fn whole(&mut self, line: &[u8]) -> serde_json::Result<()> {
        let mut json = serde_json::Deserializer::from_slice(line);
        Whole(self).deserialize(&mut json)?;
        json.end()
    }

    fn learn(&mut self, number: usize, meaning: Meaning) {
        if let Some(meanings) = &mut self.meanings {
            meanings.push((number, meaning));
        }
    }

    /// Says whose score this number is; its channel is known only once the whole category has been read.
    fn name(&mut self, number: usize, channel: usize) {
        let mut learned = self.meanings.iter_mut().flat_map(|meanings| meanings.iter_mut().rev());
        if let Some((_, meaning)) = learned.find(|(other, _)| *other == number) {
            *meaning = Meaning::Score(Some(channel));
        }
    }

    fn pass(&mut self) -> usize {
        self.passed += 1;
        self.passed - 1
    }
}

struct Whole<'r, 'm>(&'r mut Reading<'m>);

impl<'de> DeserializeSeed<'de> for Whole<'_, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Whole<'_, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a result of a face landmarker")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<(), M::Error> {
        let reading = self.0;
        while let Some(key) = map.next_key()? {
            match key {
                Key::Shapes => map.next_value_seed(First { reading, matrix: None })?,
                Key::Matrixes => {
                    let mut numbers = Numbers::default();
                    map.next_value_seed(First { reading, matrix: Some(&mut numbers) })?;
                    if !numbers.is_empty() {
                        let rows = numbers.rows().ok_or_else(|| M::Error::custom("expected a matrix"))?;
                        set_head(&mut reading.frame, &rows);
                        reading.has_rows = numbers.has_rows;
                    }
                    reading.matrixes += 1;
                }
                Key::Time => {
                    let millis: Option<f64> = map.next_value()?;
                    if millis.is_some() {
                        let number = reading.pass();
                        reading.learn(number, Meaning::Time);
                    }
                    reading.frame.time_secs =
                        millis.filter(|millis| millis.is_finite()).map(|millis| millis / 1000.0);
                    reading.times += 1;
                }
                _ => map.next_value_seed(Passed(reading))?,
            }
        }
        Ok(())
    }
}

/// The first of a list, one for each face: its matrix, or its shapes. There may be none.
struct First<'r, 'm> {
    reading: &'r mut Reading<'m>,
    matrix: Option<&'r mut Numbers>,
}

impl<'de> DeserializeSeed<'de> for First<'_, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for First<'_, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list, one for each face")
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        let Self { reading, matrix } = self;
        let first = match matrix {
            Some(numbers) => list.next_element_seed(Collect { reading, numbers })?,
            None => list.next_element_seed(Shapes(reading))?,
        };
        if first.is_some() {
            while list.next_element_seed(Passed(reading))?.is_some() {}
        }
        Ok(())
    }
}

/// The shapes of one face: categories, or an object that has them.
struct Shapes<'r, 'm>(&'r mut Reading<'m>);

impl<'de> DeserializeSeed<'de> for Shapes<'_, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Shapes<'_, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("categories")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<(), M::Error> {
        while let Some(key) = map.next_key()? {
            match key {
                Key::Categories => map.next_value_seed(Shapes(self.0))?,
                _ => map.next_value_seed(Passed(self.0))?,
            }
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        while list.next_element_seed(Category(self.0))?.is_some() {}
        Ok(())
    }
}

struct Category<'r, 'm>(&'r mut Reading<'m>);

impl<'de> DeserializeSeed<'de> for Category<'_, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Category<'_, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a category with its name and score")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<(), M::Error> {
        let (mut channel, mut score) = (None, None);
        while let Some(key) = map.next_key()? {
            match key {
                Key::Name => channel = map.next_value_seed(Name)?,
                Key::Score => {
                    let value = map.next_value::<f32>()?;
                    let number = self.0.pass();
                    self.0.learn(number, Meaning::Score(None));
                    score = Some((value, number));
                }
                _ => map.next_value_seed(Passed(self.0))?,
            }
        }
        if let (Some(channel), Some((score, number))) = (channel, score) {
            self.0.frame.set(channel, score);
            self.0.name(number, channel);
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

/// Collects the numbers of a matrix.
struct Collect<'r, 'm> {
    reading: &'r mut Reading<'m>,
    numbers: &'r mut Numbers,
}

impl<'de> DeserializeSeed<'de> for Collect<'_, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Collect<'_, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("16 numbers")
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<(), E> {
        self.numbers.push(number).ok_or_else(|| E::custom("more than 16 numbers"))?;
        let number = self.reading.pass();
        self.reading.learn(number, Meaning::OfMatrix);
        Ok(())
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<(), E> {
        self.visit_f64(number as f64)
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<(), E> {
        self.visit_f64(number as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        let Self { reading, numbers } = self;
        numbers.has_rows |= !numbers.is_empty();
        while list.next_element_seed(Collect { reading, numbers })?.is_some() {}
        Ok(())
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<(), M::Error> {
        let Self { reading, numbers } = self;
        while let Some(key) = map.next_key()? {
            match key {
                Key::Data => map.next_value_seed(Collect { reading, numbers })?,
                _ => map.next_value_seed(Passed(reading))?,
            }
        }
        Ok(())
    }
}

/// What has no meaning here; its numbers are counted for those who learn.
struct Passed<'r, 'm>(&'r mut Reading<'m>);

impl<'de> DeserializeSeed<'de> for Passed<'_, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        match self.0.meanings {
            Some(_) => json.deserialize_any(self),
            None => IgnoredAny::deserialize(json).map(drop),
        }
    }
}

impl<'de> Visitor<'de> for Passed<'_, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("anything")
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_bool<E>(self, _: bool) -> Result<(), E> {
        Ok(())
    }

    fn visit_str<E>(self, _: &str) -> Result<(), E> {
        Ok(())
    }

    fn visit_f64<E>(self, _: f64) -> Result<(), E> {
        self.0.pass();
        Ok(())
    }

    fn visit_i64<E>(self, _: i64) -> Result<(), E> {
        self.0.pass();
        Ok(())
    }

    fn visit_u64<E>(self, _: u64) -> Result<(), E> {
        self.0.pass();
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        while list.next_element_seed(Passed(self.0))?.is_some() {}
        Ok(())
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<(), M::Error> {
        while map.next_key::<IgnoredAny>()?.is_some() {
            map.next_value_seed(Passed(self.0))?;
        }
        Ok(())
    }
}
