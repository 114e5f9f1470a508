//! Clips and their timeline.

mod support;

use avatar_panel::{Action, Edit, FileClip, FilePlayback, Tab};
use egui::{Key, Modifiers, Pos2, pos2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pose_anim::{Easing, Transition, Wrap};
use support::{Window, World, click};

const MIDDLE: &str = "key 2 of head.bow, 0.50 s, 10.00";

fn window<'a>(world: World) -> Window<'a> {
    let mut window = world.on(Tab::Clips).window([900.0, 700.0]);
    window.run_steps(4);
    window
}

/// Where a time lies on the ruler: from where two keys lie.
fn at(window: &Window<'_>, secs: f32) -> Pos2 {
    let x = |label: &str| window.get_by_label(label).rect().center().x;
    let (start, end) = (x("key 1 of head.bow, 0.00 s, 0.00"), x("key 3 of head.bow, 1.00 s, 0.00"));
    pos2(start + secs * (end - start), window.get_by_label("Playhead, seconds").rect().center().y)
}

fn drag(window: &mut Window<'_>, from: Pos2, to: Pos2) {
    window.hover_at(from);
    window.step();
    window.drag_at(from);
    window.step();
    for share in [0.3, 0.7, 1.0] {
        window.hover_at(from + share * (to - from));
        window.step();
    }
    window.drop_at(to);
    window.run_steps(3);
}

fn keys(window: &Window<'_>) -> Vec<(f64, f64)> {
    let bow = window.state().control("head.bow");
    let keys = window.state().clips[0].track(bow).map(|track| track.keys()).unwrap_or_default();
    keys.iter().map(|key| (key.time_secs, key.value)).collect()
}

#[test]
fn a_clip_plays_pauses_stops_and_repeats() {
    let mut window = window(World::new().nodding());
    assert!(window.get_by_label("Stop").accesskit_node().is_disabled());
    click(&mut window, "Play");
    assert!(window.query_by_label("clip nod, playing").is_some());
    click(&mut window, "Pause");
    click(&mut window, "Stop");
    click(&mut window, "What follows the end: Once");
    click(&mut window, "Loop");
    let wrap = Action::Edit(Edit::SetWrap { clip: 0, wrap: Wrap::Loop });
    assert_eq!(window.state().log, [Action::Play(0), Action::Pause, Action::Stop, wrap]);
    assert!(window.query_by_label("What follows the end: Loop").is_some());
}

#[test]
fn clips_of_the_file_play_halt_and_are_left() {
    let mut world = World::new().nodding();
    world.file_clips =
        vec![FileClip { name: "Dance", duration_secs: 3.0 }, FileClip { name: "Wave", duration_secs: 1.5 }];
    let mut window = window(world);
    assert!(window.query_by_label("Back to the sliders").is_none());
    click(&mut window, "clip Wave of the file");
    window.state_mut().file_playback = Some(FilePlayback { clip: 1, time_secs: 0.25, playing: true });
    window.run_steps(2);
    click(&mut window, "clip Wave of the file, playing");
    window.state_mut().file_playback = Some(FilePlayback { clip: 1, time_secs: 0.5, playing: false });
    window.run_steps(2);
    click(&mut window, "clip Wave of the file");
    click(&mut window, "clip Dance of the file");
    click(&mut window, "Back to the sliders");
    let expected = [
        Action::PlayFileClip(1),
        Action::Pause,
        Action::PlayFileClip(1),
        Action::PlayFileClip(0),
        Action::LeaveFileClip,
    ];
    assert_eq!(window.state().log, expected);
}

#[test]
fn clips_are_made_recorded_saved_and_deleted() {
    let mut window = window(World::new().nodding());
    click(&mut window, "New clip");
    click(&mut window, "Record the face's motion");
    window.state_mut().playback.recording_secs = Some(1.25);
    window.run_steps(2);
    click(&mut window, "Stop recording");
    click(&mut window, "Save clips");
    click(&mut window, "Delete clip nod");
    let expected = [
        Action::Edit(Edit::NewClip),
        Action::StartRecording,
        Action::Edit(Edit::StopRecording),
        Action::Edit(Edit::SaveClips),
        Action::Edit(Edit::DeleteClip(0)),
    ];
    assert_eq!(window.state().log, expected);
}

#[test]
fn dragging_on_the_ruler_scrubs_by_frames() {
    let mut window = window(World::new().nodding());
    let (from, to) = (at(&window, 0.2), at(&window, 0.73));
    drag(&mut window, from, to);
    let scrubs: Vec<f64> = window
        .state()
        .log
        .iter()
        .map(|action| match action {
            Action::Scrub { clip: 0, time_secs } => *time_secs,
            other => panic!("{other:?}"),
        })
        .collect();
    assert!(scrubs.len() > 2);
    // Fifty frames a second; 0.73 is between two.
    assert!(scrubs.iter().all(|secs| (secs * 50.0 - (secs * 50.0).round()).abs() < 1e-9), "{scrubs:?}");
    assert!((window.state().playback.time_secs - 0.73).abs() <= 0.0101);
}

#[test]
fn the_arrow_keys_step_the_playhead_by_frames() {
    let mut window = window(World::new().nodding());
    window.get_by_label("Playhead, seconds").focus();
    window.run_steps(2);
    for _ in 0..3 {
        window.key_press(Key::ArrowRight);
        window.run_steps(2);
    }
    window.key_press(Key::ArrowLeft);
    window.run_steps(2);
    assert!((window.state().playback.time_secs - 0.04).abs() < 1e-9);
    assert!(window.get_by_label("Playhead, seconds").is_focused());
}

#[test]
fn a_key_is_dragged_by_frames_and_not_past_its_neighbour() {
    let mut window = window(World::new().nodding());
    let place = |window: &Window<'_>, label: &str| window.get_by_label(label).rect().center();
    let (from, x) = (place(&window, MIDDLE), at(&window, 0.71).x);
    drag(&mut window, from, pos2(x, from.y));
    assert!(matches!(
        window.state().log[..],
        [Action::Edit(Edit::MoveKey { clip: 0, key: 1, value: 10.0, .. })]
    ));
    let moved = keys(&window)[1].0;
    assert!(
        (moved - 0.71).abs() <= 0.0101 && (moved * 50.0 - (moved * 50.0).round()).abs() < 1e-9,
        "{moved}"
    );

    let from = place(&window, &format!("key 2 of head.bow, {moved:.2} s, 10.00"));
    let x = at(&window, 1.04).x;
    drag(&mut window, from, pos2(x, from.y));
    assert_eq!(keys(&window)[1], (1.0, 10.0));
}

#[test]
fn the_arrow_keys_move_the_focused_key_and_delete_removes_it() {
    let mut window = window(World::new().nodding());
    window.get_by_label(MIDDLE).focus();
    window.run_steps(2);
    window.key_press(Key::ArrowLeft);
    window.run_steps(2);
    assert!((keys(&window)[1].0 - 0.48).abs() < 1e-9);
    window.key_press(Key::Delete);
    window.run_steps(2);
    assert_eq!(keys(&window), [(0.0, 0.0), (1.0, 0.0)]);
}

#[test]
fn a_key_is_baked_in_at_the_playhead() {
    let mut window = window(World::new().nodding());
    assert!(window.get_by_label("Insert key").accesskit_node().is_disabled());
    click(&mut window, "track head.bow");
    let place = at(&window, 0.24);
    drag(&mut window, place, place);
    click(&mut window, "Insert key");
    let keys = keys(&window);
    assert_eq!(keys.len(), 4);
    // On the straight line to 10 at 0.5 s.
    assert!((keys[1].1 - 20.0 * keys[1].0).abs() < 1e-9 && (keys[1].0 - 0.24).abs() <= 0.0101, "{keys:?}");
}

#[test]
fn a_double_click_on_a_track_inserts_there() {
    let mut window = window(World::new().nodding());
    let mut place = at(&window, 0.8);
    place.y = window.get_by_label("track head.bow").rect().center().y + 8.0;
    for _ in 0..2 {
        window.drag_at(place);
        window.step();
        window.drop_at(place);
        window.step();
    }
    let inserted = |action: &Action| matches!(action, Action::Edit(Edit::InsertKey { time_secs, .. }) if (time_secs - 0.8).abs() <= 0.0101);
    assert!(window.state().log.iter().any(inserted), "{:?}", window.state().log);
}

#[test]
fn a_track_is_added() {
    let mut window = window(World::new().nodding());
    click(&mut window, "Add track");
    assert!(window.query_by_label("head.bow").is_none(), "it has a track already");
    let turn = window.state().control("head.turn");
    window.get_by_label("head.turn").click();
    window.step();
    // The track is for the program to make.
    assert_eq!(
        window.state().log.last(),
        Some(&Action::Edit(Edit::InsertKey { clip: 0, control: turn, time_secs: 0.0 }))
    );
}

#[test]
fn the_chosen_key_is_changed_by_numbers_and_buttons() {
    let mut window = window(World::new().nodding());
    click(&mut window, MIDDLE);
    for (field, typed) in [("Value of the key, degrees", "12.5"), ("Time of the key, seconds", "0.25")] {
        click(&mut window, field);
        window.key_combination_modifiers(Modifiers::COMMAND, &[Key::A]);
        window.event(egui::Event::Text(typed.to_owned()));
        window.run_steps(2);
        window.key_press(Key::Enter);
        window.run_steps(3);
    }
    assert_eq!(keys(&window)[1], (0.25, 12.5));
    click(&mut window, "Delete key");
    assert_eq!(keys(&window).len(), 2);
    assert!(window.query_by_label("Delete key").is_none());
}

#[test]
fn the_keyboard_passes_by_numbers_of_a_key_without_rounding_them() {
    let mut window = window(World::new().nodding());
    let bow = window.state().control("head.bow");
    let fine = (0.123_456_789, 1.234_567_89);
    window.state_mut().clips[0].track_mut(bow).unwrap().move_key(1, fine.0, fine.1).unwrap();
    window.run_steps(2);
    click(&mut window, "key 2 of head.bow, 0.12 s, 1.23");
    for field in ["Time of the key, seconds", "Value of the key, degrees"] {
        window.get_by_label(field).focus();
        window.run_steps(2);
        window.key_press(Key::Tab);
        window.run_steps(2);
    }
    assert_eq!(keys(&window)[1], fine);
    assert!(window.state().log.is_empty());
}

#[test]
fn the_transition_is_chosen_from_all_and_its_curve_is_drawn() {
    let mut window = window(World::new().nodding());
    click(&mut window, MIDDLE);
    assert_eq!(window.query_all_by_label("Curve of the transition").count(), 1);
    click(&mut window, "Transition: linear");
    // The first of those that are in view; the list scrolls.
    click(&mut window, "minimum-jerk");
    let bow = window.state().control("head.bow");
    let easing = Easing::MinimumJerk;
    let expected = Action::Edit(Edit::SetTransition { clip: 0, control: bow, key: 1, easing });
    assert_eq!(window.state().log, [expected]);
    let track = window.state().clips[0].track(bow).unwrap();
    assert_eq!(track.keys()[1].transition, Transition::Ease(easing));
    assert!(window.query_by_label("Transition: minimum-jerk").is_some());
}

#[test]
fn the_timeline_zooms_and_fits_and_folds() {
    let mut window = window(World::new().nodding());
    let span = |window: &Window<'_>| {
        let x = |label: &str| window.get_by_label(label).rect().center().x;
        x(MIDDLE) - x("key 1 of head.bow, 0.00 s, 0.00")
    };
    let whole = span(&window);
    click(&mut window, "Show less time");
    assert!((span(&window) / whole - 2.0).abs() < 0.02);
    click(&mut window, "Show the whole clip");
    assert!((span(&window) / whole - 1.0).abs() < 0.01);
    let free = window.state().free;
    click(&mut window, "Fold the timeline");
    window.run_steps(20);
    assert!(window.state().free.height() > free.height() + 40.0);
    assert!(window.query_by_label(MIDDLE).is_none());
    assert!(window.query_by_label("Play").is_some());
}
