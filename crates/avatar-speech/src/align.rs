use crate::error::{Place, shown};
use crate::params::{
    ALIGN_LEAST, ALIGN_MOST_FRAMES, ALIGN_SPREAD, ALIGN_STOP, ALIGN_WINDOW, HEARD_STEP_SECS,
};
use crate::phone::Alphabet;
use crate::timeline::{Builder, Cue, USUAL_STRESS};
use crate::viseme::{VISEMES, Viseme};
use crate::{Note, Timeline};
use std::ops::RangeInclusive;

/// What is said, without times: the sounds of a text in order, and where somebody may pause.
///
/// [`Self::align`] finds the times in a recording of it. So a mouth moves by the sounds that are known, and
/// not by those that a recogniser takes them for.
///
/// ```
/// use avatar_speech::Phones;
/// // As `espeak-ng -q --ipa --sep=_` writes it: a line for each clause.
/// let (phones, notes) = Phones::read("h_ə_l_ˈoʊ\nm_ˈɑː_m_ə");
/// assert_eq!((phones.sounds().len(), notes.len()), (9, 0));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Phones {
    states: Vec<State>,
}

/// A sound, or a pause that may be left out.
#[derive(Clone, Copy, Debug, PartialEq)]
struct State {
    viseme: Viseme,
    stress: f32,
    /// How long it usually is beside the others.
    usual: f32,
}

/// Marks of length.
const LONG: [char; 3] = ['ː', ':', 'ˑ'];

impl Phones {
    /// Reads phones in IPA, SAMPA or ARPABET, apart by spaces or `_`; a new line is a pause that may be made.
    /// What stands in brackets, as espeak-ng's marks of another language do, is passed over, and phones that
    /// are not known are, with a note.
    pub fn read(text: &str) -> (Self, Vec<Note>) {
        let symbols = |line: &str| -> Vec<String> {
            let parts = line.split(['_', ' ', '\t']).map(|part| match (part.find('('), part.rfind(')')) {
                (Some(from), Some(to)) if from < to => format!("{}{}", &part[..from], &part[to + 1..]),
                _ => part.to_owned(),
            });
            parts.filter(|part| !part.is_empty()).collect()
        };
        let lines: Vec<Vec<String>> = text.lines().map(symbols).collect();
        let (alphabet, _) = Alphabet::of(lines.iter().flatten().map(String::as_str));
        let (mut states, mut notes, mut last) = (vec![State::PAUSE], Builder::default(), 0);
        let symbols =
            (1..).zip(&lines).flat_map(|(line, symbols)| symbols.iter().map(move |own| (line, own)));
        for (number, symbol) in symbols {
            if states.len() > 1 && last < number {
                states.push(State::PAUSE);
            }
            last = number;
            let Some(phone) = alphabet.phone(symbol) else {
                let text = format!("{} is no phone that is known: it is passed over", shown(symbol));
                notes.note(Place::of_line(number), text);
                continue;
            };
            let is_long = symbol.contains(LONG);
            let stress = phone.stress.unwrap_or(USUAL_STRESS);
            let parts = if phone.second.is_some() { 0.6 } else { 1.0 };
            for viseme in [Some(phone.first), phone.second].into_iter().flatten() {
                let usual = parts * usual_of(viseme) * if is_long { 1.5 } else { 1.0 };
                states.push(State { viseme, stress, usual });
            }
        }
        states.push(State::PAUSE);
        (Self { states }, notes.finish().notes().to_vec())
    }

    /// The sounds in order, without the pauses.
    pub fn sounds(&self) -> Vec<Viseme> {
        self.spoken().map(|state| state.viseme).collect()
    }

    fn spoken(&self) -> impl Iterator<Item = &State> {
        self.states.iter().filter(|state| state.viseme != Viseme::Sil)
    }

    /// Finds when each sound is in a recording that says these and nothing else: of all ways to lay them one
    /// behind the other over the frames of a recogniser (a hundred a second, the first at this time, weights
    /// in the order of [`Viseme::ALL`]), the one in which what is heard and how long sounds usually are fit
    /// best. Dynamic programming, as speech is aligned since Sakoe and Chiba (1978), with durations (Levinson
    /// 1986). Takes time and memory with the sounds, not with their square. Where there are more sounds than
    /// frames, the result is empty.
    pub fn align(&self, frames: &[[f32; VISEMES]], first_secs: f64) -> Timeline {
        let ends = best_ends(&self.states, frames).unwrap_or_default();
        let mut builder = Builder::default();
        let secs = |frame: usize| (first_secs + (frame as f64 - 0.5) * HEARD_STEP_SECS).max(0.0);
        let mut from = 0;
        for (number, (state, to)) in (1..).zip(self.states.iter().zip(ends)) {
            let State { viseme, stress, .. } = *state;
            if to > from {
                let cue = Cue { start_secs: secs(from), end_secs: secs(to), viseme, stress };
                // Times rise, so none is refused, but for those of a recording of days.
                if builder.add(Place::of_line(number), cue).is_err() {
                    break;
                }
            }
            from = to;
        }
        builder.finish()
    }
}

impl State {
    const PAUSE: Self = Self { viseme: Viseme::Sil, stress: 0.0, usual: 0.0 };
}

/// How long a sound usually is, in hundredths of a second at an ordinary rate (Klatt 1976; Crystal and House
/// 1988, rounded).
fn usual_of(viseme: Viseme) -> f32 {
    match viseme {
        Viseme::Sil => 0.0,
        Viseme::FF | Viseme::CH | Viseme::SS => 10.0,
        Viseme::Aa | Viseme::O => 10.0,
        Viseme::E | Viseme::I | Viseme::U => 8.0,
        Viseme::PP | Viseme::KK | Viseme::DD => 7.5,
        Viseme::TH | Viseme::NN | Viseme::RR => 6.0,
    }
}

/// How well a frame fits a sound. The stop of p, t and k is a moment of silence.
fn fit(viseme: Viseme, weights: &[f32; VISEMES]) -> f32 {
    let mut weight = weights[viseme.index()];
    if matches!(viseme, Viseme::PP | Viseme::DD | Viseme::KK) {
        weight = weight.max(ALIGN_STOP * weights[Viseme::Sil.index()]);
    }
    let weight = if weight > 0.0 { weight.min(1.0) } else { 0.0 };
    (ALIGN_LEAST + (1.0 - ALIGN_LEAST) * weight).ln()
}

/// For each frame from `first` on at which a state may end, how many frames it then takes in the best way.
struct Row {
    first: usize,
    lengths: Vec<u32>,
}

/// The best scores of ways that end with a state, for each frame from `first` on.
struct Scores {
    first: usize,
    scores: Vec<f32>,
}

impl Scores {
    fn at(&self, end: usize) -> f32 {
        end.checked_sub(self.first).and_then(|at| self.scores.get(at)).copied().unwrap_or(f32::NEG_INFINITY)
    }
}

/// The frame at which each state ends, of the best way.
fn best_ends(states: &[State], frames: &[[f32; VISEMES]]) -> Option<Vec<usize>> {
    let count = frames.len();
    let silence = Viseme::Sil.index();
    // Sums of what fits, by viseme: the fit of a state over frames is one difference.
    let mut sums = vec![[0.0_f64; VISEMES]];
    let mut total = [0.0; VISEMES];
    // How many frames were spoken before each one.
    let mut spoken = vec![0_u32];
    for weights in frames {
        for viseme in Viseme::ALL {
            total[viseme.index()] += f64::from(fit(viseme, weights));
        }
        sums.push(total);
        spoken.push(spoken.last().map_or(0, |sum| sum + u32::from(weights[silence] < 0.5)));
    }
    // Usual times, brought to the rate of this recording by the frames that are not silent.
    let usual: f32 = states.iter().map(|state| state.usual).sum();
    let of_all = spoken.last().map_or(0.0, |sum| *sum as f32);
    let rate = if usual > 0.0 { (of_all / usual).clamp(0.2, 5.0) } else { 1.0 };
    let (mut before, mut rows) = (Scores { first: 0, scores: vec![0.0] }, Vec::with_capacity(states.len()));
    let mut by_then = 0.0;
    for (index, state) in states.iter().enumerate() {
        by_then += state.usual * rate;
        // It ends near where as much was spoken as usually is by then, and the last one at the end.
        let is_last = index + 1 == states.len();
        let [low, high] = [by_then - ALIGN_WINDOW, by_then + ALIGN_WINDOW];
        let first = spoken.partition_point(|sum| (*sum as f32) < low).min(count);
        let last = if is_last { count } else { spoken.partition_point(|sum| *sum as f32 <= high) };
        let ends = first..=last.clamp(first, count);
        let (scores, lengths) = match state.viseme {
            Viseme::Sil => pauses(&before, &sums, ends),
            _ => sounds(state, &before, &sums, ends, rate),
        };
        before = Scores { first, scores };
        rows.push(Row { first, lengths });
    }
    if !before.at(count).is_finite() {
        return None;
    }
    // Backwards from the last frame.
    let (mut end, mut ends) = (count, Vec::with_capacity(states.len()));
    for row in rows.iter().rev() {
        ends.push(end);
        let length = end.checked_sub(row.first).and_then(|at| row.lengths.get(at))?;
        end = end.checked_sub(*length as usize)?;
    }
    ends.reverse();
    (end == 0).then_some(ends)
}

/// The row of a pause, which costs nothing whatever its length: the best beginning is kept from end to end.
fn pauses(before: &Scores, sums: &[[f64; VISEMES]], ends: RangeInclusive<usize>) -> (Vec<f32>, Vec<u32>) {
    let silence = Viseme::Sil.index();
    let (mut best, mut start) = ((f64::NEG_INFINITY, 0), before.first);
    let row = ends.map(|end| {
        while start <= end {
            let score = f64::from(before.at(start)) - sums[start][silence];
            if score > best.0 {
                best = (score, start);
            }
            start += 1;
        }
        ((best.0 + sums[end][silence]) as f32, end.saturating_sub(best.1) as u32)
    });
    row.unzip()
}

/// The row of a sound, which lasts a frame at least.
fn sounds(
    state: &State,
    before: &Scores,
    sums: &[[f64; VISEMES]],
    ends: RangeInclusive<usize>,
    rate: f32,
) -> (Vec<f32>, Vec<u32>) {
    let costs: Vec<f32> = (0..=ALIGN_MOST_FRAMES).map(|length| cost(state, length, rate)).collect();
    let viseme = state.viseme.index();
    let row = ends.map(|end| {
        let mut best = (f32::NEG_INFINITY, 0);
        let most = end.saturating_sub(before.first).min(ALIGN_MOST_FRAMES);
        for (length, cost) in costs.iter().enumerate().take(most + 1).skip(1) {
            let start = end - length;
            let score = before.at(start) + (sums[end][viseme] - sums[start][viseme]) as f32 + cost;
            if score > best.0 {
                best = (score, length as u32);
            }
        }
        best
    });
    row.unzip()
}

/// What it costs a sound to be longer or shorter than usual: the square of the ratio's logarithm.
fn cost(state: &State, length: usize, rate: f32) -> f32 {
    if state.usual <= 0.0 || length == 0 {
        return 0.0;
    }
    let ratio = (length as f32 / (state.usual * rate).max(1.0)).ln() / ALIGN_SPREAD;
    -0.5 * ratio * ratio
}
