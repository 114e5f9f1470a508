use glam::Vec3;

/// One elementary transformation or one blend-shape weight, with its range: the unit of posing.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    /// Unique name, such as `head.turn`.
    pub name: String,
    /// What the value does.
    pub drives: Drive,
    /// Least value: degrees for rotations, the rig's units for translations, weights for shapes.
    pub min: f32,
    /// Greatest value.
    pub max: f32,
    /// Value in the undeformed face, within the range.
    pub default: f32,
    /// How long moves of this control take by themselves.
    pub pace: Pace,
    /// Heading under which it is listed, such as `brows`; without one its name says where it belongs.
    pub group: Option<String>,
}

/// What a control drives.
#[derive(Clone, Debug, PartialEq)]
pub enum Drive {
    /// A factor of a joint's local transform `L`.
    Joint {
        /// Name of the joint.
        joint: String,
        /// Unit vector in the joint's own frame; a positive value turns about it right-handed, or moves along
        /// it.
        axis: Vec3,
        /// Whether it turns or moves.
        kind: JointMotion,
    },
    /// The weight of a blend shape.
    Shape {
        /// Name of the shape.
        shape: String,
    },
}

/// How a control moves its joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum JointMotion {
    /// About the axis, by degrees.
    #[default]
    Rotation,
    /// Along the axis, in the rig's units.
    Translation,
}

/// Duration of a move of a control, growing linearly with its distance.
///
/// Eye movements follow such a line closely (the *main sequence*; Bahill, Clark & Stark 1975, Carpenter 1988:
/// about 21 ms plus 2.2 ms per degree). For heads, jaws and lids it is a good approximation within their
/// small ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Seconds of the smallest move.
    pub shortest_secs: f64,
    /// Seconds of a move through the whole range.
    pub longest_secs: f64,
}

impl Pace {
    /// A head or neck: 0.4 to 0.9 s.
    pub const HEAD: Self = Self::new(0.4, 0.9);
    /// A jaw: 0.18 to 0.4 s.
    pub const JAW: Self = Self::new(0.18, 0.4);
    /// An eye: 0.06 to 0.2 s.
    pub const EYE: Self = Self::new(0.06, 0.2);
    /// An eyelid: 0.1 to 0.15 s. This is one way, the closing of a blink; the way back is another move. Where
    /// a whole blink, there and back, is to take as long, give its two poses durations, or play a clip.
    pub const LID: Self = Self::new(0.1, 0.15);
    /// A blend shape: 0.2 to 0.4 s.
    pub const SHAPE: Self = Self::new(0.2, 0.4);
    /// Any other joint: 0.3 to 0.6 s.
    pub const OTHER: Self = Self::new(0.3, 0.6);

    /// A pace from its two durations in seconds.
    pub const fn new(shortest_secs: f64, longest_secs: f64) -> Self {
        Self { shortest_secs, longest_secs }
    }

    /// The pace that suits what a control drives, known by the part of the face that the name of the joint or
    /// shape contains: brow, eyelid (also: blink, squint, wide eyes), eye (also: look, gaze), jaw, head or
    /// neck.
    pub fn of(drives: &Drive) -> Self {
        Self::named("", drives)
    }

    /// As [`Self::of`]; if the name of the joint or shape contains none of these words, the name of the
    /// control is tried.
    pub fn named(control: &str, drives: &Drive) -> Self {
        let (driven, otherwise) = match drives {
            Drive::Joint { joint, .. } => (joint, Self::OTHER),
            Drive::Shape { shape } => (shape, Self::SHAPE),
        };
        pace_by_name(driven).or_else(|| pace_by_name(control)).unwrap_or(otherwise)
    }

    /// Seconds of a move by `distance` in a control whose range is `range` wide.
    pub fn duration_secs(self, distance: f64, range: f64) -> f64 {
        let share = if range > 0.0 { (distance.abs() / range).min(1.0) } else { 0.0 };
        self.shortest_secs + (self.longest_secs - self.shortest_secs) * share
    }
}

/// The pace of the part of the face that a name is about, from the more special to the more general: an
/// eyebrow is no eye, and an eye that blinks is a lid.
fn pace_by_name(name: &str) -> Option<Pace> {
    let lower = name.to_lowercase();
    // Long enough to mean nothing else wherever they stand.
    let anywhere = [
        ("brow", Pace::SHAPE),
        ("forehead", Pace::SHAPE),
        ("blink", Pace::LID),
        ("squint", Pace::LID),
        ("eyelid", Pace::LID),
        ("eyewide", Pace::LID),
        ("look", Pace::EYE),
        ("gaze", Pace::EYE),
    ];
    if let Some((_, pace)) = anywhere.iter().find(|(part, _)| lower.contains(part)) {
        return Some(*pace);
    }
    // At the start or end of a word: a slide is no lid.
    let words = words(name);
    let parts = [
        ("lid", Pace::LID),
        ("eye", Pace::EYE),
        ("jaw", Pace::JAW),
        ("head", Pace::HEAD),
        ("neck", Pace::HEAD),
    ];
    let is_about = |part: &str| words.iter().any(|word| word.starts_with(part) || word.ends_with(part));
    parts.iter().find(|(part, _)| is_about(part)).map(|(_, pace)| *pace)
}

/// The words of a name such as `LtUpperLidJoint`, `eye_L` or `lid.left`, in lower case.
fn words(name: &str) -> Vec<String> {
    let (mut words, mut small) = (vec![String::new()], false);
    for letter in name.chars() {
        if !letter.is_alphabetic() || (small && letter.is_uppercase()) {
            words.push(String::new());
        }
        small = letter.is_lowercase();
        if let (true, Some(word)) = (letter.is_alphabetic(), words.last_mut()) {
            word.extend(letter.to_lowercase());
        }
    }
    words
}

/// One control that follows another. See [`crate::Binding::couple`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// Index of the control that leads.
    pub from: usize,
    /// Index of the control that follows.
    pub to: usize,
    /// Change of the follower per change of the leader.
    pub factor: f32,
}

/// Why a list of controls cannot become a [`ControlTable`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("control {index}: expected {expected}, found {found}")]
pub struct ControlError {
    /// Its index in the list, from 0.
    pub index: usize,
    /// What would have been right.
    pub expected: &'static str,
    /// What is there instead.
    pub found: String,
}

/// All controls of a face. The order is that of every slice of values, and within a joint that of
/// composition: `L = M₀ · M₁ · …`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ControlTable {
    controls: Vec<Control>,
    couplings: Vec<Coupling>,
    /// Indices of the controls in the order of their names.
    by_name: Vec<usize>,
}

impl ControlTable {
    /// A table of these controls, without couplings.
    ///
    /// # Errors
    /// A name that comes twice, an empty one, a range that is not finite or not around the default, an axis
    /// that is not of unit length.
    pub fn new(controls: Vec<Control>) -> Result<Self, ControlError> {
        let mut names = std::collections::HashSet::new();
        for (index, control) in controls.iter().enumerate() {
            let wrong = |expected, found: String| ControlError { index, expected, found };
            let Control { name, drives, min, max, default, .. } = control;
            if name.is_empty() || !names.insert(name.as_str()) {
                return Err(wrong("a name of its own", format!("{name:?}")));
            }
            if !(min.is_finite() && max.is_finite() && min <= default && default <= max) {
                return Err(wrong(
                    "a finite range around the default",
                    format!("{default} in {min} to {max}"),
                ));
            }
            if let Drive::Joint { axis, .. } = drives
                && !axis.is_normalized()
            {
                return Err(wrong("an axis of unit length", axis.to_string()));
            }
        }
        Ok(Self::checked(controls, Vec::new()))
    }

    /// A table of these controls, with couplings between them.
    ///
    /// # Errors
    /// As [`ControlTable::new`], and a coupling of controls that do not exist, of a control with itself, or
    /// by a factor that is not finite. Its index in the error counts on from those of the controls.
    pub fn with_couplings(controls: Vec<Control>, couplings: Vec<Coupling>) -> Result<Self, ControlError> {
        let table = Self::new(controls)?;
        let count = table.controls.len();
        let is_sound = |coupling: &Coupling| {
            let Coupling { from, to, factor } = coupling;
            from.max(to) < &count && from != to && factor.is_finite()
        };
        match couplings.iter().position(|coupling| !is_sound(coupling)) {
            Some(index) => Err(ControlError {
                index: count + index,
                expected: "a coupling of two controls by a finite factor",
                found: format!("{:?}", couplings[index]),
            }),
            None => Ok(Self::checked(table.controls, couplings)),
        }
    }

    /// For callers that have checked names, ranges and indices.
    pub(crate) fn checked(controls: Vec<Control>, couplings: Vec<Coupling>) -> Self {
        let mut by_name: Vec<usize> = (0..controls.len()).collect();
        by_name.sort_unstable_by(|a, b| controls[*a].name.cmp(&controls[*b].name));
        Self { controls, couplings, by_name }
    }

    /// The controls in order.
    pub fn controls(&self) -> &[Control] {
        &self.controls
    }

    /// The couplings in the order in which they act.
    pub fn couplings(&self) -> &[Coupling] {
        &self.couplings
    }

    /// Number of controls.
    pub fn len(&self) -> usize {
        self.controls.len()
    }

    /// Whether there is no control at all.
    pub fn is_empty(&self) -> bool {
        self.controls.is_empty()
    }

    /// Index of the control of this name. Takes time that grows with the logarithm of their number.
    pub fn index(&self, name: &str) -> Option<usize> {
        let found = self.by_name.binary_search_by(|index| self.controls[*index].name.as_str().cmp(name));
        found.ok().map(|at| self.by_name[at])
    }

    /// The control's name that is probably meant by a misspelt one.
    pub fn nearest(&self, name: &str) -> Option<&str> {
        placed_toml::nearest(name, self.names())
    }

    /// The names in order.
    pub fn names(&self) -> impl Iterator<Item = &str> + Clone {
        self.controls.iter().map(|control| control.name.as_str())
    }

    /// The values of the undeformed face.
    pub fn defaults(&self) -> Vec<f32> {
        self.controls.iter().map(|control| control.default).collect()
    }
}
