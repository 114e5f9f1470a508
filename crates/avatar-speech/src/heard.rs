use crate::ease::ease_between;
use crate::loudness::Loudness;
use crate::mouth::Mouth;
use crate::params::{
    GROUPS, HEARD_AHEAD, HEARD_BITTEN, HEARD_CLOSED, HEARD_GAIN, HEARD_GRIP_WIDTH, HEARD_GRIPPED,
    HEARD_STEP_SECS, HEARD_USUAL, HEARD_USUAL_STEP, HEARD_WIDTH, HEARD_WIDTH_LIVE, UTTERANCE_PAUSE_SECS,
    VOICE,
};
use crate::viseme::{VISEMES, Viseme};

/// Frames that [`LiveMouth`] remembers: more than the widest curve reaches, and those that come in one piece.
const REMEMBERED: usize = 64;
/// More frames of silence than these are not put into a gap; so much later everything is forgotten anyway.
const MOST_GAP: f64 = REMEMBERED as f64;

/// What was heard in a hundredth of a second: weights whose sum is 1, and loudness.
type Frame = ([f32; VISEMES], f32);

const SILENCE: Frame = {
    let mut weights = [0.0; VISEMES];
    weights[Viseme::Sil.index()] = 1.0;
    (weights, 0.0)
};

/// The mouth of a recording, of weights of visemes that something that listens has found in all of it:
/// random access by the time, and C².
///
/// Weights flicker faster than a jaw can move, so each group of articulators follows a cubic B-spline through
/// them that is as wide as the group is slow; a curve of the whole recording needs no delay for that. Lips
/// close where p, b or m is likely enough, for at least as long as it is heard. It takes 64 bytes for each
/// hundredth of a second.
///
/// ```
/// use avatar_speech::{HeardSpeech, Viseme};
/// let mut vowel = [0.0; 15];
/// vowel[Viseme::Aa.index()] = 1.0;
/// // Half a second of an a.
/// let speech = HeardSpeech::new((0..50).map(|_| (vowel, 0.6)), 0.0);
/// assert!(speech.at(0.25).articulators[0] > 0.3);
/// assert_eq!(speech.at(speech.rest_secs()).visemes[Viseme::Sil.index()], 1.0);
/// ```
#[derive(Clone, Debug)]
pub struct HeardSpeech {
    frames: Vec<Frame>,
    first_secs: f64,
    utterances: Vec<[f64; 2]>,
}

impl HeardSpeech {
    /// The time from one frame to the next, in seconds.
    pub const STEP_SECS: f64 = HEARD_STEP_SECS;

    /// Frames of a recogniser, a hundred a second, the first at this time: weights in the order of
    /// [`Viseme::ALL`], and loudness, of which what is usual in the recording counts as 0.5. What is below 0
    /// or no number counts as 0.
    pub fn new(frames: impl IntoIterator<Item = ([f32; VISEMES], f32)>, first_secs: f64) -> Self {
        let mut frames: Vec<Frame> = frames.into_iter().map(sound).collect();
        let mut usual = Usual::default();
        // Twice, so that the beginning is not louder than the rest.
        for frame in &frames {
            usual.hear(frame);
        }
        frames.iter_mut().for_each(|frame| frame.1 = usual.hear(frame));
        let first_secs = if first_secs.is_finite() { first_secs } else { 0.0 };
        let utterances = utterances(&frames, first_secs);
        Self { frames, first_secs, utterances }
    }

    /// The mouth at a time in seconds; silent before the beginning and after the end, and at a time that is
    /// no number.
    pub fn at(&self, secs: f64) -> Mouth {
        let place = (secs - self.first_secs) / HEARD_STEP_SECS;
        let frame = |index: f64| match index >= 0.0 && index < self.frames.len() as f64 {
            true => self.frames.get(index as usize).unwrap_or(&SILENCE),
            false => &SILENCE,
        };
        let ahead = HEARD_AHEAD.map(|secs| place + secs / HEARD_STEP_SECS);
        mouth(frame, &ahead, &HEARD_WIDTH, place)
    }

    /// How loud it is over time, for [`crate::Speech::with_loudness`], where the sounds are known.
    pub fn loudness(&self) -> Loudness {
        let before = (self.first_secs / HEARD_STEP_SECS).round().clamp(0.0, 1e4) as usize;
        let frames = self.frames.iter().map(|(_, loudness)| *loudness);
        Loudness::new(1.0 / HEARD_STEP_SECS, std::iter::repeat_n(0.0, before).chain(frames).collect())
    }

    /// Beginnings and ends in seconds of what is said between longer pauses, in the order of time.
    pub fn utterances(&self) -> &[[f64; 2]] {
        &self.utterances
    }

    /// When the last frame was.
    pub fn end_secs(&self) -> f64 {
        self.first_secs + self.frames.len().saturating_sub(1) as f64 * HEARD_STEP_SECS
    }

    /// From when on the mouth is at rest.
    pub fn rest_secs(&self) -> f64 {
        let widest = HEARD_WIDTH.iter().fold(0.0, |most: f64, width| most.max(*width));
        self.end_secs() + (2.0 * widest + 1.0) * HEARD_STEP_SECS
    }
}

/// Whether somebody speaks, by the weights of visemes that were heard: silence is less likely than a sound.
pub fn speaks(weights: &[f32; VISEMES]) -> bool {
    weights[Viseme::Sil.index()] < 0.5
}

/// What is said between pauses that are long enough to end it: where silence is not likely.
fn utterances(frames: &[Frame], first_secs: f64) -> Vec<[f64; 2]> {
    let mut all: Vec<[f64; 2]> = Vec::new();
    for (index, _) in frames.iter().enumerate().filter(|(_, frame)| speaks(&frame.0)) {
        let secs = first_secs + index as f64 * HEARD_STEP_SECS;
        match all.last_mut() {
            Some([_, end]) if secs - *end < UTTERANCE_PAUSE_SECS => *end = secs + HEARD_STEP_SECS,
            _ => all.push([secs, secs + HEARD_STEP_SECS]),
        }
    }
    all
}

/// A mouth that follows a voice while it is heard, as from a microphone: frames of a recogniser go in as they
/// come, and the mouth of any moment up to [`Self::until_secs`] comes out, C².
///
/// It lags [`Self::DELAY_SECS`] behind the frames, which is what a C² curve through them needs; jaw and lips,
/// which are slower, come two steps after that, and lips that close three. It remembers two thirds of a
/// second, and allocates nothing.
///
/// ```
/// use avatar_speech::{LiveMouth, Viseme};
/// let mut mouth = LiveMouth::new();
/// let mut vowel = [0.0; 15];
/// vowel[Viseme::Aa.index()] = 1.0;
/// for frame in 0..30 {
///     mouth.push(f64::from(frame) * 0.01, &vowel, 0.6);
/// }
/// assert!((mouth.until_secs() - 0.27).abs() < 1e-9);
/// assert!(mouth.at(mouth.until_secs()).articulators[0] > 0.3);
/// ```
#[derive(Clone, Debug)]
pub struct LiveMouth {
    /// Frame `k` lies at `k % REMEMBERED`.
    frames: [Frame; REMEMBERED],
    /// The number of the newest frame; none before the first.
    newest: Option<f64>,
    first_secs: f64,
    usual: Usual,
}

impl Default for LiveMouth {
    fn default() -> Self {
        Self::new()
    }
}

impl LiveMouth {
    /// How long after the newest frame's time the mouth of that time is known.
    pub const DELAY_SECS: f64 = 2.0 * HEARD_STEP_SECS;

    /// A mouth that has heard nothing.
    pub const fn new() -> Self {
        let usual = Usual { loudness: HEARD_USUAL };
        Self { frames: [SILENCE; REMEMBERED], newest: None, first_secs: 0.0, usual }
    }

    /// As if nothing had been heard.
    pub fn reset(&mut self) {
        *self = Self::new();
    }

    /// Takes a frame of a recogniser, a hundredth of a second after the one before: its time in seconds,
    /// weights in the order of [`Viseme::ALL`], and loudness, of which what has been usual in the last
    /// seconds counts as 0.5. Frames that are missing were silent; one whose time does not come after the
    /// last one's is passed over.
    pub fn push(&mut self, time_secs: f64, weights: &[f32; VISEMES], loudness: f32) {
        if !time_secs.is_finite() {
            return;
        }
        let place = match self.newest {
            None => {
                self.first_secs = time_secs;
                0.0
            }
            Some(newest) => {
                let place = ((time_secs - self.first_secs) / HEARD_STEP_SECS).round();
                if place <= newest {
                    return;
                }
                for missing in 1..(place - newest).min(MOST_GAP) as usize {
                    self.frames[slot(newest + missing as f64)] = SILENCE;
                }
                place
            }
        };
        let mut frame = sound((*weights, loudness));
        frame.1 = self.usual.hear(&frame);
        self.frames[slot(place)] = frame;
        self.newest = Some(place);
    }

    /// Up to when the mouth is known: it does not change any more there, whatever is heard. Before the first
    /// frame, 0.
    pub fn until_secs(&self) -> f64 {
        self.newest.map_or(0.0, |newest| self.first_secs + (newest * HEARD_STEP_SECS - Self::DELAY_SECS))
    }

    /// The mouth at a time in seconds, of the last half of a second before [`Self::until_secs`]. At later
    /// times what follows is taken for silence; the mouth of earlier ones is forgotten, and silent.
    pub fn at(&self, secs: f64) -> Mouth {
        let Some(newest) = self.newest else { return Mouth::SILENT };
        let place = (secs - self.first_secs) / HEARD_STEP_SECS;
        let frame = |index: f64| match index <= newest && index > newest - REMEMBERED as f64 && index >= 0.0 {
            true => &self.frames[slot(index)],
            false => &SILENCE,
        };
        // A wide curve through what is known lags behind a narrow one.
        let behind = |width: f64| place - 2.0 * (width - 1.0);
        // Lips know a frame further, to be sure.
        mouth(frame, &HEARD_WIDTH_LIVE.map(behind), &HEARD_WIDTH_LIVE, behind(HEARD_GRIP_WIDTH) - 1.0)
    }
}

/// The place of a frame among those that are remembered.
fn slot(index: f64) -> usize {
    (index % REMEMBERED as f64) as usize
}

/// What is usually how loud, over the last seconds in which somebody spoke.
#[derive(Clone, Copy, Debug)]
struct Usual {
    loudness: f64,
}

impl Default for Usual {
    fn default() -> Self {
        Self { loudness: HEARD_USUAL }
    }
}

impl Usual {
    /// The loudness of a frame, of which what is usual is 0.5.
    fn hear(&mut self, (weights, loudness): &Frame) -> f32 {
        let spoken = 1.0 - f64::from(weights[Viseme::Sil.index()]);
        self.loudness += HEARD_USUAL_STEP * spoken * (f64::from(*loudness) - self.loudness);
        let relative = 0.5 + HEARD_GAIN * (f64::from(*loudness) - self.loudness);
        relative.clamp(0.0, 1.0) as f32
    }
}

/// A frame whose numbers are numbers, and whose weights have the sum 1.
fn sound((weights, loudness): Frame) -> Frame {
    let weights = weights.map(|weight| if weight > 0.0 && weight.is_finite() { weight } else { 0.0 });
    let sum: f32 = weights.iter().sum();
    let loudness = if loudness > 0.0 { loudness.min(1.0) } else { 0.0 };
    if sum > 0.0 && sum.is_finite() { (weights.map(|weight| weight / sum), loudness) } else { SILENCE }
}

/// The mouth of curves through frames: one for each group, at a place and of a width in frames, and one at
/// its own place for lips that close.
fn mouth<'a>(
    frame: impl Fn(f64) -> &'a Frame,
    places: &[f64; GROUPS],
    widths: &[f64; GROUPS],
    place: f64,
) -> Mouth {
    if !place.is_finite() || place.abs() > 1e12 {
        return Mouth::SILENT;
    }
    let mut shares = [[0.0; VISEMES]; GROUPS];
    for group in 0..VOICE {
        spline(places[group], widths[group], |index, weight| {
            let (weights, _) = frame(index);
            for (share, own) in shares[group].iter_mut().zip(weights) {
                *share += weight * f64::from(*own);
            }
        });
    }
    let mut loudness = 0.0;
    spline(places[VOICE], widths[VOICE], |index, weight| loudness += weight * f64::from(frame(index).1));
    let mut grips = [0.0; 2];
    spline(place, HEARD_GRIP_WIDTH, |index, weight| {
        for (grip, own) in grips.iter_mut().zip(gripping(&frame, index)) {
            *grip += weight * own;
        }
    });
    let [closed, bitten] = grips.map(|grip| ease_between(0.0, HEARD_GRIPPED, grip));
    // Both at once would be a bite between closed lips.
    Mouth::of_groups(&shares, closed, bitten * (1.0 - closed), loudness)
}

/// Whether lips are closed in a frame, and bitten: 0 or 1, and between them where that is not sure.
fn gripping<'a>(frame: &impl Fn(f64) -> &'a Frame, index: f64) -> [f64; 2] {
    let mut lips = [0.0; 2];
    for (offset, weight) in [(-1.0, 1.0 / 6.0), (0.0, 2.0 / 3.0), (1.0, 1.0 / 6.0)] {
        let (weights, _) = frame(index + offset);
        let weight = weight * (1.0 - vowels(weights));
        lips[0] += weight * f64::from(weights[Viseme::PP.index()]);
        lips[1] += weight * f64::from(weights[Viseme::FF.index()]);
    }
    [(HEARD_CLOSED, lips[0]), (HEARD_BITTEN, lips[1])]
        .map(|([from, to], share)| ease_between(from, to, share))
}

/// How likely any vowel is. A recogniser that is not sure of p, b and m takes them for other consonants, and
/// seldom for vowels: where none is likely, less of p, b and m will do.
fn vowels(weights: &[f32; VISEMES]) -> f64 {
    let vowels = Viseme::ALL.into_iter().filter(|viseme| viseme.is_vowel());
    vowels.map(|viseme| f64::from(weights[viseme.index()])).sum::<f64>().min(1.0)
}

/// Gives each frame near a place, and its weight in a cubic B-spline of this width: a whole number of frames,
/// for which the sum of the weights is 1 at any place. C² in the place.
fn spline(place: f64, width: f64, mut add: impl FnMut(f64, f64)) {
    let mut index = (place - 2.0 * width).ceil();
    while index < place + 2.0 * width {
        let x = (place - index).abs() / width;
        let weight = if x < 1.0 {
            2.0 / 3.0 - x * x * (1.0 - x / 2.0)
        } else {
            let rest = (2.0 - x).max(0.0);
            rest * rest * rest / 6.0
        };
        add(index, weight / width);
        index += 1.0;
    }
}
