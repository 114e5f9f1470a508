use super::number;
use crate::error::{Place, SpeechError, shown};
use crate::phone::Alphabet;
use crate::read::letters::add_phone;
use crate::timeline::{Builder, Timeline};

/// HTK counts in units of 100 ns.
const UNITS_PER_SEC: f64 = 1e7;

/// An interval and its phone.
struct Label<'a> {
    place: Place,
    start_secs: f64,
    end_secs: f64,
    symbol: &'a str,
}

/// Reads labels of phones in one of the layouts of [`super::Format::Labels`].
pub(super) fn read(text: &str) -> Result<Timeline, SpeechError> {
    let rows = || (1..).zip(text.lines()).filter(|(_, line): &(usize, &str)| !line.trim().is_empty());
    let has_header = rows().any(|(_, line)| line.trim() == "#");
    let first = rows().map(|(_, line)| line).find(|line| !line.starts_with(';')).unwrap_or_default();
    let starts_with_phone = first.split_whitespace().next().is_some_and(|field| number(field).is_none());
    let labels = if has_header {
        behind_header(rows().skip_while(|(_, line)| line.trim() != "#").skip(1))?
    } else if starts_with_phone {
        durations(rows().filter(|(_, line)| !line.trim_start().starts_with(';')))?
    } else {
        intervals(rows())?
    };
    let (alphabet, _) = Alphabet::of(labels.iter().map(|label| label.symbol));
    let mut builder = Builder::default();
    for Label { place, start_secs, end_secs, symbol } in labels {
        add_phone(&mut builder, place, [start_secs, end_secs], symbol, alphabet)?;
    }
    Ok(builder.finish())
}

fn wanted(line: usize, row: &str, field: Option<&str>, what: &str) -> Result<f64, SpeechError> {
    let place = field.map_or(Place::of_line(line), |field| Place::in_line(line, row, field));
    let value = field.and_then(number).filter(|value| *value >= 0.0);
    value.ok_or_else(|| place.error(what, shown(field.unwrap_or_default())))
}

/// Start, end, phone.
fn intervals<'a>(
    rows: impl Iterator<Item = (usize, &'a str)> + Clone,
) -> Result<Vec<Label<'a>>, SpeechError> {
    let is_whole = |field: &str| field.bytes().all(|byte| byte.is_ascii_digit());
    let are_units = rows.clone().all(|(_, row)| row.split_whitespace().take(2).all(is_whole));
    let scale = if are_units { UNITS_PER_SEC.recip() } else { 1.0 };
    rows.map(|(line, row)| {
        let mut fields = row.split_whitespace();
        let (start, end) = (fields.next(), fields.next());
        let start_secs = wanted(line, row, start, "the start of a phone")? * scale;
        let end_secs = wanted(line, row, end, "the end of a phone")? * scale;
        let symbol = context_free(fields.next().unwrap_or_default());
        Ok(Label { place: Place::of_line(line), start_secs, end_secs, symbol })
    })
    .collect()
}

/// End, a number, phone.
fn behind_header<'a>(rows: impl Iterator<Item = (usize, &'a str)>) -> Result<Vec<Label<'a>>, SpeechError> {
    let mut start_secs = 0.0;
    rows.map(|(line, row)| {
        let mut fields = row.split_whitespace();
        let end_secs = wanted(line, row, fields.next(), "the end of a phone in seconds")?;
        let symbol = fields.nth(1).unwrap_or_default();
        if end_secs < start_secs {
            let expected = format!("an end after the one before, {start_secs} s");
            return Err(Place::of_line(line).error(expected, format!("{end_secs} s")));
        }
        let label = Label { place: Place::of_line(line), start_secs, end_secs, symbol };
        start_secs = end_secs;
        Ok(label)
    })
    .collect()
}

/// Phone, milliseconds, and the pitch, which is passed over.
fn durations<'a>(rows: impl Iterator<Item = (usize, &'a str)>) -> Result<Vec<Label<'a>>, SpeechError> {
    let mut start_secs = 0.0;
    rows.map(|(line, row)| {
        let mut fields = row.split_whitespace();
        let symbol = fields.next().unwrap_or_default();
        let what = "a phone and its milliseconds, or start, end and phone";
        let end_secs = start_secs + wanted(line, row, fields.next(), what)? / 1e3;
        let label = Label { place: Place::of_line(line), start_secs, end_secs, symbol };
        start_secs = end_secs;
        Ok(label)
    })
    .collect()
}

/// The phone of a label with its neighbours, as HTK writes it: `l-PHONE+r`, and what full labels have before
/// and behind it (`ll^l-PHONE+r=rr@…`).
fn context_free(symbol: &str) -> &str {
    let Some((before, after)) = symbol.split_once('+') else { return symbol };
    match (before.rsplit_once('-'), after.is_empty()) {
        (Some((_, phone)), false) if !phone.is_empty() => phone,
        (None, false) if !before.is_empty() => before,
        _ => symbol,
    }
}
