use crate::SEGMENTS;

/// Fixed steps a second in which hair moves, whatever the frames do.
pub const TICKS_PER_SECOND: f32 = 240.0;

/// After so many seconds without a frame hair hangs still again.
const LONGEST_SECONDS: f64 = 0.5;

/// Shorter frames count as no time.
const SHORTEST_SECONDS: f64 = 1e-6;

/// The slowest swing: slower ones would not settle in the time that is promised.
const SLOWEST: f32 = 1.0;

/// Share of the critical damping: a swing that is followed by one of a quarter of its size.
const DAMPING: f32 = 0.4;

/// How much faster than the tip the strand swings where it leaves the skin, less one.
const STIFFER_AT_ROOT: f32 = 4.0;

/// How a point that is held by a spring moves in one tick: the exact solution of y″ = −ω²y − 2ζωy′, so that
/// no frequency is too high. `y` is measured from where the spring holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillator {
    /// The factors of `y` and of `y′` in the next `y`.
    pub place: [f32; 2],
    /// The factors of `y` and of `y′` in the next `y′`.
    pub speed: [f32; 2],
}

impl Oscillator {
    /// Of a frequency in swings a second without damping; 0 holds the point for good.
    /// The tick lasts `dt_secs`.
    pub fn new(frequency: f32, dt_secs: f64) -> Self {
        if frequency.is_nan() || frequency <= 0.0 || dt_secs <= 0.0 {
            return Self { place: [0.0; 2], speed: [0.0; 2] };
        }
        let omega = f64::from(frequency) * std::f64::consts::TAU;
        let damping = f64::from(DAMPING);
        let damped = omega * (1.0 - damping * damping).sqrt();
        let t = dt_secs;
        let fade = libm::exp(-damping * omega * t);
        let (sin, cos) = (libm::sin(damped * t), libm::cos(damped * t));
        let lean = damping * omega / damped * sin;
        Self {
            place: [(fade * (cos + lean)) as f32, (fade * sin / damped) as f32],
            speed: [(-fade * omega * omega / damped * sin) as f32, (fade * (cos - lean)) as f32],
        }
    }

    /// The oscillators of a strand's points, from root to tip, if the tip swings `frequency` times a second.
    pub fn along(frequency: f32) -> [Self; SEGMENTS + 1] {
        std::array::from_fn(|i| {
            let to_root = 1.0 - i.saturating_sub(1) as f32 / (SEGMENTS - 1) as f32;
            // The first two points are the skin's.
            let held = i < 2;
            let stiffer = 1.0 + STIFFER_AT_ROOT * to_root * to_root;
            let of_point = if held || frequency <= 0.0 { 0.0 } else { frequency.max(SLOWEST) * stiffer };
            Self::new(of_point, 1.0 / f64::from(TICKS_PER_SECOND))
        })
    }
}

/// The ticks of one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ticks {
    /// How many.
    pub count: u32,
    /// Where the first one ends between the last frame (0) and this one (1).
    pub first: f32,
    /// By how much each is later than the one before, in the same measure.
    pub step: f32,
    /// Seconds from the last tick to the frame.
    pub rest: f64,
    /// Whether hair hangs still where it is instead.
    pub is_still: bool,
}

/// Cuts time into ticks: the same ones for every frame rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TickClock {
    rest: f64,
}

impl TickClock {
    /// Goes on by the seconds between two frames. A time that is NaN, below 0 or very long leaves
    /// hair still.
    pub fn advance(&mut self, dt_secs: f64) -> Ticks {
        if !(0.0..=LONGEST_SECONDS).contains(&dt_secs) {
            self.rest = 0.0;
            return Ticks { is_still: true, ..Ticks::default() };
        }
        let tick = 1.0 / f64::from(TICKS_PER_SECOND);
        let whole = self.rest + dt_secs;
        // A frame that ends at a tick but for rounding has had it.
        let count = (whole / tick + 1e-3).floor();
        let per_second = if dt_secs > SHORTEST_SECONDS { 1.0 / dt_secs } else { 0.0 };
        let ticks = Ticks {
            count: count as u32,
            first: ((tick - self.rest) * per_second).clamp(0.0, 1.0) as f32,
            step: (tick * per_second) as f32,
            rest: (whole - count * tick).max(0.0),
            is_still: false,
        };
        self.rest = ticks.rest;
        ticks
    }
}
