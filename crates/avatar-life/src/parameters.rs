//! The numbers of human behaviour, with where they come from. Numbers with no work beside them are
//! judgements of this project.
//!
//! - Andrist, Mutlu & Gleicher 2013, *Conversational gaze aversion for virtual agents*.
//! - Argyle & Cook 1976, *Gaze and mutual gaze*: listeners look at who speaks 75 % of the time, speakers
//!   40 %.
//! - Bahill, Adler & Stark 1975, *Most naturally occurring human saccades have magnitudes of 15 degrees or
//!   less*.
//! - Bahill, Clark & Stark 1975, *The main sequence, a tool for studying human eye movements*.
//! - Bentivoglio et al. 1997, *Analysis of blink rate patterns in normal subjects*: 17 a minute at rest, 26
//!   in conversation, 4.5 while reading.
//! - Carpenter 1988, *Movements of the eyes*.
//! - Collewijn, van der Steen & Steinman 1985, *Human eye movements associated with blinks and prolonged
//!   eyelid closure*.
//! - Evinger, Manning & Sibony 1991, *Eyelid movements: mechanisms and normal data*; VanderWerf et al. 2003,
//!   *Eyelid movements: behavioral studies of blinking in humans*.
//! - Evinger et al. 1994, *Not looking while leaping: the linkage of blinking and saccadic gaze shifts*.
//! - Freedman 2008, *Coordination of the eyes and head during visual orienting*; Stahl 1999, *Amplitude of
//!   human head movements associated with horizontal saccades*.
//! - Henderson 2003, *Human gaze control during real-world scene perception*; Rayner 1998, *Eye movements in
//!   reading and information processing*.
//! - Martinez-Conde, Macknik & Hubel 2004, *The role of fixational eye movements in visual perception*.
//! - Moon & Spencer 1944, *On the Stiles-Crawford effect*: the pupil by luminance.
//! - Robinson 1965, *The mechanics of human smooth pursuit eye movement*.
//! - Stern, Boyer & Schroeder 1994, *Blink rate: a possible measure of fatigue*.
//! - Tobin et al. 1983, *Breathing patterns: normal subjects*: about 17 breaths a minute, the way in about
//!   0.4 of the time. The presets breathe a little more slowly.
//! - Zee, Fitzgibbon & Optican 1992, *Saccade-vergence interactions in humans*.

/// How much of each part is shown, from 0 (not at all) to 1. What is out of this range is taken as its end,
/// and NaN as 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amounts {
    /// Blinks.
    pub blinks: f64,
    /// Eyes that look at things, one after another.
    pub gaze: f64,
    /// The small jumps of eyes that look at one thing.
    pub micro: f64,
    /// The head that follows the eyes.
    pub head: f64,
    /// Small slow motions of the head.
    pub sway: f64,
    /// Small motions of the brows, and brows that rise with the eyes.
    pub brows: f64,
    /// Breath.
    pub breath: f64,
    /// Pupils that answer light and interest.
    pub pupils: f64,
}

impl Amounts {
    /// Everything in full.
    pub const FULL: Self = Self::all(1.0);
    /// Nothing at all: the face is as it was posed.
    pub const NONE: Self = Self::all(0.0);

    /// The same amount of each part.
    pub const fn all(amount: f64) -> Self {
        Self {
            blinks: amount,
            gaze: amount,
            micro: amount,
            head: amount,
            sway: amount,
            brows: amount,
            breath: amount,
            pupils: amount,
        }
    }

    pub(crate) fn clamped(self) -> [f64; 8] {
        let Self { blinks, gaze, micro, head, sway, brows, breath, pupils } = self;
        let clamp = |amount: f64| if amount.is_nan() { 0.0 } else { amount.clamp(0.0, 1.0) };
        [blinks, gaze, micro, head, sway, brows, breath, pupils].map(clamp)
    }
}

/// How a face lives: the numbers that differ between moods. Numbers that make no sense, such as no blink in
/// a thousand minutes, are taken as the nearest that do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Its name, as presets are called on the command line.
    pub name: &'static str,
    /// How much of each part is shown.
    pub amounts: Amounts,
    /// Mean number of blinks a minute, those that follow glances apart.
    pub blinks_per_min: f64,
    /// Durations of blinks, by the usual ones.
    pub blink_slowness: f64,
    /// Share by which upper lids hang.
    pub droop: f64,
    /// Mean seconds for which the eyes stay on one place.
    pub fixation_secs: f64,
    /// Share of glances that go to the targets of attention, or straight ahead where there are none.
    pub contact: f64,
    /// Mean degrees of glances to elsewhere.
    pub glance_degrees: f64,
    /// Share of a large gaze that the head takes over.
    pub head_share: f64,
    /// Degrees of slow motions of the head.
    pub sway_degrees: f64,
    /// Mean number of breaths a minute.
    pub breaths_per_min: f64,
    /// Depth of breath, by the usual one.
    pub breath_depth: f64,
}

/// At rest, attentive.
const CALM: Style = Style {
    name: "calm",
    amounts: Amounts::FULL,
    blinks_per_min: 14.0,
    blink_slowness: 1.0,
    droop: 0.0,
    fixation_secs: 0.6,
    contact: 0.8,
    glance_degrees: 6.0,
    head_share: 0.6,
    sway_degrees: 1.6,
    breaths_per_min: 13.0,
    breath_depth: 1.0,
};

impl Style {
    /// The presets, by their names: calm, lively, tired, nervous, listening.
    pub const PRESETS: [Self; 5] = [
        CALM,
        Self {
            name: "lively",
            blinks_per_min: 20.0,
            fixation_secs: 0.4,
            contact: 0.65,
            glance_degrees: 9.0,
            head_share: 0.75,
            sway_degrees: 2.6,
            breaths_per_min: 15.0,
            ..CALM
        },
        // Who is tired blinks more and more slowly (Stern, Boyer & Schroeder 1994).
        Self {
            name: "tired",
            blinks_per_min: 20.0,
            blink_slowness: 1.5,
            droop: 0.22,
            fixation_secs: 0.7,
            contact: 0.55,
            glance_degrees: 5.0,
            head_share: 0.5,
            sway_degrees: 1.8,
            breaths_per_min: 12.5,
            breath_depth: 1.2,
            ..CALM
        },
        Self {
            name: "nervous",
            blinks_per_min: 28.0,
            blink_slowness: 0.9,
            fixation_secs: 0.35,
            contact: 0.45,
            glance_degrees: 9.0,
            head_share: 0.5,
            sway_degrees: 2.0,
            breaths_per_min: 16.0,
            breath_depth: 0.8,
            ..CALM
        },
        // Listeners look at who speaks most of the time (Argyle & Cook 1976).
        Self {
            name: "listening",
            fixation_secs: 0.65,
            contact: 0.9,
            glance_degrees: 5.0,
            sway_degrees: 2.0,
            blinks_per_min: 15.0,
            ..CALM
        },
    ];

    /// The same with every number in the range that makes sense; NaN is the calm style's.
    pub(crate) fn sound(self) -> Self {
        let within = |number: fn(&Self) -> f64, least: f64, most: f64| match number(&self).is_nan() {
            true => number(&CALM),
            false => number(&self).clamp(least, most),
        };
        Self {
            blinks_per_min: within(|style| style.blinks_per_min, 0.1, 60.0),
            blink_slowness: within(|style| style.blink_slowness, 0.3, 5.0),
            droop: within(|style| style.droop, 0.0, 1.0),
            fixation_secs: within(|style| style.fixation_secs, 0.1, 60.0),
            contact: within(|style| style.contact, 0.0, 1.0),
            glance_degrees: within(|style| style.glance_degrees, 0.1, 30.0),
            head_share: within(|style| style.head_share, 0.0, 1.0),
            sway_degrees: within(|style| style.sway_degrees, 0.0, 10.0),
            breaths_per_min: within(|style| style.breaths_per_min, 1.0, 60.0),
            breath_depth: within(|style| style.breath_depth, 0.0, 2.0),
            ..self
        }
    }

    /// The preset of this name.
    pub fn preset(name: &str) -> Option<Self> {
        Self::PRESETS.into_iter().find(|style| style.name == name)
    }
}

/// Which part somebody has in a talk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Role {
    /// None, or both.
    #[default]
    Neither,
    /// Speaks: looks away more, blinks more often, and moves the head more.
    Speaking,
    /// Listens: looks away less.
    Listening,
}

impl Style {
    /// The same style of somebody in this role.
    pub(crate) fn in_role(self, role: Role) -> Self {
        match role {
            Role::Neither => self,
            Role::Speaking => Self {
                contact: SPEAKING_CONTACT * self.contact,
                blinks_per_min: (SPEAKING_BLINKS * self.blinks_per_min).min(60.0),
                sway_degrees: (SPEAKING_SWAY * self.sway_degrees).min(10.0),
                ..self
            },
            Role::Listening => Self { contact: 1.0 - LISTENING_AWAY * (1.0 - self.contact), ..self },
        }
    }
}

impl Default for Style {
    /// The preset `calm`.
    fn default() -> Self {
        CALM
    }
}

/// Who speaks looks at the other 41 % of the time, who listens 75 % (Argyle & Cook 1976): shares of a style's
/// contact, and of what is left to the whole, that bring a style of 0.6 there.
const SPEAKING_CONTACT: f64 = 0.68;
const LISTENING_AWAY: f64 = 0.62;
/// 26 blinks a minute in conversation, 17 at rest (Bentivoglio et al. 1997).
const SPEAKING_BLINKS: f64 = 1.5;
/// Heads hardly rest while their owners speak (Hadar et al. 1983); how much more is a guess.
const SPEAKING_SWAY: f64 = 1.3;

/// Deviation of the logarithm of the time between blinks, which is skewed to long times (Bentivoglio et al.
/// 1997).
pub(crate) const BLINK_SPREAD: f64 = 0.6;
/// The shortest time between the starts of two blinks that are no double.
pub(crate) const BLINK_REST_SECS: f64 = 0.7;
/// Share of blinks that are followed by another at once, and the seconds between their starts.
pub(crate) const DOUBLE: f64 = 0.09;
pub(crate) const DOUBLE_SECS: [f64; 2] = [0.32, 0.5];
/// The way down takes 75 to 100 ms, the way up about twice that, 150 to 250 ms (Evinger, Manning & Sibony
/// 1991; VanderWerf et al. 2003).
pub(crate) const CLOSE_SECS: [f64; 2] = [0.078, 0.098];
pub(crate) const HELD_SECS: [f64; 2] = [0.005, 0.03];
pub(crate) const OPEN_SECS: [f64; 2] = [0.16, 0.24];
/// Share of blinks that do not close the eye, and how far these go.
pub(crate) const INCOMPLETE: f64 = 0.12;
pub(crate) const INCOMPLETE_DEPTH: [f64; 2] = [0.6, 0.9];
/// Degrees by which eyes turn down, and each to the nose, in a blink (Collewijn et al. 1985: 1 to 2).
pub(crate) const BLINK_EYES_DOWN: f64 = 1.5;
pub(crate) const BLINK_EYES_IN: f64 = 0.7;
/// The probability of a blink with a gaze shift is 0 at the first and 0.97 at the second of these angles
/// (Evinger et al. 1994: 97 % above 33 degrees).
pub(crate) const GAZE_BLINK_DEGREES: [f64; 2] = [12.0, 33.0];
pub(crate) const GAZE_BLINK_MOST: f64 = 0.97;
/// The probability of a blink at the end of an utterance.
pub(crate) const UTTERANCE_BLINK: f64 = 0.7;

/// A saccade of A degrees takes `0.021 + 0.0022 A` seconds (Carpenter 1988), and its peak speed is `550 (1 −
/// e^(−A/7))` degrees a second (the form of Bahill, Clark & Stark 1975).
pub(crate) const SACCADE_SECS: f64 = 0.021;
pub(crate) const SACCADE_SECS_PER_DEGREE: f64 = 0.0022;
pub(crate) const SACCADE_SPEED: f64 = 550.0;
pub(crate) const SACCADE_DEGREES: f64 = 7.0;
/// Saccades of one size take between these shares of that time.
pub(crate) const SACCADE_VARIATION: [f64; 2] = [0.93, 1.07];

/// Spread of the logarithm of fixation times, and the shortest (Rayner 1998; Henderson 2003).
pub(crate) const FIXATION_SPREAD: f64 = 0.5;
pub(crate) const FIXATION_LEAST_SECS: f64 = 0.2;
/// Seconds for the eyes to come together or part, with the help of a saccade (Zee et al. 1992).
pub(crate) const VERGENCE_SECS: f64 = 0.19;
/// Time from a target's jump to the saccade to it (Carpenter 1988), and how far it has to jump, in degrees.
pub(crate) const REACTION_SECS: f64 = 0.2;
pub(crate) const JUMP_DEGREES: f64 = 2.0;
/// Rate at which pursuit takes over a target's motion: three low passes of 1/25 s, about the 120 ms of
/// Robinson 1965.
pub(crate) const PURSUIT_RATE: f64 = 25.0;
/// Metres between the pupils, the mean of adults.
pub(crate) const PUPILS_APART: f64 = 0.063;
/// Degrees of glances are at most this; up and down are this share of sideways.
pub(crate) const GLANCE_MOST: f64 = 28.0;
pub(crate) const GLANCE_UPRIGHT: f64 = 0.55;
/// A glance elsewhere starts from this share of where the eyes are, and stays for this share of a fixation.
pub(crate) const GLANCE_BACK: f64 = 0.5;
pub(crate) const GLANCE_STAY: f64 = 0.8;
/// Metres to someone who is talked to, where no target says where that is.
pub(crate) const PARTNER_METRES: f64 = 1.2;
/// Metres at which a glance to nowhere ends.
pub(crate) const GLANCE_METRES: [f64; 2] = [0.9, 3.0];
/// While thinking: degrees sideways, up, and seconds of a look away (Andrist et al. 2013: mostly up).
pub(crate) const AVERT_SIDE: [f64; 2] = [9.0, 22.0];
pub(crate) const AVERT_UP: [f64; 2] = [4.0, 15.0];
pub(crate) const AVERT_DOWN: [f64; 2] = [8.0, 18.0];
pub(crate) const AVERT_IS_UP: f64 = 0.7;
pub(crate) const AVERT_SECS: f64 = 1.4;
/// Share of gaze shifts that are looks away while somebody thinks in full.
pub(crate) const AVERT_MOST: f64 = 0.85;

/// Mean seconds between micro-saccades: 1 to 2 a second (Martinez-Conde et al. 2004), the shortest time, the
/// range of their degrees, the mean of these, and the spread of their logarithm.
pub(crate) const MICRO_SECS: f64 = 0.65;
pub(crate) const MICRO_LEAST_SECS: f64 = 0.2;
pub(crate) const MICRO_DEGREES: [f64; 2] = [0.1, 0.5];
pub(crate) const MICRO_MEAN_DEGREES: f64 = 0.25;
pub(crate) const MICRO_SPREAD: f64 = 0.4;

/// Head: share of small angles, and from which angle the style's own share acts (Stahl 1999: within about 18
/// degrees the eyes go mostly alone); seconds after the eyes, and of a movement, by degrees (Freedman 2008).
pub(crate) const HEAD_SMALL_SHARE: f64 = 0.15;
pub(crate) const HEAD_FREE_DEGREES: f64 = 9.0;
pub(crate) const HEAD_LATER_SECS: f64 = 0.045;
pub(crate) const HEAD_SECS: f64 = 0.42;
pub(crate) const HEAD_SECS_PER_DEGREE: f64 = 0.014;
/// A head that is nearer to where it should be than this stays; it is asked again after so many seconds.
pub(crate) const HEAD_IDLE_DEGREES: f64 = 1.2;
pub(crate) const HEAD_AGAIN_SECS: f64 = 0.4;

/// Seconds between the knots of the slow and of the fast half of small motions.
pub(crate) const KNOT_SECS: [f64; 2] = [1.9, 0.63];
/// Share of the fast half.
pub(crate) const FAST_SHARE: f64 = 0.25;
/// The head nods by this share of what it turns by.
pub(crate) const SWAY_NOD: f64 = 0.7;

/// Spread of the logarithm of a breath's duration and depth, and shares of the breath in and out (Tobin et
/// al. 1983).
pub(crate) const BREATH_SPREAD: f64 = 0.1;
pub(crate) const BREATH_IN: f64 = 0.4;
pub(crate) const BREATH_OUT: f64 = 0.5;
/// Degrees by which a breath lifts the head, and weights of nostrils and shoulders in it.
pub(crate) const BREATH_HEAD: f64 = 0.7;
pub(crate) const BREATH_NOSTRILS: f64 = 0.07;
pub(crate) const BREATH_SHOULDERS: f64 = 0.5;

/// Weight of the small motions of brows; weight for each degree that the eyes look up beyond some, and how
/// many these are; shares of the inner brows' motion and of their own in that of the outer ones.
pub(crate) const BROW_WEIGHT: f64 = 0.12;
pub(crate) const BROW_PER_DEGREE: f64 = 0.012;
pub(crate) const BROW_FROM_DEGREES: f64 = 6.0;
pub(crate) const BROW_OUTER: [f64; 2] = [0.7, 0.3];
/// Degrees of lids for each degree that the eyes look up, where the avatar does not couple them.
pub(crate) const UPPER_LID_PER_DEGREE: f64 = -0.3;
pub(crate) const LOWER_LID_PER_DEGREE: f64 = 0.12;

/// The pupil: `4.9 − 3 tanh(0.4 log₁₀ L)` mm for a luminance of L cd/m² (Moon & Spencer 1944), the
/// millimetres of full interest and of restlessness, and the rate at which it follows.
pub(crate) const PUPIL_INTEREST: f64 = 0.6;
pub(crate) const PUPIL_UNREST: f64 = 0.15;
pub(crate) const PUPIL_RATE: f64 = 6.0;
/// Candela a square metre of a lit room, before anybody says another.
pub(crate) const ROOM_LUMINANCE: f64 = 100.0;
/// Rate at which amounts and the hanging of lids follow what they are set to.
pub(crate) const AMOUNT_RATE: f64 = 5.0;
