use face_space::{Control, Retarget, Standard, meaning};
use proptest::prelude::*;

/// An avatar whose controls have these names, with shapes from 0 to 1 and the nine-joint face's own ranges.
struct Avatar {
    names: Vec<String>,
    controls: Vec<Control>,
}

impl Avatar {
    fn new<S: AsRef<str>>(names: &[S]) -> Self {
        let names: Vec<String> = names.iter().map(|name| name.as_ref().to_owned()).collect();
        let control = |name: &String| {
            let means = meaning(name);
            let [min, max] = match means {
                Some((space, place)) => [space.space().names()[place].min, space.space().names()[place].max],
                None => [0.0, 1.0],
            };
            Control { means, min, max, rest: 0.0 }
        };
        Self { controls: names.iter().map(control).collect(), names }
    }

    /// What is away from rest for these of Live Link's values.
    fn shows(&self, live: &[(&str, f32)]) -> Vec<(&str, f32)> {
        let space = Standard::LiveLink.space();
        let mut values = space.rest();
        for (name, value) in live {
            values[space.index(name).unwrap()] = *value;
        }
        let mut shown = vec![0.0; self.names.len()];
        Retarget::new(&self.controls).apply(&values, &mut shown);
        let shown = self.names.iter().map(String::as_str).zip(shown);
        shown.filter(|(_, value)| *value != 0.0).collect()
    }

    fn unsaid(&self) -> Vec<&'static str> {
        let names = Standard::ArKit.space().names();
        Retarget::new(&self.controls).unsaid().iter().map(|at| names[*at].name.as_str()).collect()
    }
}

const VRM: [&str; 18] = [
    "head.turn",
    "head.bow",
    "head.bend",
    "eye.left.ud",
    "eye.left.lr",
    "eye.right.ud",
    "eye.right.lr",
    "expression.happy",
    "expression.aa",
    "expression.ih",
    "expression.ou",
    "expression.ee",
    "expression.oh",
    "expression.blink",
    "expression.lookLeft",
    "expression.lookRight",
    "expression.lookUp",
    "Spine.x",
];

#[test]
fn shapes_of_arkit_are_shown_as_they_are() {
    let names: Vec<_> = Standard::ArKit.space().names().iter().map(|name| name.name.as_str()).collect();
    // The default face has joints for some of them, too: shapes and mixtures go first.
    let avatar = Avatar::new(&[&names[..], &["jaw.open", "lid.left.upper", "head.turn", "smile"]].concat());
    for (at, name) in names.iter().enumerate() {
        let value = 0.25 + at as f32 / 100.0;
        assert_eq!(avatar.shows(&[(name, value)]), [(*name, value)]);
    }
    assert_eq!(avatar.shows(&[("headYaw", 0.5)]), [("head.turn", 0.5f32.to_degrees())]);
    assert_eq!(avatar.unsaid(), [""; 0]);
}

#[test]
fn joints_show_what_shapes_do_not() {
    let avatar = Avatar::new(&[
        "head.turn",
        "head.bow",
        "head.bend",
        "jaw.open",
        "lid.left.upper",
        "lid.right.upper",
        "smile",
    ]);
    assert_eq!(
        avatar.shows(&[("jawOpen", 0.5), ("eyeBlinkLeft", 1.0)]),
        [("jaw.open", 10.0), ("lid.left.upper", 45.0)]
    );
    assert_eq!(avatar.shows(&[("mouthSmileLeft", 1.0), ("mouthSmileRight", 0.5)]), [("smile", 0.75)]);
    // A head that is lifted by 0.1 and bends to the left by 2, further than it can.
    let head = [("head.bow", -0.1f32.to_degrees()), ("head.bend", 40.0)];
    assert_eq!(avatar.shows(&[("headPitch", 0.1), ("headRoll", 2.0)]), head);
    assert!(avatar.unsaid().contains(&"browDownLeft"));
    assert!(!avatar.unsaid().contains(&"jawOpen"));
}

#[test]
fn expressions_show_what_joints_do_not() {
    let avatar = Avatar::new(&VRM);
    // Eyes turn by their joints, and not by expressions a second time.
    let left = [("eyeLookOutLeft", 1.0), ("eyeLookInRight", 1.0)];
    assert_eq!(avatar.shows(&left), [("eye.left.lr", 30.0), ("eye.right.lr", 30.0)]);
    // The avatar cannot wink: one eye of two is half a blink.
    assert_eq!(avatar.shows(&[("eyeBlinkLeft", 1.0)]), [("expression.blink", 0.5)]);
    let shown = avatar.shows(&[("jawOpen", 0.5)]);
    assert_eq!(shown.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["expression.aa"]);
    let unsaid = avatar.unsaid();
    assert!(unsaid.contains(&"cheekPuff") && !unsaid.contains(&"mouthPucker"), "{unsaid:?}");
    let winks = Avatar::new(&["expression.blink", "expression.blinkLeft", "expression.blinkRight"]);
    assert_eq!(winks.shows(&[("eyeBlinkLeft", 1.0)]), [("expression.blinkLeft", 1.0)]);
}

/// Custom expressions that are named as ARKit's shapes, as programs for such avatars ask for.
#[test]
fn custom_expressions_of_arkit_go_first() {
    let avatar = Avatar::new(&[
        "expression.EyeBlinkLeft",
        "expression.blinkLeft",
        "expression.jawOpen",
        "expression.aa",
    ]);
    let shown = avatar.shows(&[("eyeBlinkLeft", 0.5), ("jawOpen", 0.25)]);
    assert_eq!(shown, [("expression.EyeBlinkLeft", 0.5), ("expression.jawOpen", 0.25)]);
}

#[test]
fn visemes_show_a_mouth() {
    let names: Vec<_> = Standard::Oculus.space().names().iter().map(|name| name.name.as_str()).collect();
    let avatar = Avatar::new(&names);
    let open = avatar.shows(&[("jawOpen", 0.9)]);
    assert_eq!(open.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["viseme_aa"]);
    assert_eq!(avatar.shows(&[("tongueOut", 0.5)]), [("viseme_TH", 0.6)]);
}

#[test]
fn a_calibrated_face_rests() {
    let avatar = Avatar::new(&VRM);
    let space = Standard::LiveLink.space();
    let mut retarget = Retarget::new(&avatar.controls);
    let mut resting = space.rest();
    for (name, value) in [("jawOpen", 0.08), ("headYaw", 0.2), ("mouthSmileLeft", 0.1)] {
        resting[space.index(name).unwrap()] = value;
    }
    retarget.calibration().set_neutral(&resting);
    let mut shown = vec![0.0; VRM.len()];
    retarget.apply(&resting, &mut shown);
    assert_eq!(shown, [0.0; 18]);
}

#[test]
fn other_controls_are_left_alone() {
    let avatar = Avatar::new(&VRM);
    let mut retarget = Retarget::new(&avatar.controls);
    let set: Vec<usize> = retarget.controls().collect();
    let mut values = vec![7.0; 18];
    retarget.apply_arkit(&Standard::ArKit.space().rest(), &mut values);
    // Without angles, the head is.
    for (at, value) in values.iter().enumerate() {
        assert_eq!(*value == 7.0, !set.contains(&at) || VRM[at].starts_with("head."), "{}", VRM[at]);
    }
    assert!(!set.contains(&17));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever the numbers and the avatar, controls stay within their ranges.
    #[test]
    fn controls_stay_in_range(live in prop::collection::vec(prop::num::f32::ANY, 0..70), picked in any::<u64>()) {
        let all: Vec<String> = Standard::ALL.iter().flat_map(|space| space.space().names().iter().map(|name| name.name.clone())).collect();
        let names: Vec<&String> = all.iter().enumerate().filter(|(at, _)| picked.rotate_left(*at as u32 * 7) & 3 == 0).map(|(_, name)| name).collect();
        let avatar = Avatar::new(&names);
        let mut shown = vec![0.0; names.len()];
        Retarget::new(&avatar.controls).apply(&live, &mut shown);
        for ((value, control), name) in shown.iter().zip(&avatar.controls).zip(&names) {
            prop_assert!((control.min..=control.max).contains(value), "{name}: {value}");
        }
    }
}
