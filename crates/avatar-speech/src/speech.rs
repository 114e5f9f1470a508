use crate::ease::ease;
use crate::grips::{Grip, grips, held};
use crate::loudness::Loudness;
use crate::mouth::Mouth;
use crate::params::{
    ANTICIPATION, EARLY_SECS, FELT_SOUNDS, GROUPS, MOVE_LEAST_SECS, MOVE_SECS, MOVE_SHARE, PAUSE_SECS,
    REACH_SECS, SHORTEST_SECS, TAKEN, UTTERANCE_PAUSE_SECS, VOICE, target_of,
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
    begins: [f32; GROUPS],
    ends: [f32; GROUPS],
    /// The first of the former, and the last of the latter.
    begin: f32,
    end: f32,
    /// How many grips are held before it starts.
    grips: u32,
}

/// Where in time the sounds are: for each of as many equal times as there are sounds, how many start before.
#[derive(Clone, Debug, Default)]
struct Starts {
    first_secs: f64,
    per_sec: f64,
    before: Vec<u32>,
}

/// A timeline with coarticulation: the mouth at any time.
///
/// Every moment is a function of the time alone, so the same at any frame rate, forward or backward, and C².
/// Making it takes time and memory with the number of sounds (about 90 bytes each); [`Self::at`] looks up
/// where in time it is and goes through the sounds within 0.2 s, and allocates nothing.
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
    starts: Starts,
    grips: Vec<Grip>,
    loudness: Option<Loudness>,
    utterances: Vec<[f64; 2]>,
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
                begins: [0.0; GROUPS],
                ends: [0.0; GROUPS],
                begin: 0.0,
                end: 0.0,
                grips: grips.partition_point(|grip| grip.held_secs() <= cue.start_secs) as u32,
            })
            .collect();
        for group in 0..GROUPS {
            time_moves(&mut sounds, &cues, group);
        }
        for sound in &mut sounds {
            sound.begin = sound.begins.into_iter().fold(f32::INFINITY, f32::min);
            sound.end = sound.ends.into_iter().fold(f32::NEG_INFINITY, f32::max);
        }
        let starts = Starts::of(&sounds);
        let utterances = utterances(&cues);
        Self { sounds, starts, grips, loudness: None, utterances, end_secs: timeline.end_secs() }
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

    /// Beginnings and ends in seconds of what is said between longer pauses, in the order of time.
    pub fn utterances(&self) -> &[[f64; 2]] {
        &self.utterances
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
        let first = self.starts.before(secs - REACH_SECS, &self.sounds).saturating_sub(1);
        let mut nearby =
            self.sounds[first..].iter().take_while(|sound| sound.start_secs <= secs + REACH_SECS);
        let Some(mut last) = nearby.next() else { return Mouth::SILENT };
        let mut grips = last.grips;
        let mut arrived = [1.0; GROUPS];
        let mut is_whole = true;
        for sound in nearby {
            let since = secs - sound.start_secs;
            if since <= f64::from(sound.begin) {
                // Nothing moves to this sound yet, nor to any behind it.
                break;
            }
            // A sound that is entered in full leaves nothing of the one before.
            let is_entered = since >= f64::from(sound.end);
            if !(is_whole && is_entered) {
                let entered = sound.entered(since, &arrived);
                last.add(&arrived, &entered, &mut shares, &mut stress);
                (arrived, is_whole) = (entered, false);
            }
            last = sound;
            if since >= 0.0 {
                grips = sound.grips;
            }
        }
        last.add(&arrived, &[0.0; GROUPS], &mut shares, &mut stress);
        let [closed, bitten] = held(&self.grips, grips as usize, secs);
        let loudness = self.loudness.as_ref().map_or(stress, |loudness| loudness.at(secs));
        Mouth::of_groups(&shares, closed, bitten, loudness)
    }
}

impl Starts {
    fn of(sounds: &[Sound]) -> Self {
        let (Some(first), Some(last)) = (sounds.first(), sounds.last()) else { return Self::default() };
        let span_secs = last.start_secs - first.start_secs;
        let per_sec = if span_secs > 0.0 { sounds.len() as f64 / span_secs } else { 0.0 };
        let (mut before, mut count) = (Vec::with_capacity(sounds.len() + 1), 0);
        for place in 0..=sounds.len() {
            let secs = first.start_secs + place as f64 / per_sec;
            while sounds.get(count).is_some_and(|sound| sound.start_secs < secs) {
                count += 1;
            }
            before.push(count as u32);
        }
        Self { first_secs: first.start_secs, per_sec, before }
    }

    /// How many sounds start before this time: a search among those of one of the equal times, which are one
    /// or two where sounds are about as long as each other.
    fn before(&self, secs: f64, sounds: &[Sound]) -> usize {
        // Casts take what is below 0 as 0.
        let place = ((secs - self.first_secs) * self.per_sec) as usize;
        let at = |place: usize| self.before.get(place).map_or(sounds.len(), |count| *count as usize);
        let (low, high) = (at(place), at(place.saturating_add(1)));
        let mut count =
            low + sounds.get(low..high).map_or(0, |few| few.partition_point(|it| it.start_secs < secs));
        // What rounding did to the place.
        while count > 0 && sounds.get(count - 1).is_some_and(|sound| sound.start_secs >= secs) {
            count -= 1;
        }
        while sounds.get(count).is_some_and(|sound| sound.start_secs < secs) {
            count += 1;
        }
        count
    }
}

impl Sound {
    /// How far each group has moved to this sound, a time after its start.
    fn entered(&self, since_secs: f64, arrived: &[f64; GROUPS]) -> [f64; GROUPS] {
        let mut entered = [0.0; GROUPS];
        for group in 0..GROUPS {
            let (from, to) = (f64::from(self.begins[group]), f64::from(self.ends[group]));
            // Without branches, which nothing foretells: `ease` is 0 before the move and 1 after it. By
            // rounding of its ends a move can be ahead of the one before by the last bit.
            let own = ease((since_secs - from) / (to - from));
            entered[group] = if own < arrived[group] { own } else { arrived[group] };
        }
        entered
    }

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

/// What is said between pauses that are long enough to end it.
fn utterances(cues: &[Cue]) -> Vec<[f64; 2]> {
    let mut all: Vec<[f64; 2]> = Vec::new();
    for cue in cues.iter().filter(|cue| cue.viseme != Viseme::Sil) {
        match all.last_mut() {
            Some([_, end]) if cue.start_secs - *end < UTTERANCE_PAUSE_SECS => *end = cue.end_secs,
            _ => all.push([cue.start_secs, cue.end_secs]),
        }
    }
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
        sounds[index].begins[group] = (begin - start) as f32;
        sounds[index].ends[group] = (end - start) as f32;
        earlier = Some([begin, end]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ease::ease_between;

    /// The mouth by the formulas alone: every sound at its turn, whatever the time is.
    fn plainly(speech: &Speech, secs: f64) -> Mouth {
        let mut shares = [[0.0; VISEMES]; GROUPS];
        let (mut stress, mut arrived) = (0.0, [1.0; GROUPS]);
        for (sound, next) in speech.sounds.iter().zip(speech.sounds.iter().skip(1).map(Some).chain([None])) {
            let mut entered = [0.0; GROUPS];
            if let Some(next) = next {
                for (group, entered) in entered.iter_mut().enumerate() {
                    let (from, to) = (next.begins[group].into(), next.ends[group].into());
                    *entered = ease_between(from, to, secs - next.start_secs).min(arrived[group]);
                }
            }
            sound.add(&arrived, &entered, &mut shares, &mut stress);
            arrived = entered;
        }
        let [closed, bitten] = held(&speech.grips, 0, secs);
        Mouth::of_groups(&shares, closed, bitten, stress)
    }

    #[test]
    fn shortcuts_change_no_bit() {
        let mut state = 3u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1u64 << 24) as f64
        };
        for (count, longest) in [(0, 0.1), (1, 0.1), (40, 0.03), (60, 0.1), (60, 0.4), (30, 300.0)] {
            let mut until = 0.0;
            let cues: Vec<Cue> = (0..count)
                .map(|_| {
                    // Gaps, and now and then a sound a hundred times as long as others.
                    let gap = if random() < 0.2 { random() * longest } else { 0.0 };
                    let much = if random() < 0.05 { 100.0 } else { 1.0 };
                    let start_secs = until + gap;
                    until = start_secs + (0.2 + 0.8 * random()) * longest * much;
                    let viseme = Viseme::ALL[(random() * 14.99) as usize];
                    Cue { start_secs, end_secs: until, viseme, stress: random() as f32 }
                })
                .collect();
            let timeline = Timeline::new(cues.iter().copied()).expect("sounds in order");
            let speech = Speech::new(&timeline);
            let ends = cues.iter().flat_map(|cue| [cue.start_secs, cue.end_secs]).collect::<Vec<_>>();
            let near =
                ends.iter().flat_map(|secs| [-0.2, -1e-9, 0.0, 1e-9, 0.07, 0.2].map(|more| secs + more));
            let anywhere = (0..2000).map(|_| random() * (until + 2.0) - 1.0).collect::<Vec<_>>();
            for secs in near.chain(anywhere).chain([-1e300, 1e300, f64::INFINITY]) {
                let (found, expected) = (speech.at(secs), plainly(&speech, secs));
                assert_eq!(found, expected, "at {secs} of {count} sounds up to {longest} s");
            }
        }
    }
}
