use crate::error::Place;
use crate::viseme::Viseme;
use crate::{Note, SpeechError};

/// A longer timeline is refused: two days.
const MAX_SECS: f64 = 172_800.0;
/// So many cues are kept: ten hours of quick speech have half a million.
const MAX_CUES: usize = 4_000_000;
/// So many notes are kept; the rest is counted.
const MAX_NOTES: usize = 20;
/// Cues that lie over each other by less than this were rounded.
const ROUNDED_SECS: f64 = 0.0015;

/// One sound and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cue {
    /// Its beginning, in seconds.
    pub start_secs: f64,
    /// Its end, where the next one begins at the earliest.
    pub end_secs: f64,
    /// What it looks like.
    pub viseme: Viseme,
    /// How strongly it is spoken, from 0 to 1: 0.5 is a syllable without stress, 1 one that is shouted. It
    /// stands in for the loudness where that is not known.
    pub stress: f32,
}

/// Stress of a sound of which nothing is known.
pub(crate) const USUAL_STRESS: f32 = 0.5;

/// Sounds in the order of their times, none over another. Between them is silence.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timeline {
    cues: Vec<Cue>,
    notes: Vec<Note>,
    more_notes: usize,
}

impl Timeline {
    /// A timeline of these sounds.
    ///
    /// # Errors
    /// A time that is not finite, below 0 or beyond two days, an end before its start, or a start before the
    /// one of the sound before; the place is that in the list, counted as lines from 1. Where sounds lie over
    /// each other the earlier one is cut, with a note.
    pub fn new(cues: impl IntoIterator<Item = Cue>) -> Result<Self, SpeechError> {
        let mut builder = Builder::default();
        for (line, cue) in (1..).zip(cues) {
            builder.add(Place::of_line(line), cue)?;
        }
        Ok(builder.finish())
    }

    /// The sounds.
    pub fn cues(&self) -> &[Cue] {
        &self.cues
    }

    /// What was passed over or put right, the first twenty.
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// How many notes there were beyond those of [`Self::notes`].
    pub fn further_notes(&self) -> usize {
        self.more_notes
    }

    /// The end of the last sound, in seconds.
    pub fn end_secs(&self) -> f64 {
        self.cues.last().map_or(0.0, |cue| cue.end_secs)
    }
}

/// A timeline while it is read.
#[derive(Debug, Default)]
pub(crate) struct Builder {
    timeline: Timeline,
}

impl Builder {
    pub(crate) fn note(&mut self, place: Place, text: String) {
        match self.timeline.notes.len() < MAX_NOTES {
            true => self.timeline.notes.push(Note { line: place.line, text }),
            false => self.timeline.more_notes += 1,
        }
    }

    /// Adds a sound behind the others. One without a duration is left out.
    pub(crate) fn add(&mut self, place: Place, cue: Cue) -> Result<(), SpeechError> {
        let Cue { start_secs, end_secs, .. } = cue;
        let is_time = |secs: f64| (0.0..=MAX_SECS).contains(&secs);
        if !is_time(start_secs) || !is_time(end_secs) {
            let found = if is_time(start_secs) { end_secs } else { start_secs };
            return Err(place.error(format!("a time from 0 to {MAX_SECS} s"), format!("{found} s")));
        }
        if end_secs < start_secs {
            let expected = format!("an end after the start, {start_secs} s");
            return Err(place.error(expected, format!("{end_secs} s")));
        }
        let cues = &mut self.timeline.cues;
        if let Some(last) = cues.last_mut() {
            let Cue { start_secs: before, end_secs: until, .. } = *last;
            if start_secs < before {
                let expected = format!("a start after that of the sound before, {before} s");
                return Err(place.error(expected, format!("{start_secs} s")));
            }
            if start_secs < until {
                last.end_secs = start_secs;
                if last.end_secs <= last.start_secs {
                    cues.pop();
                }
                if until - start_secs > ROUNDED_SECS {
                    let text =
                        format!("this sound begins at {start_secs} s, before the end of the one before");
                    self.note(place, format!("{text} at {until} s, which is cut"));
                }
            }
        }
        if end_secs > start_secs {
            if self.timeline.cues.len() >= MAX_CUES {
                return Err(place.error(format!("at most {MAX_CUES} sounds"), "more"));
            }
            let stress = if cue.stress.is_nan() { USUAL_STRESS } else { cue.stress.clamp(0.0, 1.0) };
            self.timeline.cues.push(Cue { stress, ..cue });
        }
        Ok(())
    }

    /// Lets the last sound go on, over one that is not known.
    pub(crate) fn prolong(&mut self, until_secs: f64) {
        if let Some(last) = self.timeline.cues.last_mut()
            && until_secs.is_finite()
            && until_secs <= MAX_SECS
        {
            last.end_secs = last.end_secs.max(until_secs);
        }
    }

    pub(crate) fn finish(self) -> Timeline {
        self.timeline
    }
}
