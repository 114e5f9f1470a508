use crate::error::{Place, SpeechError, shown};
use crate::read::letters::sounds_of;
use crate::timeline::{Builder, Cue, Timeline, USUAL_STRESS};
use crate::viseme::Viseme;

/// How long a pause between words is, beside a vowel's 1.3; and the one at the end of a sentence.
const BETWEEN_WORDS: f64 = 0.25;
const BETWEEN_SENTENCES: f64 = 2.0;
/// A sound of ordinary speech lasts about so long at most: slow subtitles end in silence instead of drawling.
const LONGEST_UNIT_SECS: f64 = 0.11;

/// Reads subtitles and guesses sounds by letters, spread over the time of each text.
pub(super) fn read(text: &str) -> Result<Timeline, SpeechError> {
    let mut builder = Builder::default();
    let mut lines = (1..).zip(text.lines()).peekable();
    let mut count = 0_usize;
    while let Some((line, row)) = lines.next() {
        let Some((start, end)) = row.split_once("-->") else { continue };
        let end = end.split_whitespace().next().unwrap_or_default();
        let place = Place::of_line(line);
        let secs = |text: &str| {
            let expected = "a time such as 00:01:02,500";
            seconds(text.trim()).ok_or_else(|| place.error(expected, shown(text)))
        };
        let (start_secs, end_secs) = (secs(start)?, secs(end)?);
        let mut sounds = Vec::new();
        // A text lasts until an empty line.
        while let Some((_, spoken)) = lines.next_if(|(_, row)| !row.trim().is_empty()) {
            add_line(spoken, &mut sounds);
        }
        count += 1;
        spread(&mut builder, place, [start_secs, end_secs], &sounds)?;
    }
    match count {
        0 => {
            Err(Place::of_line(1).error("subtitles with lines such as 00:00:01,000 --> 00:00:02,500", "none"))
        }
        _ => Ok(builder.finish()),
    }
}

/// The sounds of a line of text, without tags in angle brackets or braces, and what is no speech in
/// brackets.
fn add_line(spoken: &str, sounds: &mut Vec<(Viseme, f64)>) {
    let mut depth = 0_usize;
    let mut plain = String::with_capacity(spoken.len());
    for letter in spoken.chars() {
        match letter {
            '<' | '{' | '[' | '(' => depth += 1,
            '>' | '}' | ']' | ')' => depth = depth.saturating_sub(1),
            letter if depth == 0 => plain.push(letter),
            _ => {}
        }
    }
    for word in plain.split_whitespace() {
        sounds_of(word, |viseme, share| sounds.push((viseme, share)));
        let pause = if word.ends_with(['.', '!', '?', '…']) { BETWEEN_SENTENCES } else { BETWEEN_WORDS };
        sounds.push((Viseme::Sil, pause));
    }
}

fn spread(
    builder: &mut Builder,
    place: Place,
    [start_secs, end_secs]: [f64; 2],
    sounds: &[(Viseme, f64)],
) -> Result<(), SpeechError> {
    let whole: f64 = sounds.iter().map(|(_, share)| share).sum();
    let unit_secs = ((end_secs - start_secs) / whole.max(1.0)).min(LONGEST_UNIT_SECS);
    let mut at = start_secs;
    // Also without any sound, so that times are checked.
    builder
        .add(place, Cue { start_secs, end_secs: start_secs, viseme: Viseme::Sil, stress: USUAL_STRESS })?;
    if end_secs < start_secs {
        return Err(place.error(format!("an end after the start, {start_secs} s"), format!("{end_secs} s")));
    }
    for &(viseme, share) in sounds {
        let until = (at + share * unit_secs).min(end_secs);
        // Pauses between words are heard in the lips only where a sentence ends.
        if viseme != Viseme::Sil || share > BETWEEN_WORDS {
            builder.add(place, Cue { start_secs: at, end_secs: until, viseme, stress: USUAL_STRESS })?;
        } else {
            builder.prolong(until);
        }
        at = until;
    }
    Ok(())
}

/// `HH:MM:SS,mmm`, `MM:SS.mmm`.
fn seconds(text: &str) -> Option<f64> {
    let text = text.replace(',', ".");
    let parts = text.split(':').count();
    if !(2..=3).contains(&parts) {
        return None;
    }
    text.split(':').try_fold(0.0, |sum, part| {
        let number: f64 = part.parse().ok().filter(|number: &f64| (0.0..1e6).contains(number))?;
        Some(sum * 60.0 + number)
    })
}
