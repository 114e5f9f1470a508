/// From 0 at 0 to 1 at 1, with neither speed nor acceleration at both ends: `6x⁵ − 15x⁴ + 10x³`; 0 before
/// and 1 after. So everything that is made of it is C².
pub(crate) fn ease(x: f64) -> f64 {
    let x = if x > 0.0 { x.min(1.0) } else { 0.0 };
    x * x * x * (x * (6.0 * x - 15.0) + 10.0)
}

/// [`ease`] from a time to another one, which may be the same.
pub(crate) fn ease_between(from: f64, to: f64, at: f64) -> f64 {
    // Most movements are over, or have not begun: no division for these.
    if at >= to {
        1.0
    } else if at > from {
        ease((at - from) / (to - from))
    } else {
        0.0
    }
}
