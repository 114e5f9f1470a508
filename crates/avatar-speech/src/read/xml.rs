use super::{number, symbols};
use crate::error::{Place, SpeechError, shown};
use crate::timeline::{Builder, Cue, Timeline};
use quick_xml::Reader;
use quick_xml::events::Event;

/// Reads `<mouthCue start="0.05" end="0.27">D</mouthCue>`, wherever it stands.
pub(super) fn read(text: &str) -> Result<Timeline, SpeechError> {
    let mut reader = Reader::from_str(text);
    let mut builder = Builder::default();
    let mut open: Option<(f64, f64)> = None;
    let (mut is_result, mut place) = (false, Places { text, byte: 0, place: Place::of_line(1) });
    loop {
        let byte = usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX);
        let event = reader.read_event().map_err(|error| {
            let at = Place::of_byte(text, usize::try_from(reader.error_position()).unwrap_or(byte));
            at.error("XML", error.to_string())
        })?;
        match event {
            Event::Start(tag) if tag.name().as_ref() == "mouthCue" => {
                let mut secs = |name: &str| {
                    let at = place.of(byte);
                    let attribute = tag.try_get_attribute(name).ok().flatten();
                    let missing = || at.error(format!("an attribute {name}"), "none");
                    let attribute = attribute.ok_or_else(missing)?;
                    let text = attribute.value.into_owned();
                    number(&text).ok_or_else(|| at.error(format!("seconds as {name}"), shown(&text)))
                };
                open = Some((secs("start")?, secs("end")?));
            }
            Event::Text(inner) => {
                if let Some((start_secs, end_secs)) = open.take() {
                    let symbol = inner.to_string();
                    let at = place.of(byte);
                    let (viseme, stress) = symbols::rhubarb(symbol.trim())
                        .ok_or_else(|| at.error("a mouth from A to H, or X", shown(&symbol)))?;
                    builder.add(at, Cue { start_secs, end_secs, viseme, stress })?;
                }
            }
            Event::Start(tag) if tag.name().as_ref() == "rhubarbResult" => is_result = true,
            Event::Eof if is_result => return Ok(builder.finish()),
            Event::Eof => {
                return Err(Place::of_line(1).error("an element rhubarbResult", "none"));
            }
            _ => {}
        }
    }
}

/// Places of bytes that come in order: the text is counted through once.
struct Places<'a> {
    text: &'a str,
    byte: usize,
    place: Place,
}

impl Places<'_> {
    fn of(&mut self, byte: usize) -> Place {
        let between = self.text.get(self.byte..byte).unwrap_or_default();
        let lines = between.matches('\n').count();
        let last = between.rsplit('\n').next().unwrap_or_default().chars().count();
        let Place { line, column } = self.place;
        let column = if lines > 0 { last + 1 } else { column + last };
        self.place = Place { line: line + lines, column };
        self.byte = byte;
        self.place
    }
}
