//! What runs in each frame allocates nothing.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use face_space::{Calibration, Control, Retarget, Route, Solver, Standard, meaning};

#[test]
fn frames_do_not_allocate() {
    let mut values = Standard::ArKit.space().rest();
    values[16] = 0.7;
    let mut routes: Vec<_> =
        Standard::ALL.iter().filter_map(|to| Route::between(Standard::ArKit, *to)).collect();
    let mut out = vec![0.0; 300];
    let calibration = Calibration::new(Standard::ArKit.space().clone());
    let fields: Vec<Vec<[f32; 3]>> =
        (0..8).map(|k| (0..30).map(|v| [(k * v) as f32 % 7.0, k as f32, 1.0]).collect()).collect();
    let fields: Vec<&[[f32; 3]]> = fields.iter().map(Vec::as_slice).collect();
    let mut solver = Solver::new(&fields, &[[0.0, 1.0]; 8]).unwrap();
    let wanted = vec![[3.0, 1.0, 2.0]; 30];
    let control = |name| Control { means: meaning(name), min: 0.0, max: 1.0, rest: 0.0 };
    let controls = ["expression.aa", "expression.blink", "head.turn", "eye.left.lr"].map(control);
    let mut retarget = Retarget::new(&controls);
    let counted = allocation_counter::measure(|| {
        for route in &mut routes {
            route.apply(&values, &mut out);
        }
        calibration.apply(&mut values);
        retarget.apply(&values, &mut out[..4]);
        solver.solve(&wanted, &mut out[..8]).unwrap();
    });
    assert_eq!(counted.count_total, 0);
    assert_eq!(routes.len(), Standard::ALL.len());
}
