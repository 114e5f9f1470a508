/// Real roots of `a·x² + b·x + c`; NaN if there are none. No cancellation (Press et al., Numerical Recipes,
/// 5.6).
pub(crate) fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return [f64::NAN; 2];
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    [q / a, c / q]
}

#[cfg(test)]
mod tests {
    use super::roots;

    #[test]
    fn roots_of_all_kinds() {
        let near = |found: [f64; 2], expected: f64| found.iter().any(|root| (root - expected).abs() < 1e-12);
        let found = roots(1.0, -3.0, 2.0);
        assert!(near(found, 1.0) && near(found, 2.0));
        assert!(near(roots(0.0, 2.0, -1.0), 0.5));
        assert!(near(roots(1.0, -2.0, 1.0), 1.0));
        // Without cancellation.
        assert!(
            (roots(1.0, -1e9, 1.0)[1] - 1e-9).abs() < 1e-24
                || (roots(1.0, -1e9, 1.0)[0] - 1e-9).abs() < 1e-24
        );
        assert!(roots(1.0, 0.0, 1.0).iter().all(|root| root.is_nan()));
    }
}
