use crate::amounts::Amounts;
use crate::mouth::{Articulator, Mouth};
use crate::params::ARTICULATORS;
use crate::viseme::{VISEMES, Viseme};
use face_space::Standard;
use pose_anim::{ControlTable, face};
use std::sync::OnceLock;

/// How an avatar is made to speak: what its controls allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Means {
    /// Shapes named as ARKit's: jaw, lips and tongue each at its own times.
    ArKit,
    /// Shapes named as Oculus's visemes.
    Visemes,
    /// The five mouths of VRM: `aa`, `ih`, `ou`, `ee`, `oh`.
    Vrm,
    /// A jaw alone.
    Jaw,
    /// Nothing: the avatar has no mouth that could move.
    Nothing,
}

/// What moves a control.
#[derive(Clone, Copy, Debug)]
enum Source {
    Articulator(usize),
    Visemes(Shares),
    Viseme(usize),
    Brows(f64),
    /// Nothing does: it is only held back.
    Nothing,
}

/// A control that speech moves or holds back.
#[derive(Clone, Copy, Debug)]
struct Wire {
    control: usize,
    source: Source,
    default: f64,
    /// From the default to the maximum.
    room: f64,
    /// Share by which lips that are held take away what the face does otherwise.
    yields: f64,
}

impl Wire {
    fn value(&self, mouth: &Mouth, amounts: Amounts, below: f64) -> f64 {
        let (of_mouth, of_brows) = (f64::from(amounts.mouth), f64::from(amounts.brows));
        let held = 1.0 - (1.0 - mouth.closed) * (1.0 - mouth.bitten);
        let wanted = match self.source {
            Source::Articulator(index) => of_mouth * mouth.articulators[index],
            Source::Viseme(index) => of_mouth * mouth.visemes[index],
            Source::Visemes(shares) => {
                let weight = |(viseme, share): &(Viseme, f64)| share * mouth.visemes[viseme.index()];
                of_mouth * shares.iter().map(weight).sum::<f64>()
            }
            Source::Brows(share) => of_brows * share * mouth.brows,
            Source::Nothing => 0.0,
        };
        let own = (below - self.default) * (1.0 - self.yields * held);
        self.default + own + wanted * (self.room - own)
    }
}

/// The way from a [`Mouth`] to the controls of one avatar.
#[derive(Clone, Debug)]
pub struct SpeechMap {
    means: Means,
    wires: Vec<Wire>,
}

/// Visemes that one mouth stands for, each with its weight.
type Shares = &'static [(Viseme, f64)];

/// A mouth of VRM 1.0: the name of its control, and what it shares in each viseme. Those of VRM 0.x have
/// other names in their files, and these as controls.
struct VrmMouth {
    control: String,
    shares: Vec<(Viseme, f64)>,
}

/// The mouths of VRM, as the map from visemes to its expressions has them.
fn vrm() -> &'static [VrmMouth] {
    static MOUTHS: OnceLock<Vec<VrmMouth>> = OnceLock::new();
    MOUTHS.get_or_init(|| {
        let Some(map) = Standard::Oculus.map_to(Standard::Vrm1) else { return Vec::new() };
        let mouth = |rule: &face_space::Rule| {
            let share = |term: &face_space::Term| {
                let viseme = Viseme::ALL.get(*term.of.first()?)?;
                // As it is written, in decimals.
                Some((*viseme, (f64::from(term.by) * 1e6).round() / 1e6))
            };
            let shares = rule.terms.iter().filter_map(share).collect();
            Some(VrmMouth { control: format!("expression.{}", map.to().names().get(rule.to)?.name), shares })
        };
        map.rules().iter().filter_map(mouth).collect()
    })
}

/// Controls that part the lips, beside those of [`vrm`], and the share of each that lips take away while they
/// are held. What does nothing but part the lips goes entirely. The share of the smile was found on the
/// built-in face, whose lips then close under all of its poses (`tests/tests/speech.rs` measures them). Those
/// of VRM's expressions are guesses: each avatar has shapes of its own for them.
const PARTING: [(&str, f64); 15] = [
    (face::JAW_OPEN, 1.0),
    ("jawOpen", 1.0),
    ("tongueOut", 1.0),
    ("mouthFunnel", 1.0),
    ("mouthUpperUpLeft", 1.0),
    ("mouthUpperUpRight", 1.0),
    ("mouthLowerDownLeft", 1.0),
    ("mouthLowerDownRight", 1.0),
    ("mouthOpen", 1.0),
    (face::SMILE, 0.7),
    ("expression.happy", 0.7),
    ("expression.relaxed", 0.7),
    ("expression.angry", 0.7),
    ("expression.sad", 0.7),
    ("expression.surprised", 0.9),
];

/// The share of a control that held lips take away.
fn parting(name: &str) -> f64 {
    if vrm().iter().any(|mouth| mouth.control == name) {
        return 1.0;
    }
    PARTING.iter().find(|(parting, _)| *parting == name).map_or(0.0, |(_, share)| *share)
}

/// The fewest shapes of a set that are enough to speak with.
const ENOUGH_ARTICULATORS: usize = 5;
const ENOUGH_VISEMES: usize = 6;
const ENOUGH_VRM: usize = 3;

impl SpeechMap {
    /// The map for an avatar with these controls: ARKit's shapes if it has enough of them, else visemes, else
    /// the mouths of VRM, else a jaw.
    pub fn new(controls: &ControlTable) -> Self {
        let mut wires = Vec::new();
        let articulators: Vec<_> = Articulator::ALL
            .into_iter()
            .filter_map(|articulator| Some((articulator, of_articulator(controls, articulator)?)))
            .collect();
        let visemes: Vec<_> = Viseme::ALL
            .into_iter()
            .filter_map(|viseme| Some((viseme, controls.index(&format!("viseme_{}", viseme.name()))?)))
            .collect();
        let vrm: Vec<(Shares, usize)> = (vrm().iter())
            .filter_map(|mouth| Some((mouth.shares.as_slice(), controls.index(&mouth.control)?)))
            .collect();
        let jaw = of_articulator(controls, Articulator::JawOpen);
        let means = if articulators.len() >= ENOUGH_ARTICULATORS {
            for (articulator, found) in articulators {
                let source = Source::Articulator(articulator as usize);
                wires.extend(found.into_iter().flatten().map(|control| (control, source)));
            }
            Means::ArKit
        } else if visemes.len() >= ENOUGH_VISEMES {
            wires.extend(
                visemes.into_iter().map(|(viseme, control)| (control, Source::Viseme(viseme.index()))),
            );
            Means::Visemes
        } else if vrm.len() >= ENOUGH_VRM {
            wires.extend(vrm.into_iter().map(|(visemes, control)| (control, Source::Visemes(visemes))));
            Means::Vrm
        } else if let Some(jaw) = jaw {
            let source = Source::Articulator(Articulator::JawOpen as usize);
            wires.extend(jaw.into_iter().flatten().map(|control| (control, source)));
            Means::Jaw
        } else {
            Means::Nothing
        };
        let brows = [("browInnerUp", 1.0), ("browOuterUpLeft", 0.6), ("browOuterUpRight", 0.6)];
        if means != Means::Nothing {
            wires.extend(
                brows.iter().filter_map(|(name, share)| Some((controls.index(name)?, Source::Brows(*share)))),
            );
            for (index, control) in controls.controls().iter().enumerate() {
                if parting(&control.name) > 0.0 && !wires.iter().any(|(wired, _)| *wired == index) {
                    wires.push((index, Source::Nothing));
                }
            }
        }
        let wire = |(control, source): (usize, Source)| {
            let entry = controls.controls().get(control)?;
            let yields = if matches!(source, Source::Viseme(_)) { 1.0 } else { parting(&entry.name) };
            let default = f64::from(entry.default);
            let room = f64::from(entry.max) - default;
            // A control without room above its default cannot show anything.
            (room > 0.0).then_some(Wire { control, source, default, room, yields })
        };
        Self { means, wires: wires.into_iter().filter_map(wire).collect() }
    }

    /// What the avatar speaks with.
    pub fn means(&self) -> Means {
        self.means
    }

    /// The controls that speech moves or holds back.
    pub fn controls(&self) -> impl Iterator<Item = usize> + '_ {
        self.wires.iter().map(|wire| wire.control)
    }

    /// Lays a mouth over the values of a face, in the order of its controls. Of what the face does already,
    /// lips that are held take away what would part them; to the rest `x` the weight `y` of speech is added
    /// as `x + y − xy`, in shares of the way from the default to the maximum: so values stay within their
    /// ranges, and the result is as smooth as both are. Values that are missing are passed over. Allocates
    /// nothing.
    pub fn apply(&self, mouth: &Mouth, amounts: Amounts, values: &mut [f32]) {
        let amounts = amounts.sound();
        for wire in &self.wires {
            if let Some(value) = values.get_mut(wire.control) {
                *value = wire.value(mouth, amounts, f64::from(*value)) as f32;
            }
        }
    }

    /// The value of one control over a value below, in full precision, as [`Self::apply`] makes it. A control
    /// that speech does not concern keeps its value.
    pub fn value(&self, mouth: &Mouth, amounts: Amounts, control: usize, below: f64) -> f64 {
        let amounts = amounts.sound();
        let wires = self.wires.iter().filter(|wire| wire.control == control);
        wires.fold(below, |below, wire| wire.value(mouth, amounts, below))
    }

    /// Weights of Oculus's visemes, in the order of [`Viseme::ALL`].
    pub fn oculus(mouth: &Mouth) -> [f32; VISEMES] {
        mouth.visemes.map(|weight| weight as f32)
    }

    /// Weights of ARKit's shapes by their names.
    pub fn arkit(mouth: &Mouth) -> impl Iterator<Item = (&'static str, f32)> + use<> {
        let weights: [f64; ARTICULATORS] = mouth.articulators;
        Articulator::ALL.into_iter().zip(weights).flat_map(|(articulator, weight)| {
            articulator.names().iter().map(move |name| (*name, weight as f32))
        })
    }
}

/// The controls of an articulator; of the jaw, the bone before the shape.
fn of_articulator(controls: &ControlTable, articulator: Articulator) -> Option<[Option<usize>; 2]> {
    if articulator == Articulator::JawOpen
        && let Some(bone) = controls.index(face::JAW_OPEN)
    {
        return Some([Some(bone), None]);
    }
    let mut found = [None; 2];
    for (slot, name) in found.iter_mut().zip(articulator.names()) {
        *slot = controls.index(name);
    }
    found.iter().any(Option::is_some).then_some(found)
}
