use crate::amounts::Amounts;
use crate::ease::{ease, ease_between};
use crate::params::{
    ARTICULATORS, BROWS, BROWS_FROM, GROUP, GROUPS, JAW_LOUD, JAW_QUIET, LIPS, TARGETS, target_of,
};
use crate::viseme::{VISEMES, Viseme};

/// What of a mouth speech moves, named as ARKit's shapes; those with sides move both.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Articulator {
    /// The jaw opens.
    JawOpen,
    /// The jaw comes forward.
    JawForward,
    /// The tongue comes out, or to the teeth.
    TongueOut,
    /// The lips are rounded and open.
    MouthFunnel,
    /// The lips are rounded and nearly closed.
    MouthPucker,
    /// The lips are pressed together.
    MouthPress,
    /// The upper lip is rolled in.
    MouthRollUpper,
    /// The lower lip is rolled in.
    MouthRollLower,
    /// The lower lip is pushed up.
    MouthShrugLower,
    /// The upper lip is pushed up.
    MouthShrugUpper,
    /// The upper lip is raised and shows the teeth.
    MouthUpperUp,
    /// The lower lip is lowered and shows the teeth.
    MouthLowerDown,
    /// The corners are drawn to the sides.
    MouthStretch,
    /// The corners are drawn up.
    MouthSmile,
}

impl Articulator {
    /// All of them, in the order of [`Mouth::articulators`].
    pub const ALL: [Self; ARTICULATORS] = [
        Self::JawOpen,
        Self::JawForward,
        Self::TongueOut,
        Self::MouthFunnel,
        Self::MouthPucker,
        Self::MouthPress,
        Self::MouthRollUpper,
        Self::MouthRollLower,
        Self::MouthShrugLower,
        Self::MouthShrugUpper,
        Self::MouthUpperUp,
        Self::MouthLowerDown,
        Self::MouthStretch,
        Self::MouthSmile,
    ];

    /// The names of its shapes in ARKit: one, or the left and the right one.
    pub const fn names(self) -> &'static [&'static str] {
        match self {
            Self::JawOpen => &["jawOpen"],
            Self::JawForward => &["jawForward"],
            Self::TongueOut => &["tongueOut"],
            Self::MouthFunnel => &["mouthFunnel"],
            Self::MouthPucker => &["mouthPucker"],
            Self::MouthPress => &["mouthPressLeft", "mouthPressRight"],
            Self::MouthRollUpper => &["mouthRollUpper"],
            Self::MouthRollLower => &["mouthRollLower"],
            Self::MouthShrugLower => &["mouthShrugLower"],
            Self::MouthShrugUpper => &["mouthShrugUpper"],
            Self::MouthUpperUp => &["mouthUpperUpLeft", "mouthUpperUpRight"],
            Self::MouthLowerDown => &["mouthLowerDownLeft", "mouthLowerDownRight"],
            Self::MouthStretch => &["mouthStretchLeft", "mouthStretchRight"],
            Self::MouthSmile => &["mouthSmileLeft", "mouthSmileRight"],
        }
    }
}

/// A speaking mouth at one moment: plain numbers, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mouth {
    /// Weights of the visemes in the order of [`Viseme::ALL`], as the lips have them; their sum is 1.
    pub visemes: [f64; VISEMES],
    /// Weights of ARKit's shapes in the order of [`Articulator::ALL`], both sides alike.
    pub articulators: [f64; ARTICULATORS],
    /// How far the lips are held closed, for p, b and m: at 1 they are, whatever the face does otherwise.
    pub closed: f64,
    /// How far the lower lip is held at the upper teeth, for f and v.
    pub bitten: f64,
    /// Loudness: 0 silent, 0.5 as people speak, 1 a shout.
    pub loudness: f64,
    /// How far the brows are raised, as weights of `browInnerUp` and `browOuterUp…`.
    pub brows: f64,
}

impl Mouth {
    /// A mouth that is silent.
    pub const SILENT: Self = Self {
        visemes: {
            let mut visemes = [0.0; VISEMES];
            visemes[Viseme::Sil.index()] = 1.0;
            visemes
        },
        articulators: target_of(Viseme::Sil).articulators,
        closed: 0.0,
        bitten: 0.0,
        loudness: 0.0,
        brows: 0.0,
    };

    /// The mouth of weights of visemes, as something that listens to a voice finds them, and of a loudness
    /// from 0 to 1. Weights below 0 and those that are no numbers count as 0. All are divided by their sum;
    /// where that is 0 the mouth is silent. As smooth in time as the weights are.
    pub fn of_visemes(weights: &[f32; VISEMES], loudness: f32) -> Self {
        let sound = |weight: f32| if weight > 0.0 && weight.is_finite() { f64::from(weight) } else { 0.0 };
        let sum: f64 = weights.iter().copied().map(sound).sum();
        if sum <= 0.0 {
            return Self::SILENT;
        }
        let shares = weights.map(|weight| sound(weight) / sum);
        let loudness = f64::from(if loudness.is_nan() { 0.5 } else { loudness.clamp(0.0, 1.0) });
        // A recogniser is never sure: lips close from where p is likelier than not.
        let held = |viseme: Viseme| ease_between(0.25, 0.6, shares[viseme.index()]);
        Self::of_groups(&[shares; GROUPS], held(Viseme::PP), held(Viseme::FF), loudness)
    }

    /// A share of the way from this mouth to another one: 0 is this one, 1 the other. As smooth in time as
    /// both and the share are.
    #[must_use]
    pub fn toward(&self, other: &Self, share: f64) -> Self {
        let between = |from: f64, to: f64| from + share * (to - from);
        Self {
            visemes: std::array::from_fn(|i| between(self.visemes[i], other.visemes[i])),
            articulators: std::array::from_fn(|i| between(self.articulators[i], other.articulators[i])),
            closed: between(self.closed, other.closed),
            bitten: between(self.bitten, other.bitten),
            loudness: between(self.loudness, other.loudness),
            brows: between(self.brows, other.brows),
        }
    }

    /// The same with smaller movements of jaw, lips, tongue and brows; lips close all the same.
    #[must_use]
    pub fn scaled(&self, amounts: Amounts) -> Self {
        let Amounts { mouth, brows } = amounts.sound();
        let (mouth, brows) = (f64::from(mouth), f64::from(brows));
        Self {
            visemes: self.visemes.map(|weight| mouth * weight),
            articulators: self.articulators.map(|weight| mouth * weight),
            brows: brows * self.brows,
            ..*self
        }
    }

    /// The mouth of shares of visemes for each group, whose sums are 1.
    pub(crate) fn of_groups(
        shares: &[[f64; VISEMES]; GROUPS],
        closed: f64,
        bitten: f64,
        loudness: f64,
    ) -> Self {
        let mut articulators = [0.0; ARTICULATORS];
        for (viseme, target) in TARGETS.iter().enumerate() {
            let own = [shares[0][viseme], shares[1][viseme], shares[2][viseme]];
            if own == [0.0; 3] {
                continue;
            }
            // Group by group rather than by a table, so that the lips' eleven are computed side by side.
            for (group, of_group) in GROUP {
                let wanted = target.articulators.get(of_group.clone()).unwrap_or_default();
                for (value, wanted) in articulators[of_group].iter_mut().zip(wanted) {
                    *value += own[group] * wanted;
                }
            }
        }
        let jaw = &mut articulators[Articulator::JawOpen as usize];
        *jaw = (*jaw * (JAW_QUIET + JAW_LOUD * loudness)).min(1.0);
        let mut visemes = shares[LIPS];
        for (viseme, held) in [(Viseme::FF, bitten), (Viseme::PP, closed)] {
            if held <= 0.0 {
                continue;
            }
            for (value, wanted) in articulators.iter_mut().zip(&target_of(viseme).articulators) {
                *value += held * (wanted - *value);
            }
            visemes.iter_mut().for_each(|share| *share *= 1.0 - held);
            visemes[viseme.index()] += held;
        }
        let brows = BROWS * ease((loudness - BROWS_FROM) / (1.0 - BROWS_FROM));
        Self { visemes, articulators, closed, bitten, loudness, brows }
    }
}
