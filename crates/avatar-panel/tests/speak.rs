//! The tab of speech.

mod support;

use avatar_panel::{Action, Tab};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use support::{Window, World, click};

fn window<'a>(world: World) -> Window<'a> {
    let mut window = world.on(Tab::Speak).window([900.0, 700.0]);
    window.run_steps(4);
    window
}

#[test]
fn a_file_is_opened_spoken_again_and_stopped() {
    let mut world = World::new();
    world.speaking.duration_secs = 2.5;
    let mut window = window(world);
    assert!(window.query_by_label("Speak").is_none(), "nothing to speak yet");
    click(&mut window, "Open sound or labels…");
    window.state_mut().speaking.file = Some("talk.TextGrid");
    window.run_steps(4);
    assert!(window.get_by_label("Stop speaking").accesskit_node().is_disabled());
    click(&mut window, "Speak");
    window.state_mut().speaking.time_secs = 1.25;
    window.run_steps(4);
    assert!(
        window.query_by_label("Spoken: 1.2 of 2.5 s").is_some()
            || window.query_by_label("Spoken: 1.3 of 2.5 s").is_some()
    );
    assert!(window.query_by_label("Speak").is_none());
    click(&mut window, "Speak again from the beginning");
    click(&mut window, "Stop speaking");
    let expected = [Action::OpenSpeech, Action::Speak, Action::Speak, Action::StopSpeaking];
    assert_eq!(window.state().log, expected);
}

#[test]
fn what_is_not_heard_says_why() {
    let mut world = World::new();
    world.speaking.file = Some("talk.lab");
    let mut window = window(world);
    assert!(window.query_by_label("Without sound: there is none beside the labels.").is_some());
    window.state_mut().speaking.sound = Some(Err("expected a device that plays sound, found none"));
    window.run_steps(4);
    let why = "Without sound: expected a device that plays sound, found none";
    assert!(window.query_by_label(why).is_some());
    window.state_mut().speaking.sound = Some(Ok(()));
    window.run_steps(4);
    assert!(window.query_by_label_contains("Without sound").is_none());
}

#[test]
fn a_text_is_said_by_a_voice() {
    let mut window = window(World::new());
    assert!(window.get_by_label("Say it").accesskit_node().is_disabled(), "nothing to say");
    window.get_by_label("Text to say").click();
    window.run_steps(4);
    window.get_by_label("Text to say").type_text("Guten Tag");
    window.run_steps(4);
    click(&mut window, "Say it");
    window.get_by_label("Voice, as in de or en-us+f3").click();
    window.run_steps(4);
    window.get_by_label("Voice, as in de or en-us+f3").type_text(" de ");
    window.run_steps(4);
    click(&mut window, "Say it");
    let said =
        |voice: Option<&str>| Action::Say { text: "Guten Tag".to_owned(), voice: voice.map(str::to_owned) };
    assert_eq!(window.state().log, [said(None), said(Some("de"))]);
}

#[test]
fn what_is_spoken_is_filmed() {
    let mut world = World::new();
    world.speaking.file = Some("talk.wav");
    let mut window = window(world);
    click(&mut window, "Film: PNG frames");
    assert_eq!(window.state().log, [Action::FilmSpeech(0)]);
}

#[test]
fn the_microphone_is_turned_on_and_off_or_refused_in_words() {
    const MICROPHONE: &str = "The face says what the microphone hears";
    let mut window = window(World::new());
    click(&mut window, MICROPHONE);
    assert_eq!(window.state().speaking.microphone, Ok(true));
    assert!(window.query_by_label("Loudness").is_some());
    click(&mut window, MICROPHONE);
    assert_eq!(window.state().log, [Action::Microphone, Action::Microphone]);
    window.state_mut().speaking.microphone = Err("This program was built without sound.");
    window.run_steps(4);
    assert!(window.get_by_label(MICROPHONE).accesskit_node().is_disabled());
    assert!(window.query_by_label("This program was built without sound.").is_some());
}

#[test]
fn the_amount_is_a_slider_and_a_face_without_a_mouth_says_so() {
    let mut world = World::new();
    world.speaking.file = Some("talk.lab");
    world.speaking.cannot = Some("This face has no mouth.");
    let mut window = window(world);
    assert!(window.query_by_label("This face has no mouth.").is_some());
    assert!(window.get_by_label("Speak").accesskit_node().is_disabled());
    let slider = window.get_by_role_and_label(egui::accesskit::Role::Slider, "How much the mouth moves");
    slider.set_value_accesskit(0.5);
    window.run_steps(4);
    assert_eq!(window.state().log, [Action::SpeechAmount(0.5)]);
}

#[test]
fn the_face_is_told_to_live_in_the_view() {
    let mut world = World::new().on(Tab::View);
    world.life = Some(true);
    let mut window = world.window([900.0, 700.0]);
    window.run_steps(4);
    click(&mut window, "The face lives by itself");
    assert_eq!((window.state().life, window.state().log.as_slice()), (Some(false), &[Action::Life][..]));
}
