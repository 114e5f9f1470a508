use super::symbols;
use crate::error::{Place, SpeechError, shown};
use crate::timeline::{Builder, Cue, Timeline, USUAL_STRESS};
use crate::viseme::Viseme;
use serde_json::{Map, Value};

/// How long the last mark lasts, whose end nothing tells.
const LAST_SECS: f64 = 0.15;

/// Reads `{"mouthCues": [{"start": 0.05, "end": 0.27, "value": "D"}]}`.
pub(super) fn read_rhubarb(text: &str) -> Result<Timeline, SpeechError> {
    let value = parsed(text, 1)?;
    let start = Place::of_line(1);
    let cues = value.get("mouthCues").and_then(Value::as_array);
    let cues = cues.ok_or_else(|| start.error("a list mouthCues", "none"))?;
    let mut builder = Builder::default();
    for (number, cue) in (1..).zip(cues) {
        // A value of JSON does not know where it stood: its number does instead.
        let wrong = |what: &str, found: Option<&Value>| {
            start.error(format!("{what} in cue {number} of mouthCues"), told(found))
        };
        let secs = |key: &str| {
            let found = cue.get(key);
            found.and_then(Value::as_f64).ok_or_else(|| wrong(&format!("seconds as {key}"), found))
        };
        let symbol = cue.get("value");
        let (viseme, stress) = symbol
            .and_then(Value::as_str)
            .and_then(symbols::rhubarb)
            .ok_or_else(|| wrong("a value from A to H, or X,", symbol))?;
        let cue = Cue { start_secs: secs("start")?, end_secs: secs("end")?, viseme, stress };
        builder.add(start, cue).map_err(|error| SpeechError {
            expected: format!("{} in cue {number} of mouthCues", error.expected),
            ..error
        })?;
    }
    Ok(builder.finish())
}

/// Reads marks, one object a line or all in one list.
pub(super) fn read_marks(text: &str) -> Result<Timeline, SpeechError> {
    let mut builder = Builder::default();
    let mut open: Option<(Place, f64, Viseme)> = None;
    let mut add = |place: Place, mark: &Value, builder: &mut Builder| -> Result<(), SpeechError> {
        let Some((start_secs, viseme)) = mark_of(place, mark)? else { return Ok(()) };
        if let Some((place, before, viseme)) = open.replace((place, start_secs, viseme)) {
            if start_secs < before {
                let expected = format!("a mark after the one before, at {before} s");
                return Err(place.error(expected, format!("{start_secs} s")));
            }
            builder.add(place, cue(before, start_secs, viseme))?;
        }
        Ok(())
    };
    if text.trim_start().starts_with('[') {
        let list = parsed(text, 1)?;
        for (number, mark) in (1..).zip(list.as_array().into_iter().flatten()) {
            add(Place::of_line(1), mark, &mut builder).map_err(|error| SpeechError {
                expected: format!("{} as mark {number}", error.expected),
                ..error
            })?;
        }
    } else {
        for (line, row) in (1..).zip(text.lines()).filter(|(_, row)| !row.trim().is_empty()) {
            add(Place::of_line(line), &parsed(row, line)?, &mut builder)?;
        }
    }
    if let Some((place, start_secs, viseme)) = open {
        let end_secs = if viseme == Viseme::Sil { start_secs } else { start_secs + LAST_SECS };
        builder.add(place, cue(start_secs, end_secs, viseme))?;
    }
    Ok(builder.finish())
}

fn cue(start_secs: f64, end_secs: f64, viseme: Viseme) -> Cue {
    Cue { start_secs, end_secs, viseme, stress: USUAL_STRESS }
}

/// Names of times: in lower case without separators, and how many of their units make a second.
const TIMES: [(&str, f64); 7] = [
    ("time", 1e3),
    ("timems", 1e3),
    ("offsetms", 1e3),
    ("audiooffset", 1e7),
    ("privaudiooffset", 1e7),
    ("offset", 1e7),
    ("start", 1.0),
];

/// The time and viseme of a mark; `None` for a mark of a word or sentence.
fn mark_of(place: Place, mark: &Value) -> Result<Option<(f64, Viseme)>, SpeechError> {
    let map: &Map<String, Value> =
        mark.as_object().ok_or_else(|| place.error("an object of JSON", told(Some(mark))))?;
    if map.get("type").and_then(Value::as_str).is_some_and(|kind| !kind.eq_ignore_ascii_case("viseme")) {
        return Ok(None);
    }
    let plain = |key: &str| -> String {
        key.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase()
    };
    let entry = |names: &[&str]| {
        map.iter().find(|(key, _)| names.contains(&plain(key).as_str())).map(|(_, value)| value)
    };
    let time = TIMES.iter().find_map(|(name, units)| Some((entry(&[name])?, units)));
    let (time, units) = time.ok_or_else(|| place.error("a time, as time, audioOffset or start", "none"))?;
    let start_secs = time.as_f64().ok_or_else(|| place.error("a number as time", told(Some(time))))? / units;
    if let Some(id) = entry(&["visemeid", "privvisemeid", "id"]) {
        let number = id.as_u64().and_then(|number| usize::try_from(number).ok());
        let viseme = number.and_then(|number| symbols::AZURE.get(number));
        let last = symbols::AZURE.len() - 1;
        let viseme = viseme
            .ok_or_else(|| place.error(format!("the number of a viseme, 0 to {last}"), told(Some(id))))?;
        return Ok(Some((start_secs, *viseme)));
    }
    let symbol = entry(&["value", "viseme", "symbol"]);
    let viseme = symbol.and_then(Value::as_str).and_then(|name| {
        // One letter is Polly's, but for those that only Oculus has.
        symbols::polly(name).or_else(|| Viseme::named(name))
    });
    let expected = "a viseme of Polly or Oculus as value, or a visemeId";
    viseme.map(|viseme| Some((start_secs, viseme))).ok_or_else(|| place.error(expected, told(symbol)))
}

fn parsed(text: &str, first_line: usize) -> Result<Value, SpeechError> {
    serde_json::from_str(text).map_err(|error| {
        let line = first_line + error.line().saturating_sub(1);
        Place { line, column: error.column().max(1) }.error("JSON", error.to_string())
    })
}

fn told(value: Option<&Value>) -> String {
    match value {
        None => "none".to_owned(),
        Some(Value::String(text)) => shown(text),
        Some(Value::Array(_)) => "a list".to_owned(),
        Some(Value::Object(_)) => "an object".to_owned(),
        Some(other) => other.to_string(),
    }
}
