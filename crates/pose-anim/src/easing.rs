use crate::Jet;
use std::f64::consts::{LN_2, PI, TAU};

/// A transition function: how far a move has come, `f(s)`, when the share `s` of its time is over; `f(0) = 0`
/// and `f(1) = 1`.
///
/// The families are those of R. Penner (*Robert Penner's Programming Macromedia Flash MX*, 2002, ch. 7), with
/// the constants of d3-ease, which is also where the exponential ones get their small correction from: they
/// meet 0 and 1 exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Easing {
    /// `s`.
    Linear,
    /// 1 at once.
    StepStart,
    /// 0 until the end.
    StepEnd,
    /// `10s³ − 15s⁴ + 6s⁵`: the smoothest ([`Jet::step`]).
    MinimumJerk,
    /// One of the usual families.
    Family(Family, Direction),
    /// A cubic Bézier curve from (0, 0) to (1, 1) with the handles (x1, y1) and (x2, y2), as `cubic-bezier()`
    /// in CSS (W3C, *CSS Easing Functions Level 1*). The x are taken as clamped to 0…1.
    Bezier([f64; 4]),
}

/// The usual families of transition functions, by their accelerating (`In`) form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// `s²`.
    Quad,
    /// `s³`.
    Cubic,
    /// `s⁴`.
    Quart,
    /// `s⁵`.
    Quint,
    /// `1 − cos(πs/2)`.
    Sine,
    /// `2^(10(s − 1))`, shifted and scaled to meet 0 and 1.
    Expo,
    /// `1 − √(1 − s²)`.
    Circ,
    /// `s²((k + 1)s − k)`, `k = 1.70158`: goes back by a tenth first.
    Back,
    /// An exponential times a sine of period 0.3: swings ever wider.
    Elastic,
    /// Parabolas: bounces ever higher.
    Bounce,
}

/// Which end of a transition is the slow one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Starts slowly: `f(s)`.
    In,
    /// Ends slowly: `1 − f(1 − s)`.
    Out,
    /// Both halves: `f(2s)/2`, then `1 − f(2 − 2s)/2`.
    InOut,
}

const FAMILIES: [(&str, Family); 10] = [
    ("quad", Family::Quad),
    ("cubic", Family::Cubic),
    ("quart", Family::Quart),
    ("quint", Family::Quint),
    ("sine", Family::Sine),
    ("expo", Family::Expo),
    ("circ", Family::Circ),
    ("back", Family::Back),
    ("elastic", Family::Elastic),
    ("bounce", Family::Bounce),
];

const DIRECTIONS: [(&str, Direction); 3] =
    [("in-out", Direction::InOut), ("in", Direction::In), ("out", Direction::Out)];

const PLAIN: [(&str, Easing); 9] = [
    ("linear", Easing::Linear),
    ("step", Easing::StepEnd),
    ("step-end", Easing::StepEnd),
    ("step-start", Easing::StepStart),
    ("minimum-jerk", Easing::MinimumJerk),
    ("ease", Easing::Bezier([0.25, 0.1, 0.25, 1.0])),
    ("ease-in", Easing::Bezier([0.42, 0.0, 1.0, 1.0])),
    ("ease-out", Easing::Bezier([0.0, 0.0, 0.58, 1.0])),
    ("ease-in-out", Easing::Bezier([0.42, 0.0, 0.58, 1.0])),
];

impl Easing {
    /// The function of a name: `linear`, `step` (= `step-end`), `step-start`, `minimum-jerk`, the families as
    /// `quad-in`, `quad-out`, `quad-in-out`, …, and CSS's `ease`, `ease-in`, `ease-out`, `ease-in-out`.
    pub fn from_name(name: &str) -> Option<Self> {
        if let Some((_, easing)) = PLAIN.iter().find(|(plain, _)| *plain == name) {
            return Some(*easing);
        }
        let (family, direction) = name.split_once('-')?;
        let (_, family) = FAMILIES.iter().find(|(other, _)| *other == family)?;
        let (_, direction) = DIRECTIONS.iter().find(|(other, _)| *other == direction)?;
        Some(Self::Family(*family, *direction))
    }

    /// Whether the numbers make a usable curve: Bézier handles are finite, and no further than
    /// [`Self::FURTHEST`] up or down. (Their x are clamped anyway.)
    pub fn is_sound(self) -> bool {
        match self {
            Self::Bezier([x1, y1, x2, y2]) => {
                x1.is_finite() && x2.is_finite() && y1.abs() <= Self::FURTHEST && y2.abs() <= Self::FURTHEST
            }
            _ => true,
        }
    }

    /// The furthest that a Bézier handle may reach up or down: a thousand times the move's distance. Handles
    /// beyond that would give derivatives that overflow.
    pub const FURTHEST: f64 = 1000.0;

    /// Whether the function goes beyond 0 or 1 on purpose.
    pub(crate) fn overshoots(self) -> bool {
        match self {
            Self::Family(Family::Back | Family::Elastic, _) => true,
            Self::Bezier([_, y1, _, y2]) => !(0.0..=1.0).contains(&y1) || !(0.0..=1.0).contains(&y2),
            Self::Linear | Self::StepStart | Self::StepEnd | Self::MinimumJerk | Self::Family(..) => false,
        }
    }

    /// The name by which [`Self::from_name`] knows the function; `None` for a Bézier curve that has none.
    pub fn name(self) -> Option<String> {
        if let Some((name, _)) = PLAIN.iter().find(|(_, plain)| *plain == self) {
            return Some((*name).to_owned());
        }
        let Self::Family(family, direction) = self else { return None };
        let (family, _) = FAMILIES.iter().find(|(_, other)| *other == family)?;
        let (direction, _) = DIRECTIONS.iter().find(|(_, other)| *other == direction)?;
        Some(format!("{family}-{direction}"))
    }

    /// All names that [`Self::from_name`] knows.
    pub fn names() -> Vec<String> {
        let families = FAMILIES.iter().flat_map(|(family, _)| {
            DIRECTIONS.iter().map(move |(direction, _)| format!("{family}-{direction}"))
        });
        PLAIN.iter().map(|(name, _)| (*name).to_owned()).chain(families).collect()
    }

    /// The function with its first two derivatives by `s`, which is clamped to 0…1. A derivative that is
    /// infinite at an end (the circle) is taken very close to it.
    pub fn at(self, s: f64) -> Jet {
        let s = s.clamp(0.0, 1.0);
        match self {
            Self::Linear => Jet { value: s, velocity: 1.0, acceleration: 0.0 },
            Self::StepStart => Jet::rest(if s > 0.0 { 1.0 } else { 0.0 }),
            Self::StepEnd => Jet::rest(if s < 1.0 { 0.0 } else { 1.0 }),
            Self::MinimumJerk => Jet::step(s, 1.0),
            Self::Bezier(handles) => bezier(handles, s),
            Self::Family(family, Direction::In) => family.at(s),
            Self::Family(family, Direction::Out) => mirrored(family.at(1.0 - s)),
            Self::Family(family, Direction::InOut) if s < 0.5 => halved(family.at(2.0 * s)),
            Self::Family(family, Direction::InOut) => mirrored(halved(family.at(2.0 - 2.0 * s))),
        }
    }

    /// The function of the same move played backward: `1 − f(1 − s)`.
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Self::StepStart => Self::StepEnd,
            Self::StepEnd => Self::StepStart,
            Self::Family(family, Direction::In) => Self::Family(family, Direction::Out),
            Self::Family(family, Direction::Out) => Self::Family(family, Direction::In),
            Self::Bezier([x1, y1, x2, y2]) => Self::Bezier([1.0 - x2, 1.0 - y2, 1.0 - x1, 1.0 - y1]),
            Self::Linear | Self::MinimumJerk | Self::Family(_, Direction::InOut) => self,
        }
    }
}

/// `1 − f(1 − s)` from the jet of `f` at `1 − s`.
fn mirrored(jet: Jet) -> Jet {
    Jet { value: 1.0 - jet.value, velocity: jet.velocity, acceleration: -jet.acceleration }
}

/// `f(2s)/2` from the jet of `f` at `2s`.
fn halved(jet: Jet) -> Jet {
    Jet { value: 0.5 * jet.value, velocity: jet.velocity, acceleration: 2.0 * jet.acceleration }
}

impl Family {
    /// The accelerating form.
    fn at(self, s: f64) -> Jet {
        match self {
            Self::Quad => Jet { value: s * s, velocity: 2.0 * s, acceleration: 2.0 },
            Self::Cubic => Jet { value: s * s * s, velocity: 3.0 * s * s, acceleration: 6.0 * s },
            Self::Quart => Jet { value: s.powi(4), velocity: 4.0 * s.powi(3), acceleration: 12.0 * s * s },
            Self::Quint => {
                Jet { value: s.powi(5), velocity: 5.0 * s.powi(4), acceleration: 20.0 * s.powi(3) }
            }
            Self::Sine => {
                let quarter = 0.5 * PI;
                let (sin, cos) = (quarter * s).sin_cos();
                // The cosine of a quarter turn is not 0 in floating point.
                let value = if s == 1.0 { 1.0 } else { 1.0 - cos };
                Jet { value, velocity: quarter * sin, acceleration: quarter * quarter * cos }
            }
            Self::Expo => exponential(s),
            Self::Circ => {
                let root = (1.0 - s * s).sqrt();
                // Infinite at s = 1.
                let slope_root = root.max(1e-6);
                Jet { value: 1.0 - root, velocity: s / slope_root, acceleration: slope_root.powi(-3) }
            }
            Self::Back => {
                const OVERSHOOT: f64 = 1.70158;
                Jet {
                    value: s * s * (OVERSHOOT * (s - 1.0) + s),
                    velocity: s * (3.0 * (OVERSHOOT + 1.0) * s - 2.0 * OVERSHOOT),
                    acceleration: 6.0 * (OVERSHOOT + 1.0) * s - 2.0 * OVERSHOOT,
                }
            }
            Self::Elastic => {
                // The phase puts a crest at the end.
                let rate = TAU / 0.3;
                let (sin, cos) = (0.5 * PI - rate * (s - 1.0)).sin_cos();
                exponential(s) * Jet { value: sin, velocity: -rate * cos, acceleration: -rate * rate * sin }
            }
            Self::Bounce => mirrored(bounce_out(1.0 - s)),
        }
    }
}

/// `2^(10(s − 1))`, shifted and scaled so that it is 0 at 0.
fn exponential(s: f64) -> Jet {
    const LEAST: f64 = 1.0 / 1024.0;
    let scale = 1.0 / (1.0 - LEAST);
    let power = (10.0 * (s - 1.0)).exp2();
    let rate = 10.0 * LN_2;
    Jet {
        value: (power - LEAST) * scale,
        velocity: rate * power * scale,
        acceleration: rate * rate * power * scale,
    }
}

/// Four parabolas of one curvature, which touch 1.
fn bounce_out(s: f64) -> Jet {
    const CURVE: f64 = 121.0 / 16.0;
    let (middle, height) = match s {
        s if s < 4.0 / 11.0 => (0.0, 0.0),
        s if s < 8.0 / 11.0 => (6.0 / 11.0, 3.0 / 4.0),
        s if s < 10.0 / 11.0 => (9.0 / 11.0, 15.0 / 16.0),
        _ => (21.0 / 22.0, 63.0 / 64.0),
    };
    let d = s - middle;
    Jet { value: CURVE * d * d + height, velocity: 2.0 * CURVE * d, acceleration: 2.0 * CURVE }
}

/// The curve's y where its x is `s`.
fn bezier([x1, y1, x2, y2]: [f64; 4], s: f64) -> Jet {
    let (x1, x2) = (x1.clamp(0.0, 1.0), x2.clamp(0.0, 1.0));
    // In powers of the curve's parameter τ.
    let powers = |p1: f64, p2: f64| [3.0 * p1, 3.0 * p2 - 6.0 * p1, 1.0 + 3.0 * p1 - 3.0 * p2];
    let ([xa, xb, xc], [ya, yb, yc]) = (powers(x1, x2), powers(y1, y2));
    let x = |t: f64| t * (xa + t * (xb + t * xc));
    let x_slope = |t: f64| xa + t * (2.0 * xb + 3.0 * xc * t);
    // x grows with τ. Newton's method converges at once nearly everywhere; where it leaves its bracket,
    // bisect.
    let (mut low, mut high, mut t) = (0.0, 1.0, s);
    for _ in 0..64 {
        let off = x(t) - s;
        if off == 0.0 {
            break;
        }
        if off > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let newton = t - off / x_slope(t);
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if next == t {
            break;
        }
        t = next;
    }
    if s == 0.0 || s == 1.0 {
        t = s;
    }
    // 0 only where a handle lies on its end's time.
    let dx = x_slope(t).max(1e-9);
    let dy = ya + t * (2.0 * yb + 3.0 * yc * t);
    let (ddx, ddy) = (2.0 * xb + 6.0 * xc * t, 2.0 * yb + 6.0 * yc * t);
    Jet {
        value: t * (ya + t * (yb + t * yc)),
        velocity: dy / dx,
        acceleration: (ddy * dx - dy * ddx) / (dx * dx * dx),
    }
}
