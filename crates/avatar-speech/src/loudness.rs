/// Loudness over time, as somebody measured it in a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Loudness {
    rate_hz: f64,
    samples: Vec<f32>,
}

impl Loudness {
    /// Values from 0 (silent) over 0.5 (as people speak) to 1 (shouted), the first at 0 s, so many a second
    /// (0.1 to 1000; other rates are brought into this range). Values outside are clamped, NaN is 0.
    pub fn new(rate_hz: f64, samples: Vec<f32>) -> Self {
        let rate_hz = if rate_hz.is_nan() { 100.0 } else { rate_hz.clamp(0.1, 1000.0) };
        let sound = |value: f32| if value > 0.0 { value.min(1.0) } else { 0.0 };
        Self { rate_hz, samples: samples.into_iter().map(sound).collect() }
    }

    /// The loudness at a time: a uniform cubic B-spline, so C² and within the range of the values.
    pub fn at(&self, secs: f64) -> f64 {
        let at = secs * self.rate_hz;
        let whole = at.floor();
        let x = at - whole;
        if !x.is_finite() {
            return 0.0;
        }
        // Before the beginning and behind the end is silence.
        let sample = |offset: f64| {
            let index = whole + offset;
            let inside = index >= 0.0 && index < self.samples.len() as f64;
            if inside { f64::from(self.samples[index as usize]) } else { 0.0 }
        };
        let y = 1.0 - x;
        let weights =
            [y * y * y, 3.0 * x * x * x - 6.0 * x * x + 4.0, 3.0 * y * y * y - 6.0 * y * y + 4.0, x * x * x];
        weights.iter().zip([-1.0, 0.0, 1.0, 2.0]).map(|(weight, offset)| weight * sample(offset)).sum::<f64>()
            / 6.0
    }
}
