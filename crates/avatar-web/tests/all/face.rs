//! Poses, sliders, people, links.

use avatar_stage::DefaultFace;
use avatar_web::{Avatar, Stage};
use std::sync::OnceLock;

/// The built-in face, which is read once.
pub(crate) fn stage() -> Stage {
    static AVATAR: OnceLock<Avatar> = OnceLock::new();
    Stage::new(AVATAR.get_or_init(|| Avatar::of_pack("marsienne", &DefaultFace).expect("sound")).clone())
}

/// Lets so many seconds pass in frames of a sixtieth.
pub(crate) fn pass(stage: &mut Stage, secs: f64) {
    for _ in 0..(secs * 60.0).round() as usize {
        stage.advance(1.0 / 60.0).expect("time passes");
    }
}

fn value(stage: &Stage, control: &str) -> f32 {
    stage.values()[stage.pack().controls().index(control).expect("a control")]
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn a_pose_arrives_at_the_numbers_of_its_file_and_then_nothing_moves() {
    let mut stage = stage();
    assert!(stage.is_moving(), "the first picture is still to come");
    stage.advance(0.0).expect("time passes");
    stage.drawn();
    assert!(!stage.is_moving());
    stage.press("smile").expect("a pose");
    assert!(stage.is_moving());
    pass(&mut stage, 3.0);
    assert!(!stage.is_moving());
    // poses.toml of pose-anim: the shapes of a smile.
    assert_eq!(value(&stage, "mouthSmileLeft"), 0.95);
    assert_eq!(value(&stage, "jaw.open"), 2.0);
}

#[test]
fn sliders_are_clamped_and_unknown_names_told() {
    let mut stage = stage();
    stage.set("mouthSmileLeft", 7.0).expect("a control");
    pass(&mut stage, 1.0);
    assert_eq!(value(&stage, "mouthSmileLeft"), 1.0);
    let told = stage.set("mouthSmileLef", 1.0).expect_err("no control").to_string();
    assert!(told.contains("mouthSmileLeft"), "{told}");
    assert!(stage.set("mouthSmileLeft", f32::NAN).is_err());
    let told = stage.press("smil").expect_err("no pose").to_string();
    assert!(told.contains("smile"), "{told}");
}

#[test]
fn a_link_leads_to_the_same_face_bit_for_bit() {
    let mut one = stage();
    one.look.set("hair", "bob").expect("a style");
    one.look.set("skin", "#a07050").expect("a colour");
    one.become_person("seed:7 jaw=0.3").expect("somebody");
    one.press("surprise:0.37 wink-left:0.81").expect("a mixture");
    one.orbit(-33.3, 7.7, 0.9);
    one.live("tired", 5).expect("a style");
    let link = one.link();
    let mut other = stage();
    let passed_over = other.follow(&format!("#{link}")).expect("a face");
    assert!(passed_over.is_empty(), "{passed_over:?}");
    assert_eq!(other.link(), link);
    // Where the first comes to when it has arrived.
    one.live("off", 0).expect("no life");
    other.live("off", 0).expect("no life");
    pass(&mut one, 4.0);
    pass(&mut other, 0.1);
    assert_eq!(bits(one.values()), bits(other.values()));
    assert_eq!(bits(one.weights()), bits(other.weights()));
    let matrices = |stage: &Stage| -> Vec<u32> {
        stage.bones().iter().flat_map(|bone| bits(&bone.to_cols_array())).collect()
    };
    assert_eq!(matrices(&one), matrices(&other));
    // A link that names neither person nor look nor view leads to the avatar itself, seen from the front.
    assert_ne!(other.link(), "");
    assert!(other.follow("").expect("a face").is_empty());
    other.advance(0.0).expect("a pose");
    assert_eq!(other.link(), stage().link());
    assert_eq!(matrices(&other), matrices(&posed()));
}

/// The avatar at rest, posed.
fn posed() -> Stage {
    let mut stage = stage();
    stage.advance(0.0).expect("a pose");
    stage
}

#[test]
fn a_link_of_another_avatar_is_followed_as_far_as_it_goes() {
    let mut stage = stage();
    let link = "set=tail.wag:1,mouthSmileLeft:0.5,broken&hair=plaid&nonsense=1&view=1,2&seed=x&life=calm&%";
    let passed_over = stage.follow(link).expect("a face");
    let told: Vec<String> = passed_over.iter().map(ToString::to_string).collect();
    assert_eq!(told.len(), 7, "{told:?}");
    assert_eq!(value(&stage, "mouthSmileLeft"), 0.5);
    assert_eq!(stage.life(), "calm");
}

#[test]
fn people_differ_and_keep_what_the_face_does() {
    let mut stage = stage();
    stage.press("smile").expect("a pose");
    pass(&mut stage, 3.0);
    let before = stage.pack().parts()[0].mesh.positions.clone();
    stage.become_person("seed:7").expect("somebody");
    assert_ne!(stage.pack().parts()[0].mesh.positions, before);
    assert_eq!(value(&stage, "mouthSmileLeft"), 0.95);
    stage.become_person("").expect("herself");
    assert_eq!(stage.pack().parts()[0].mesh.positions, before);
    for (wrong, word) in
        [("jaww=1", "jaw"), ("jaw=2", "-1 to 1"), ("jaw", "AXIS=VALUE"), ("seed:x", "seed:NUMBER")]
    {
        let told = stage.become_person(wrong).expect_err(wrong).to_string();
        assert!(told.contains(word), "{wrong}: {told}");
    }
}

#[test]
fn a_living_face_moves_and_the_same_seed_moves_the_same() {
    let face = |seed| {
        let mut stage = stage();
        stage.live("lively", seed).expect("a style");
        pass(&mut stage, 3.0);
        bits(stage.values())
    };
    let rest = bits(stage().values());
    assert_ne!(face(1), rest);
    assert_eq!(face(1), face(1));
    assert_ne!(face(1), face(2));
    let told = stage().live("lifely", 0).expect_err("no style").to_string();
    assert!(told.contains("did you mean \"lively\""), "{told}");
}

#[test]
fn eyes_follow_a_point_and_look_ahead_again() {
    let mut stage = stage();
    let eye = |stage: &Stage| value(stage, "eye.left.lr");
    // The right of the picture is the character's left, where eyes turn by positive angles.
    stage.look_toward(0.8, 0.0, 1.0).expect("a place");
    pass(&mut stage, 2.0);
    assert!(eye(&stage) + value(&stage, "head.turn") > 5.0, "{}", eye(&stage));
    stage.look_at(None).expect("ahead");
    pass(&mut stage, 3.0);
    assert!(eye(&stage).abs() < 0.01, "{}", eye(&stage));
}

#[test]
fn a_tracker_drives_the_face() {
    let mut stage = stage();
    let channels = avatar_live::channels();
    let mut frame = vec![f32::NAN; channels.len()];
    let place = |name: &str| channels.iter().position(|channel| channel.name == name).expect("a channel");
    frame[place("mouthSmileLeft")] = 0.6;
    frame[place("head.turn")] = 12.0;
    stage.drive(&frame).expect("as many");
    stage.advance(1.0 / 60.0).expect("time passes");
    assert_eq!(value(&stage, "mouthSmileLeft"), 0.6);
    assert_eq!(value(&stage, "head.turn"), 12.0);
    let told = stage.drive(&[0.0; 3]).expect_err("too few").to_string();
    assert_eq!(told, "expected 77 values of channels, found 3");
}

#[test]
fn time_that_makes_no_sense_does_no_harm() {
    let mut stage = stage();
    stage.press("smile").expect("a pose");
    for secs in [f64::NAN, -1.0, f64::INFINITY, 1e300, 0.0] {
        stage.advance(secs).expect("time passes");
    }
    stage.orbit(f32::NAN, 1.0, 1.0);
    stage.orbit(1e30, -1e30, 0.0);
    assert!(stage.scene(1.0, None).camera.eye().is_finite());
}

#[test]
fn what_a_page_is_told_is_what_there_is() {
    let mut stage = stage();
    stage.set("mouthSmileLeft", 0.25).expect("a control");
    let info = stage.info();
    let controls = info["controls"].as_array().expect("a list");
    assert_eq!(controls.len(), stage.pack().controls().len());
    let smile = controls.iter().find(|one| one["name"] == "mouthSmileLeft").expect("a control");
    assert_eq!(smile["value"], 0.25);
    assert_eq!(smile["unit"], "weight");
    assert_eq!(smile["group"], "mouth");
    assert_eq!(info["names"]["bones"].as_array().map(Vec::len), Some(stage.bones().len()));
    assert_eq!(info["names"]["shapes"].as_array().map(Vec::len), Some(stage.weights().len()));
    assert!(
        info["poses"]
            .as_array()
            .expect("a list")
            .iter()
            .any(|pose| pose["name"] == "smile" && pose["key"] == "1")
    );
    assert_eq!(info["options"]["hair"][0], "short");
    assert_eq!(info["speaks"], true);
}
