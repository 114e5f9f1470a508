//! The numbers of coarticulation, in one place.
//!
//! The model is that of dominance (Löfqvist 1990; Cohen and Massaro, "Modeling Coarticulation in Synthetic
//! Visual Speech", 1993): each sound has a target for each articulator and insists on it more or less; where
//! it insists little, the articulator stays with the sounds around. Jaw, lips and tongue have times of their
//! own. What must be reached whatever the rate, the closed lips of p, b, m and the bitten lip of f, v, is
//! laid over it, as in "JALI" (Edwards, Landreth, Fiume and Singh 2016, section 4.2).

use crate::viseme::{VISEMES, Viseme};
use std::ops::Range;

/// Number of articulators of a [`crate::Mouth`].
pub(crate) const ARTICULATORS: usize = 14;
/// What moves at its own times: jaw, lips, tongue, and the voice with the brows.
pub(crate) const GROUPS: usize = 4;
pub(crate) const JAW: usize = 0;
pub(crate) const LIPS: usize = 1;
pub(crate) const TONGUE: usize = 2;
pub(crate) const VOICE: usize = 3;

/// The articulators of each group.
pub(crate) const GROUP: [(usize, Range<usize>); 3] = [(JAW, 0..2), (TONGUE, 2..3), (LIPS, 3..ARTICULATORS)];

/// Seconds that an articulator takes from one target to the next in slow speech. The jaw is heavy: it moves
/// in about 150 to 200 ms in syllables of ordinary length, lips in 100 to 150 ms, the tip of the tongue
/// faster (Ostry and Munhall 1985; Gracco 1988; Westbury and Dembowski 1993).
pub(crate) const MOVE_SECS: [f64; GROUPS] = [0.19, 0.14, 0.09, 0.26];
/// In quick speech movements are shorter: this share of the time between the middles of two sounds.
pub(crate) const MOVE_SHARE: [f64; GROUPS] = [1.4, 1.2, 1.0, 1.5];
/// But never shorter than this: a jaw has its weight. Then movements lie over each other, targets are not
/// reached any more, and vowels become smaller, as in people (Lindblom 1963).
pub(crate) const MOVE_LEAST_SECS: [f64; GROUPS] = [0.17, 0.11, 0.06, 0.18];
/// What is seen comes before what is heard: seconds by which movements are early (Chandrasekaran and others
/// 2009 find 100 to 300 ms from the first movement to the sound; that is the half of a movement and this).
pub(crate) const EARLY_SECS: [f64; GROUPS] = [0.02, 0.025, 0.015, 0.02];
/// A sound that insists more than its neighbour takes this share of the shorter one's time from it.
pub(crate) const TAKEN: f64 = 0.3;
/// No movement begins or ends further than this from the border of its sounds.
pub(crate) const REACH_SECS: f64 = 0.2;

/// Sounds shorter than this are joined with their neighbours: nobody speaks eighty sounds a second.
pub(crate) const SHORTEST_SECS: f64 = 0.012;
/// A pause of this length or longer is silence; in a shorter one lips stay with the sounds around.
pub(crate) const PAUSE_SECS: f64 = 0.25;
/// A pause of this length or longer, in seconds, ends an utterance (pauses within one are mostly shorter:
/// Goldman-Eisler 1968 takes 0.25 s for the least of those that speakers make to think).
pub const UTTERANCE_PAUSE_SECS: f64 = 0.4;
/// How many sounds further a vowel is still prepared or still felt.
pub(crate) const FELT_SOUNDS: usize = 4;
/// How much of what a sound does not insist on comes from the vowel after it; the rest from the one before.
pub(crate) const ANTICIPATION: f64 = 0.6;

/// How long the lips take to close and to open again, at most, and as a share of the sound beside. At the
/// least they take so long, where there is room.
pub(crate) const GRIP_SECS: f64 = 0.085;
pub(crate) const GRIP_SHARE: f64 = 0.62;
pub(crate) const GRIP_LEAST_SECS: f64 = 0.03;
/// From where to where lips are closed (or bitten), as shares of the sound's time: the opening at its end is
/// what is heard as a p.
pub(crate) const GRIP_FROM: f64 = 0.05;
pub(crate) const GRIP_TO: f64 = 0.78;

/// The opening of the jaw by loudness: this much in silence, and this much more at full loudness; 1 at a half
/// (Schulman 1989: shouted vowels are opened 1.5 to 2 times as far).
pub(crate) const JAW_QUIET: f64 = 0.55;
pub(crate) const JAW_LOUD: f64 = 0.9;
/// How high brows go with the loudest syllable, as weights of ARKit's shapes, and the loudness from which on
/// they move (brows go with stressed syllables: Cavé and others 1996).
pub(crate) const BROWS: f64 = 0.4;
pub(crate) const BROWS_FROM: f64 = 0.5;

/// What a sound wants of each articulator, as weights of ARKit's shapes, and how much it insists on it.
pub(crate) struct Target {
    pub(crate) articulators: [f64; ARTICULATORS],
    /// For jaw, lips, tongue, voice.
    pub(crate) dominance: [f64; GROUPS],
}

const fn target(articulators: [f64; ARTICULATORS], [jaw, lips, tongue]: [f64; 3]) -> Target {
    Target { articulators, dominance: [jaw, lips, tongue, 1.0] }
}

/// By the index of the viseme; columns as in [`crate::Articulator`]: jawOpen, jawForward, tongueOut,
/// mouthFunnel, mouthPucker, mouthPress, mouthRollUpper, mouthRollLower, mouthShrugLower, mouthShrugUpper,
/// mouthUpperUp, mouthLowerDown, mouthStretch, mouthSmile; then how much it insists on jaw, lips and tongue.
#[rustfmt::skip]
pub(crate) const TARGETS: [Target; VISEMES] = [
    /* sil */ target([0.00, 0.00, 0.00, 0.00, 0.00, 0.03, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00], [1.00, 1.00, 1.00]),
    /* PP  */ target([0.00, 0.00, 0.00, 0.00, 0.00, 0.50, 0.25, 0.34, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00], [0.60, 0.60, 0.20]),
    /* FF  */ target([0.06, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.90, 0.35, 0.00, 0.45, 0.00, 0.00, 0.00], [0.70, 0.70, 0.20]),
    /* TH  */ target([0.12, 0.00, 0.60, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.22, 0.15, 0.00, 0.00], [0.60, 0.50, 1.00]),
    /* DD  */ target([0.11, 0.00, 0.10, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.18, 0.32, 0.10, 0.00], [0.60, 0.30, 0.90]),
    /* kk  */ target([0.20, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.12, 0.16, 0.10, 0.00], [0.30, 0.15, 0.70]),
    /* CH  */ target([0.06, 0.05, 0.00, 0.80, 0.20, 0.00, 0.00, 0.00, 0.00, 0.00, 0.10, 0.00, 0.00, 0.00], [0.80, 0.80, 0.70]),
    /* SS  */ target([0.03, 0.03, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.26, 0.45, 0.30, 0.22], [0.90, 0.50, 0.80]),
    /* nn  */ target([0.12, 0.00, 0.08, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.15, 0.22, 0.05, 0.00], [0.45, 0.20, 0.90]),
    /* RR  */ target([0.14, 0.00, 0.00, 0.42, 0.42, 0.00, 0.00, 0.00, 0.00, 0.00, 0.05, 0.00, 0.00, 0.00], [0.50, 0.60, 0.60]),
    /* aa  */ target([0.46, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.20, 0.20, 0.00, 0.00], [1.00, 0.85, 0.60]),
    /* E   */ target([0.25, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.20, 0.22, 0.28, 0.18], [0.90, 0.75, 0.60]),
    /* I   */ target([0.12, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.25, 0.32, 0.32, 0.42], [0.90, 0.85, 0.60]),
    /* O   */ target([0.33, 0.00, 0.00, 0.55, 0.52, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00], [0.95, 1.00, 0.60]),
    /* U   */ target([0.14, 0.00, 0.00, 0.16, 0.92, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00], [0.90, 1.00, 0.60]),
];

/// What a viseme wants.
pub(crate) const fn target_of(viseme: Viseme) -> &'static Target {
    &TARGETS[viseme.index()]
}

/// Seconds between frames of a recogniser.
pub(crate) const HEARD_STEP_SECS: f64 = 0.01;
/// Widths of the curves through what is heard, in frames: a cubic B-spline of width 4 takes 100 ms from a
/// tenth to nine tenths of a step, near what a jaw takes ([`MOVE_SECS`]); lips are quicker, and the tongue.
pub(crate) const HEARD_WIDTH: [f64; GROUPS] = [4.0, 3.0, 2.0, 6.0];
/// The same while somebody speaks, where each frame of width costs two of delay.
pub(crate) const HEARD_WIDTH_LIVE: [f64; GROUPS] = [2.0, 2.0, 1.0, 2.0];
/// How early groups move in a recording, in seconds, as with [`EARLY_SECS`].
pub(crate) const HEARD_AHEAD: [f64; GROUPS] = [0.02, 0.025, 0.015, 0.0];
/// From which weight of p, b, m on, times that of no vowel, lips begin to close, and at which they are
/// closed; the same of f, v. The recogniser is seldom sure of them, and a mouth that stays open is seen more
/// than one that closes on a t. As low as closes lips in the middle of one vowel in a hundred, over voices of
/// three synthesisers (docs/speech.md).
pub(crate) const HEARD_CLOSED: [f64; 2] = [0.08, 0.16];
pub(crate) const HEARD_BITTEN: [f64; 2] = [0.06, 0.12];
/// The width of the curve through that, in frames, and where on it lips are closed: they take some 16 ms, and
/// reach each other in the shortest p.
pub(crate) const HEARD_GRIP_WIDTH: f64 = 2.0;
pub(crate) const HEARD_GRIPPED: f64 = 0.9;
/// What is usual at first, on the recogniser's scale; how fast that follows (a second of speech is most of
/// it); and how much its differences count.
pub(crate) const HEARD_USUAL: f64 = 0.6;
pub(crate) const HEARD_USUAL_STEP: f64 = 0.01;
pub(crate) const HEARD_GAIN: f64 = 1.2;

/// Alignment of sounds that are known with what is heard. The least weight that counts, since a recogniser is
/// often wrong; how much of silence is the stop of p, t or k; how far lengths of sounds usually are from what
/// is usual, as a logarithm. Half as long to twice as long are most of them (Crystal and House 1988), which
/// is some 0.5; where the recogniser is lost, less keeps sounds in their places.
pub(crate) const ALIGN_LEAST: f32 = 0.04;
pub(crate) const ALIGN_STOP: f32 = 0.35;
pub(crate) const ALIGN_SPREAD: f32 = 0.35;
/// The longest sound, in frames; and how many spoken frames from where it is awaited a sound is looked for.
pub(crate) const ALIGN_MOST_FRAMES: usize = 50;
pub(crate) const ALIGN_WINDOW: f32 = 300.0;
