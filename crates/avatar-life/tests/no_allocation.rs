//! Living does not allocate.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use avatar_life::{Life, Style, Target};
use pose_anim::ControlTable;

#[test]
fn a_life_does_not_allocate() {
    let controls = ControlTable::default_face();
    let mut life = Life::new(&controls, Style::default(), 3);
    let below = controls.defaults();
    let mut values = below.clone();
    let counted = allocation_counter::measure(|| {
        for frame in 0..20_000u32 {
            if frame % 100 == 0 {
                let side = f64::from(frame % 300) / 300.0;
                life.attend((frame % 3) as usize, Some(Target::face([side, 0.0, 1.0])));
                life.set_style(Style::PRESETS[frame as usize / 100 % 5]);
                life.think(side);
                life.set_light(10.0 * side);
                life.end_utterance();
            }
            life.advance(1.0 / 60.0).unwrap();
            life.apply(&below, &mut values).unwrap();
        }
    });
    assert_eq!(counted.count_total, 0);
    assert!(life.counts().blinks > 50);
}
