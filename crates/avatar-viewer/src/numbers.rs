//! Numbers on the command line. Whatever begins with a minus sign is a value of its option, so that these can
//! say what they expected.

/// A number above 0.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    number(text, "a finite number above 0", |x: &f64| x.is_finite() && *x > 0.0)
}

/// Seconds from a beginning.
pub(crate) fn seconds(text: &str) -> Result<f32, String> {
    number(text, "seconds from 0 on", |x: &f32| x.is_finite() && *x >= 0.0)
}

/// Any number.
pub(crate) fn finite(text: &str) -> Result<f32, String> {
    number(text, "a finite number", |x: &f32| x.is_finite())
}

/// How many of something.
pub(crate) fn count(text: &str) -> Result<usize, String> {
    number(text, "a whole number from 0 on", |_| true)
}

/// Where random numbers begin.
pub(crate) fn seed(text: &str) -> Result<u64, String> {
    number(text, &format!("a whole number from 0 to {}", u64::MAX), |_| true)
}

fn number<T: std::str::FromStr>(
    text: &str,
    expected: &str,
    is_allowed: impl Fn(&T) -> bool,
) -> Result<T, String> {
    text.trim().parse().ok().filter(is_allowed).ok_or_else(|| format!("expected {expected}"))
}
