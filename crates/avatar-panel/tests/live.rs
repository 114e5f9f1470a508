//! The tab of live faces.

mod support;

use avatar_panel::{Action, Edit, Inlet, Live, LiveSender, Tab, Wish};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use support::{Window, World, click};

const INLETS: &[Inlet<'static>] = &[
    Inlet { name: "Live Link Face", place: Some("127.0.0.1:11111") },
    Inlet { name: "VMC and OSC", place: None },
];

const SENDERS: &[LiveSender<'static>] = &[
    LiveSender {
        name: "Ann",
        protocol: "livelink",
        is_followed: true,
        is_live: true,
        rate_hz: 59.9,
        received: 990,
        lost: 10,
        late: 0,
        delay_ms: 24.0,
    },
    LiveSender { name: "Bob", protocol: "vmc", ..LiveSender::NONE },
];

fn live() -> Live<'static> {
    Live {
        inlets: INLETS,
        hears_others: false,
        turned_away: &[],
        recording: None,
        senders: &[],
        is_choice: false,
        draw_ms: None,
        is_calibrated: false,
        calibration_file: Some("/home/ann/calibration.toml"),
        is_mirrored: false,
        smooth: 0.0,
        is_on_top: false,
    }
}

fn window<'a>(live: Option<Live<'static>>) -> Window<'a> {
    let mut world = World::new();
    world.live = live;
    let mut window = world.on(Tab::Live).window([900.0, 700.0]);
    window.run_steps(4);
    window
}

#[test]
fn formats_are_listened_to_and_others_are_heard() {
    let mut window = window(Some(live()));
    assert!(window.query_by_label("Nobody has sent anything yet.").is_some());
    assert!(window.query_by_label("127.0.0.1:11111").is_some());
    for label in ["Live Link Face", "VMC and OSC", "From other computers and phones, too"] {
        click(&mut window, label);
    }
    click(&mut window, "Play a recording…");
    click(&mut window, "Always on top");
    let expected = [
        Wish::Listen { inlet: 0, is_wanted: false },
        Wish::Listen { inlet: 1, is_wanted: true },
        Wish::HearOthers(true),
        Wish::Play,
        Wish::OnTop(true),
    ];
    assert_eq!(window.state().log, expected.map(Action::Live));
}

#[test]
fn pages_that_were_turned_away_are_let_in() {
    let long = format!("https://example.org.{}.elsewhere.example", "a".repeat(60));
    let pages: &'static [String] = Vec::leak(vec!["https://example.org".to_owned(), long]);
    let mut window = window(Some(Live { turned_away: pages, ..live() }));
    assert!(window.query_by_label("https://example.org").is_some());
    assert!(window.query_by_label("https://…aaaaa.elsewhere.example").is_some(), "whose it is can be seen");
    click(&mut window, &format!("Let in {}", pages[1]));
    click(&mut window, "Let in https://example.org");
    assert_eq!(window.state().log, [1, 0].map(|page| Action::Live(Wish::LetIn(page))));
}

#[test]
fn a_sender_is_chosen_calibrated_smoothed_and_recorded() {
    let mut window = window(Some(Live { senders: SENDERS, draw_ms: Some(7.6), ..live() }));
    assert!(window.query_by_label("livelink: 10 lost (1.0 %), delay 24 ms").is_some());
    assert!(window.query_by_label("A face is drawn 8 ms after its time.").is_some());
    click(&mut window, "sender Bob, silent");
    click(&mut window, "Calibrate");
    click(&mut window, "As in a mirror");
    assert!(window.get_by_label("Forget").accesskit_node().is_disabled(), "there is nothing to forget");
    let slider = window.get_by_role_and_label(egui::accesskit::Role::Slider, "Smooth");
    slider.set_value_accesskit(0.5);
    window.run_steps(4);
    click(&mut window, "Record the face's motion");
    window.state_mut().playback.recording_secs = Some(1.5);
    window.run_steps(4);
    click(&mut window, "Stop recording");
    // The first row follows whoever sends, which it does already.
    click(&mut window, "Whoever sends a face");
    window.state_mut().live = Some(Live { senders: SENDERS, is_choice: true, is_calibrated: true, ..live() });
    window.run_steps(4);
    click(&mut window, "Whoever sends a face");
    click(&mut window, "Forget");
    let expected = [
        Action::Live(Wish::Follow(Some(1))),
        Action::Live(Wish::Calibrate),
        Action::Live(Wish::Mirror(true)),
        Action::Live(Wish::Smooth(0.5)),
        Action::StartRecording,
        Action::Edit(Edit::StopRecording),
        Action::Live(Wish::Follow(None)),
        Action::Live(Wish::ForgetCalibration),
    ];
    assert_eq!(window.state().log, expected);
}

#[test]
fn who_does_not_listen_says_so_and_nobody_can_be_calibrated() {
    assert!(window(None).query_by_label("This program listens to nobody.").is_some());
    let window = window(Some(live()));
    assert!(window.get_by_label("Calibrate").accesskit_node().is_disabled());
}
