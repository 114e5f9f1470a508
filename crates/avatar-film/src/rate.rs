use std::fmt;
use std::str::FromStr;

/// Not a [`Rate`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected frames per second from {} to {}, as a number or a fraction of numbers up to 65535 (30, 12.5, 30000/1001), found {found}",
    Rate::SLOWEST,
    Rate::FASTEST
)]
pub struct RateError {
    /// What was given.
    pub found: String,
}

/// Frames per second, as a fraction in lowest terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    frames: u16,
    secs: u16,
}

impl Rate {
    /// The least frames per second.
    pub const SLOWEST: f64 = 0.01;
    /// The most frames per second.
    pub const FASTEST: f64 = 240.0;

    /// So many frames in so many seconds.
    ///
    /// # Errors
    /// A rate outside of [`Self::SLOWEST`] to [`Self::FASTEST`], or one that is no fraction of two 16-bit
    /// numbers.
    pub fn new(frames: u32, secs: u32) -> Result<Self, RateError> {
        let error = || RateError { found: format!("{frames}/{secs}") };
        let divisor = gcd(frames, secs);
        let share = |number: u32| number.checked_div(divisor).and_then(|share| u16::try_from(share).ok());
        let (frames, secs) = share(frames).zip(share(secs)).ok_or_else(error)?;
        let rate = Self { frames, secs };
        if secs == 0 || !(Self::SLOWEST..=Self::FASTEST).contains(&rate.per_second()) {
            return Err(error());
        }
        Ok(rate)
    }

    /// Numerator of frames per second.
    pub const fn frames(self) -> u16 {
        self.frames
    }

    /// Denominator of frames per second.
    pub const fn secs(self) -> u16 {
        self.secs
    }

    /// Frames per second.
    pub fn per_second(self) -> f64 {
        f64::from(self.frames) / f64::from(self.secs)
    }

    /// Seconds from the film's beginning to that of this frame, rounded once.
    pub fn time_secs(self, frame: u64) -> f64 {
        // Exact up to 2⁵³ in the numerator: 4000 years of the slowest film.
        (frame * u64::from(self.secs)) as f64 / f64::from(self.frames)
    }

    /// How many frames begin before this time; at least one.
    pub fn frames_before(self, secs: f64) -> u64 {
        // A product may lie a rounding error above a whole number.
        (secs * self.per_second() * (1.0 - 1e-12)).ceil().max(1.0) as u64
    }
}

impl FromStr for Rate {
    type Err = RateError;

    fn from_str(text: &str) -> Result<Self, RateError> {
        let error = || RateError { found: format!("{text:?}") };
        // Not parse alone: it takes a sign.
        let number = |digits: &str| -> Option<u32> {
            digits.bytes().all(|digit| digit.is_ascii_digit()).then(|| digits.parse().ok())?
        };
        let fraction = if let Some((frames, secs)) = text.split_once('/') {
            number(frames).zip(number(secs))
        } else if let Some((whole, decimals)) = text.split_once('.') {
            let scale = u32::try_from(decimals.len()).ok().and_then(|places| 10u32.checked_pow(places));
            number(&format!("{whole}{decimals}")).zip(scale)
        } else {
            number(text).map(|frames| (frames, 1))
        };
        let (frames, secs) = fraction.ok_or_else(error)?;
        Self::new(frames, secs).map_err(|_| error())
    }
}

impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.secs {
            1 => write!(f, "{}", self.frames),
            secs => write!(f, "{}/{secs}", self.frames),
        }
    }
}

fn gcd(mut a: u32, mut b: u32) -> u32 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_read_as_fractions() {
        for (text, frames, secs) in [
            ("30", 30, 1),
            ("12.5", 25, 2),
            ("29.97", 2997, 100),
            ("30000/1001", 30000, 1001),
            ("60/2", 30, 1),
            ("0.01", 1, 100),
            ("240", 240, 1),
            (".5", 1, 2),
        ] {
            let rate: Rate = text.parse().expect(text);
            assert_eq!((rate.frames(), rate.secs()), (frames, secs), "{text}");
            assert_eq!(rate.to_string().parse(), Ok(rate), "{text}");
        }
        for text in
            ["", "0", "-1", "+30", "nan", "inf", "1e2", "240.1", "0.009", "1/0", "0/0", "/", ".", "1.2.3"]
        {
            let error = text.parse::<Rate>().expect_err(text);
            assert!(error.to_string().contains("expected frames per second from 0.01 to 240"), "{error}");
        }
        assert!("59.94006".parse::<Rate>().is_err(), "2997003/50000 is no fraction of 16-bit numbers");
    }

    #[test]
    fn frames_begin_at_their_times() {
        let rate = Rate::new(30000, 1001).expect("a rate");
        assert_eq!(rate.time_secs(30000), 1001.0);
        let rate = Rate::new(15, 1).expect("a rate");
        assert_eq!(rate.frames_before(3.0), 45);
        assert_eq!(rate.frames_before(3.01), 46);
        assert_eq!(rate.frames_before(0.0), 1);
        for frame in 1..10_000 {
            assert_eq!(rate.frames_before(rate.time_secs(frame)), frame);
        }
    }
}
