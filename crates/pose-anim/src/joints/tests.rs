use super::*;
use crate::brake::tests::FALLBACKS;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// However presses follow each other, the rotation vector keeps the bound of [`JointPlayer`], and every
    /// brake finds a way.
    #[test]
    fn rotations_keep_their_bound(
        first in 0.02f64..0.2,
        presses in prop::collection::vec(
            (prop::array::uniform4(-1.0f32..1.0), prop_oneof![4 => 1.2f64..1.5, 1 => 0.05f64..8.0], 0.0f64..1.0),
            2..16,
        ),
    ) {
        let before = FALLBACKS.get();
        let mut player = JointPlayer::new(JointTarget { rotation: Quat::IDENTITY, translation: Vec3::ZERO });
        let mut secs = first;
        for (index, ([x, y, z, w], factor, wait)) in presses.into_iter().enumerate() {
            secs = (secs * factor).clamp(0.01, 100.0);
            let translation = Vec3::new(x, y, z);
            player.press(JointTarget { rotation: Quat::from_xyzw(x, y, z, w), translation }, secs);
            let bound = 1.5 * player.widest_rad + 1e-9;
            prop_assert!(player.widest_rad < std::f64::consts::PI + 1e-6);
            for step in 0..=100 {
                let age_secs = f64::from(step) * 0.01 * secs;
                let offset = player.offset.map(|way| way.at(age_secs, secs).value);
                prop_assert!(offset.iter().all(|x| x.abs() <= bound), "press {index}: {offset:?}, {bound}");
            }
            let wait_secs = if index == 0 { 0.5 * secs } else { wait.powi(6) * secs };
            player.advance(wait_secs).unwrap();
        }
        prop_assert_eq!(FALLBACKS.get(), before);
    }
}
