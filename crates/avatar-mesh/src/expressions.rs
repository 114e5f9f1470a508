//! Expressions that add shapes up and hold each other back: how VRM 1.0 makes weights of shapes from values
//! of expressions (`expressions.md` of its specification, "Procedural override"). A smile may keep the eyes
//! from blinking, so that lids do not pierce cheeks.
//!
//! ```text
//! output = clamp(value, 0, 1), or 1 where a binary one is above 0.5, else 0
//! rate   = Σ over expressions, 1 for a block with output > 0, the output for a blend
//! factor = 1 − clamp(rate, 0, 1)       for blinks, looks and mouths; 0 of a binary one with a rate above 0
//! weight = Σ output · factor · weight of the bind
//! ```
//!
//! An expression does not hold back others of its own group.

use lanes::{LANES, Lanes, Simd, Work};

/// An expression of the face.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Expression {
    /// Whether values above 0.5 count as 1 and others as 0.
    pub is_binary: bool,
    /// The group that it belongs to, if any.
    pub group: Option<Group>,
    /// What it does to the expressions of each group, in the order of [`Group::ALL`].
    pub overrides: [Override; 3],
    /// Weights, by their positions, and how much each one gets at the expression's value 1.
    pub binds: Vec<(usize, f32)>,
}

/// Expressions that others hold back together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Closing of eyes.
    Blink,
    /// Looking in a direction.
    LookAt,
    /// Mouths of speech.
    Mouth,
}

impl Group {
    /// All groups.
    pub const ALL: [Self; 3] = [Self::Blink, Self::LookAt, Self::Mouth];
}

/// What an expression does to others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Override {
    /// Nothing.
    #[default]
    None,
    /// Any value above 0 puts them to 0.
    Block,
    /// Its value takes that much of theirs.
    Blend,
}

impl Override {
    /// How much an expression with this output takes from others.
    #[inline(always)]
    fn rate(self, output: f32) -> f32 {
        match self {
            Self::None => 0.0,
            Self::Block => f32::from(u8::from(output > 0.0)),
            Self::Blend => output,
        }
    }
}

/// The value that is used of an expression: clamped to 0…1, and either 0 or 1 for binary ones. NaN counts as
/// 0.
#[inline(always)]
pub fn output(value: f32, is_binary: bool) -> f32 {
    let value = if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) };
    match is_binary {
        true => f32::from(u8::from(value > 0.5)),
        false => value,
    }
}

/// Adds to weights what expressions of these values make. Expressions without a value have 0; binds beyond
/// the weights do nothing. Allocates nothing.
///
/// ```
/// use avatar_mesh::expressions::{Expression, Group, Override, add};
///
/// let blend = [Override::Blend, Override::None, Override::None];
/// let happy = Expression { overrides: blend, binds: vec![(0, 1.0)], ..Expression::default() };
/// let blink = Expression { group: Some(Group::Blink), binds: vec![(1, 1.0)], ..Expression::default() };
/// let mut weights = [0.0; 2];
/// add(&[happy, blink], &[0.75, 1.0], &mut weights);
/// assert_eq!(weights, [0.75, 0.25]);
/// ```
pub fn add(expressions: &[Expression], values: &[f32], weights: &mut [f32]) {
    let with_outputs = || {
        let values = values.iter().copied().chain(std::iter::repeat(0.0));
        expressions.iter().zip(values).map(|(one, value)| (one, output(value, one.is_binary)))
    };
    let rates = Group::ALL.map(|group| {
        let others = with_outputs().filter(|(one, _)| one.group != Some(group));
        others.map(|(one, output)| one.overrides[group as usize].rate(output)).sum::<f32>().clamp(0.0, 1.0)
    });
    for (one, output) in with_outputs().filter(|(_, output)| *output > 0.0) {
        let rate = one.group.map_or(0.0, |group| rates[group as usize]);
        let factor = factor(one.is_binary, rate);
        for &(at, weight) in &one.binds {
            if let Some(slot) = weights.get_mut(at) {
                *slot += output * factor * weight;
            }
        }
    }
}

/// What is left of an expression from which others take this rate.
#[inline(always)]
fn factor(is_binary: bool, rate: f32) -> f32 {
    if is_binary && rate > 0.0 { 0.0 } else { 1.0 - rate }
}

/// [`add`] for [`LANES`] faces at once, with the same bits.
pub fn add_lanes(expressions: &[Expression], values: &[Lanes], weights: &mut [Lanes]) {
    lanes::run(Add { expressions, values, weights });
}

/// What is done to each lane is what [`add`] does, in its order; the compiler takes the lanes of a loop
/// together.
struct Add<'a> {
    expressions: &'a [Expression],
    values: &'a [Lanes],
    weights: &'a mut [Lanes],
}

impl Work for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { expressions, values, weights } = self;
        let with_values = || expressions.iter().zip(values);
        let mut rates = [Lanes::splat(0.0); Group::ALL.len()];
        for (group, rate) in Group::ALL.into_iter().zip(&mut rates) {
            for (one, value) in with_values().filter(|(one, _)| one.group != Some(group)) {
                let taken = one.overrides[group as usize];
                for (rate, value) in rate.iter_mut().zip(value.iter()) {
                    *rate += taken.rate(output(*value, one.is_binary));
                }
            }
            rate.iter_mut().for_each(|rate| *rate = rate.clamp(0.0, 1.0));
        }
        for (one, value) in with_values() {
            let rate = one.group.map_or(Lanes::splat(0.0), |group| rates[group as usize]);
            for &(at, weight) in &one.binds {
                let Some(slot) = weights.get_mut(at) else { continue };
                for lane in 0..LANES {
                    let output = output(value[lane], one.is_binary);
                    let more = slot[lane] + output * factor(one.is_binary, rate[lane]) * weight;
                    slot[lane] = if output > 0.0 { more } else { slot[lane] };
                }
            }
        }
    }
}
