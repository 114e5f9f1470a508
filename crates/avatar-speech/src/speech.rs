use crate::ease::ease_between;
use crate::grips::{Grip, grips, held};
use crate::loudness::Loudness;
use crate::mouth::Mouth;
use crate::params::{
    ANTICIPATION, EARLY_SECS, FELT_SOUNDS, GROUPS, MOVE_LEAST_SECS, MOVE_SECS, MOVE_SHARE, PAUSE_SECS,
    REACH_SECS, SHORTEST_SECS, TAKEN, VOICE, target_of,
};
use crate::timeline::{Cue, Timeline};
use crate::viseme::{VISEMES, Viseme};

/// A sound as it is spoken among its neighbours.
#[derive(Clone, Copy, Debug)]
struct Sound {
    start_secs: f64,
    viseme: Viseme,
    /// The vowels around, or silence, which fill in what the sound does not insist on.
    before: Viseme,
    after: Viseme,
    stress: f32,
    /// How much it insists, from 0 to 1, beside what its viseme does: short pauses hardly do.
    insistence: f32,
    /// When each group begins and ends to move to this sound, from its start.
    moves: [[f32; 2]; GROUPS],
}

/// A timeline with coarticulation: the mouth at any time.
///
/// Every moment is a function of the time alone, so the same at any frame rate, forward or backward, and C².
/// Making it takes time and memory with the number of sounds (about 80 bytes each); [`Self::at`] takes a
/// binary search and the sounds within 0.2 s, and allocates nothing.
///
/// ```
/// use avatar_speech::{Articulator, Speech, Timeline};
/// let speech = Speech::new(&Timeline::read("m 80\na 200\nm 90\n_ 300", None)?);
/// let mouth = speech.at(0.04);
/// assert_eq!((mouth.closed, mouth.articulators[Articulator::JawOpen as usize]), (1.0, 0.0));
/// assert!(speech.at(0.17).articulators[Articulator::JawOpen as usize] > 0.3);
/// # Ok::<(), avatar_speech::SpeechError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Speech {
    sounds: Vec<Sound>,
    grips: Vec<Grip>,
    loudness: Option<Loudness>,
    end_secs: f64,
}

impl Speech {
    /// The speech of a timeline.
    pub fn new(timeline: &Timeline) -> Self {
        let cues = with_silence(timeline.cues());
        let grips = grips(&cues);
        let mut sounds: Vec<Sound> = cues
            .iter()
            .enumerate()
            .map(|(index, cue)| Sound {
                start_secs: cue.start_secs,
                viseme: cue.viseme,
                before: felt(cues[..index].iter().rev()),
                after: felt(cues[index + 1..].iter()),
                stress: if cue.viseme == Viseme::Sil { 0.0 } else { cue.stress },
                insistence: match cue.viseme {
                    Viseme::Sil => ((cue.end_secs - cue.start_secs) / PAUSE_SECS).min(1.0).powi(2) as f32,
                    _ => 1.0,
                },
                moves: [[0.0; 2]; GROUPS],
            })
            .collect();
        for group in 0..GROUPS {
            time_moves(&mut sounds, &cues, group);
        }
        Self { sounds, grips, loudness: None, end_secs: timeline.end_secs() }
    }

    /// The same speech with the loudness of its recording, in place of what stresses tell.
    #[must_use]
    pub fn with_loudness(self, loudness: Loudness) -> Self {
        Self { loudness: Some(loudness), ..self }
    }

    /// When the last sound ends. The mouth rests a moment later: [`Self::rest_secs`].
    pub fn end_secs(&self) -> f64 {
        self.end_secs
    }

    /// From when on the mouth is at rest.
    pub fn rest_secs(&self) -> f64 {
        self.end_secs + 2.0 * REACH_SECS
    }

    /// The mouth at a time in seconds; silent before the beginning and after the end, and at a time that is
    /// no number.
    pub fn at(&self, secs: f64) -> Mouth {
        if secs.is_nan() {
            return Mouth::SILENT;
        }
        let mut shares = [[0.0; VISEMES]; GROUPS];
        let mut stress = 0.0;
        // Sounds that began long ago are over but for the last of them; those far ahead have not begun.
        let first =
            self.sounds.partition_point(|sound| sound.start_secs < secs - REACH_SECS).saturating_sub(1);
        let nearby = self.sounds[first..].iter().take_while(|sound| sound.start_secs <= secs + REACH_SECS);
        let mut arrived = [1.0; GROUPS];
        let mut last: Option<&Sound> = None;
        for sound in nearby {
            if let Some(last) = last {
                let mut entered = [0.0; GROUPS];
                for ((entered, [from, to]), arrived) in entered.iter_mut().zip(sound.moves).zip(arrived) {
                    let since = secs - sound.start_secs;
                    // By rounding of its ends a move can be ahead of the one before by the last bit.
                    *entered = ease_between(from.into(), to.into(), since).min(arrived);
                }
                last.add(&arrived, &entered, &mut shares, &mut stress);
                arrived = entered;
            }
            last = Some(sound);
        }
        match last {
            Some(last) => last.add(&arrived, &[0.0; GROUPS], &mut shares, &mut stress),
            None => return Mouth::SILENT,
        }
        let [closed, bitten] = held(&self.grips, secs);
        let loudness = self.loudness.as_ref().map_or(stress, |loudness| loudness.at(secs));
        Mouth::of_groups(&shares, closed, bitten, loudness)
    }
}

impl Sound {
    /// Adds what is left of this sound once the next one has been entered so far.
    fn add(
        &self,
        arrived: &[f64; GROUPS],
        entered: &[f64; GROUPS],
        shares: &mut [[f64; VISEMES]; GROUPS],
        stress: &mut f64,
    ) {
        let dominance = &target_of(self.viseme).dominance;
        *stress += (arrived[VOICE] - entered[VOICE]) * f64::from(self.stress);
        for group in 0..VOICE {
            let share = arrived[group] - entered[group];
            if share <= 0.0 {
                continue;
            }
            let own = dominance[group] * f64::from(self.insistence);
            let others = share * (1.0 - own);
            let shares = &mut shares[group];
            shares[self.viseme.index()] += share * own;
            shares[self.after.index()] += others * ANTICIPATION;
            shares[self.before.index()] += others * (1.0 - ANTICIPATION);
        }
    }
}

/// Sounds without a gap between them, from silence before the first to silence behind the last; none so short
/// that nobody could speak it.
fn with_silence(cues: &[Cue]) -> Vec<Cue> {
    let silence = |start_secs, end_secs| Cue { start_secs, end_secs, viseme: Viseme::Sil, stress: 0.0 };
    let mut all: Vec<Cue> = Vec::with_capacity(2 * cues.len() + 2);
    let mut add = |cue: Cue| {
        let Some(last) = all.last_mut() else { return all.push(cue) };
        let is_short = cue.end_secs - cue.start_secs < SHORTEST_SECS;
        let is_silence_still = cue.viseme == last.viseme && cue.viseme == Viseme::Sil;
        if is_silence_still || (is_short && !is_gripping(cue.viseme)) {
            last.end_secs = cue.end_secs;
        } else if cue.start_secs - last.start_secs < SHORTEST_SECS {
            // Of two sounds in the time of one, the one that holds the lips is seen.
            match is_gripping(last.viseme) {
                true => last.end_secs = cue.end_secs,
                false => *last = Cue { start_secs: last.start_secs, ..cue },
            }
        } else {
            all.push(cue);
        }
    };
    let first = cues.first().map_or(0.0, |cue| cue.start_secs);
    add(silence(first - 1.0, first));
    let mut until = first;
    for cue in cues {
        if cue.start_secs > until {
            add(silence(until, cue.start_secs));
        }
        add(*cue);
        until = cue.end_secs;
    }
    add(silence(until, until + 1.0));
    all
}

/// Whether a sound holds the lips whatever the rate.
fn is_gripping(viseme: Viseme) -> bool {
    matches!(viseme, Viseme::PP | Viseme::FF)
}

/// The next vowel of these sounds; silence if there is none near, or a pause before it.
fn felt<'a>(sounds: impl Iterator<Item = &'a Cue>) -> Viseme {
    for cue in sounds.take(FELT_SOUNDS) {
        let is_pause = cue.viseme == Viseme::Sil && cue.end_secs - cue.start_secs >= PAUSE_SECS;
        if cue.viseme.is_vowel() || is_pause {
            return cue.viseme;
        }
    }
    Viseme::Sil
}

/// Finds when a group moves to each sound. Movements may lie over each other, but none begins or ends before
/// one that comes earlier: so shares of sounds are never below 0, and their sum is 1.
fn time_moves(sounds: &mut [Sound], cues: &[Cue], group: usize) {
    let mut earlier: Option<[f64; 2]> = None;
    for index in 1..sounds.len() {
        let length = |cue: &Cue| cue.end_secs - cue.start_secs;
        let [from, to] = [length(&cues[index - 1]), length(&cues[index])];
        let insists = |sound: &Sound| target_of(sound.viseme).dominance[group] * f64::from(sound.insistence);
        let more = insists(&sounds[index]) - insists(&sounds[index - 1]);
        let shift = -TAKEN * more * from.min(to).min(MOVE_SECS[group]);
        let between = MOVE_SHARE[group] * (from + to) / 2.0;
        let move_secs = between.clamp(MOVE_LEAST_SECS[group], MOVE_SECS[group]);
        let middle = shift - EARLY_SECS[group];
        let start = sounds[index].start_secs;
        let least = start - REACH_SECS;
        let [begin, end] = [middle - move_secs / 2.0, middle + move_secs / 2.0].map(|offset| start + offset);
        let [before_begin, before_end] = earlier.unwrap_or([least; 2]);
        let begin = begin.clamp(least, start + REACH_SECS).max(before_begin);
        let end = end.min(start + REACH_SECS).max(before_end).max(begin + SHORTEST_SECS);
        sounds[index].moves[group] = [begin, end].map(|secs| (secs - start) as f32);
        earlier = Some([begin, end]);
    }
}
