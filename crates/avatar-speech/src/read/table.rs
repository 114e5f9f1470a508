use super::{number, symbols};
use crate::error::{Place, SpeechError, shown};
use crate::timeline::{Builder, Cue, Timeline, USUAL_STRESS};
use crate::viseme::Viseme;

fn fields(line: &str) -> impl Iterator<Item = &str> {
    let separates = |c: char| c == ',' || c == ';' || c.is_whitespace();
    line.split(separates).filter(|field| !field.is_empty())
}

/// Whether a line looks like a time and the name of a mouth.
pub(super) fn is_row(line: &str) -> bool {
    let mut fields = fields(line);
    let is_time = fields.next().and_then(number).is_some();
    let is_mouth = |name: &str| symbols::rhubarb(name).is_some() || Viseme::named(name).is_some();
    is_time && fields.next().is_some_and(is_mouth)
}

/// Reads rows of a time and a mouth; each mouth lasts until the next row. The last row ends the timeline.
///
/// An E is a mouth of both: the table is one of Oculus's visemes if it has any that Rhubarb does not know.
pub(super) fn read(text: &str) -> Result<Timeline, SpeechError> {
    let rows = || (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    let names = || rows().filter_map(|(_, line)| fields(line).nth(1));
    let is_oculus = |name: &str| symbols::rhubarb(name).is_none() && Viseme::named(name).is_some();
    let is_rhubarb = !names().any(is_oculus);
    let mut builder = Builder::default();
    let mut open: Option<(Place, Cue)> = None;
    for (line, row) in rows() {
        let mut fields = fields(row);
        let time = fields.next().unwrap_or_default();
        let place = Place::in_line(line, row, time);
        let start_secs = number(time).ok_or_else(|| place.error("seconds", shown(time)))?;
        let name = fields.next().unwrap_or_default();
        let at_name = if name.is_empty() { place } else { Place::in_line(line, row, name) };
        let (viseme, usual) = match is_rhubarb {
            true => symbols::rhubarb(name),
            false => Viseme::named(name).map(|viseme| (viseme, USUAL_STRESS)),
        }
        .ok_or_else(|| {
            at_name.error("a mouth of Rhubarb (A to H, X) or a viseme of Oculus (sil, PP … U)", shown(name))
        })?;
        let stress = match fields.next() {
            None => usual,
            Some(text) => {
                let is_share = |number: &f64| (0.0..=1.0).contains(number);
                let stress = number(text).filter(is_share).ok_or_else(|| {
                    Place::in_line(line, row, text).error("a strength from 0 to 1", shown(text))
                })?;
                stress as f32
            }
        };
        if let Some((place, cue)) = open.take() {
            builder.add(place, Cue { end_secs: start_secs, ..cue })?;
        }
        open = Some((place, Cue { start_secs, end_secs: start_secs, viseme, stress }));
    }
    // The last row is the end; it is added for the check of its time.
    if let Some((place, cue)) = open {
        builder.add(place, cue)?;
    }
    Ok(builder.finish())
}
