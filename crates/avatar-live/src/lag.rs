//! Lags of the first order, one after the other: what makes corners smooth. Their answer to a pulse is never
//! below 0, so that what they put out stays within the range of what is put in.

/// Two equal lags that follow a line: twice continuously differentiable for any input that does not jump.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct TwoLags {
    first: f64,
    second: f64,
}

/// What the lags of all channels share in a step: `exp(−k h)` and `k`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    rate: f64,
    secs: f64,
    kept: f64,
}

impl Step {
    /// A step of so many seconds, of lags whose answers come at this rate: 1 / (seconds of delay of one).
    pub(crate) fn new(rate: f64, secs: f64) -> Self {
        Self { rate, secs, kept: libm::exp(-rate * secs) }
    }
}

impl TwoLags {
    /// At rest.
    pub(crate) fn at(value: f64) -> Self {
        Self { first: value, second: value }
    }

    pub(crate) fn value(&self) -> f64 {
        self.second
    }

    /// Whether it is where it goes, as far as that matters.
    pub(crate) fn is_at(&self, target: f64, near: f64) -> bool {
        (self.first - target).abs() < near && (self.second - target).abs() < near
    }

    /// Goes on while the input goes in a line from one value to another. This is the solution of
    /// `x₁' = k (u − x₁)`, `x₂' = k (x₁ − x₂)`, so the length of steps does not matter.
    pub(crate) fn go(&mut self, step: &Step, from: f64, to: f64) {
        let Step { rate, secs, kept } = *step;
        if secs <= 0.0 {
            return;
        }
        // How far a lag is behind a line.
        let behind = (to - from) / (secs * rate);
        let a = self.first - from + behind;
        let b = self.second - from + 2.0 * behind;
        self.first = to - behind + a * kept;
        self.second = to - 2.0 * behind + (b + a * rate * secs) * kept;
    }
}

/// Three equal lags that follow steps between 0 and 1, twice continuously differentiable.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ThreeLags {
    values: [f64; 3],
}

impl ThreeLags {
    /// At rest.
    pub(crate) fn at(value: f64) -> Self {
        Self { values: [value; 3] }
    }

    pub(crate) fn value(&self) -> f64 {
        self.values[2]
    }

    /// Whether it is where it goes, as far as that matters.
    pub(crate) fn is_at(&self, target: f64, near: f64) -> bool {
        self.values.iter().all(|value| (value - target).abs() < near)
    }

    /// Goes toward a value that stays the same meanwhile.
    pub(crate) fn go(&mut self, step: &Step, target: f64) {
        let Step { rate, secs, kept } = *step;
        let [a, b, c] = self.values.map(|value| value - target);
        let turned = rate * secs;
        self.values = [a, b + a * turned, c + b * turned + a * turned * turned / 2.0]
            .map(|behind| (target + behind * kept).clamp(0.0, 1.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small steps of Euler are the reference.
    #[test]
    fn steps_are_the_solution() {
        let (mut lags, mut x) = (TwoLags { first: 0.2, second: -0.4 }, [0.2, -0.4]);
        let (mut three, mut y) = (ThreeLags { values: [0.1, 0.7, 0.3] }, [0.1, 0.7, 0.3]);
        let (rate, secs, from, to) = (30.0, 0.1, 0.5, -0.3);
        lags.go(&Step::new(rate, secs), from, to);
        three.go(&Step::new(rate, secs), 1.0);
        let count = 1_000_000;
        let h = secs / f64::from(count);
        for index in 0..count {
            let u = from + (to - from) * (f64::from(index) + 0.5) / f64::from(count);
            x = [x[0] + h * rate * (u - x[0]), x[1] + h * rate * (x[0] - x[1])];
            y = [
                y[0] + h * rate * (1.0 - y[0]),
                y[1] + h * rate * (y[0] - y[1]),
                y[2] + h * rate * (y[1] - y[2]),
            ];
        }
        assert!((lags.first - x[0]).abs() < 1e-5 && (lags.second - x[1]).abs() < 1e-5, "{lags:?} {x:?}");
        assert!(three.values.iter().zip(y).all(|(a, b)| (a - b).abs() < 1e-5), "{three:?} {y:?}");
    }

    #[test]
    fn ten_steps_are_one() {
        let (mut once, mut often) = (TwoLags::at(0.1), TwoLags::at(0.1));
        once.go(&Step::new(50.0, 0.1), 0.0, 1.0);
        for index in 0..10 {
            often.go(&Step::new(50.0, 0.01), f64::from(index) / 10.0, f64::from(index + 1) / 10.0);
        }
        assert!((once.value() - often.value()).abs() < 1e-12);
        let (mut once, mut often) = (ThreeLags::at(0.0), ThreeLags::at(0.0));
        once.go(&Step::new(9.0, 0.4), 1.0);
        (0..10).for_each(|_| often.go(&Step::new(9.0, 0.04), 1.0));
        assert!((once.value() - often.value()).abs() < 1e-12);
    }
}
