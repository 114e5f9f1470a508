//! Sliders and controls.

mod support;

use avatar_panel::Action;
use egui::accesskit::Role;
use egui::{Event, Key, PointerButton, Pos2, Rect, pos2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use support::{Window, World, many};

const SIZE: [f32; 2] = [900.0, 700.0];

fn window<'a>() -> Window<'a> {
    let mut window = World::new().window(SIZE);
    window.run_steps(3);
    window
}

/// Where a slider has a share of its range: the centre of egui's round handle stays a radius, height / 2.5,
/// off the ends.
fn at(slider: Rect, share: f32) -> Pos2 {
    let radius = slider.height() / 2.5;
    pos2(slider.left() + radius + share * (slider.width() - 2.0 * radius), slider.center().y)
}

fn press(window: &mut Window<'_>, pos: Pos2, pressed: bool) {
    let event =
        Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Default::default() };
    window.event(event);
    window.step();
}

fn move_to(window: &mut Window<'_>, pos: Pos2) {
    window.event(Event::PointerMoved(pos));
    window.step();
}

#[test]
fn dragging_a_slider_sets_the_control_and_tells_when_it_ends() {
    let mut window = window();
    let turn = window.state().control("head.turn");
    let slider = window.get_by_label("head.turn, degrees").rect();
    move_to(&mut window, at(slider, 0.5));
    press(&mut window, at(slider, 0.5), true);
    move_to(&mut window, at(slider, 0.6));
    move_to(&mut window, at(slider, 0.75));
    press(&mut window, at(slider, 0.75), false);
    window.run_steps(2);
    // -70 to 70 degrees; a point of the rail is more than one of them.
    let value = window.state().values[turn];
    assert!((value - 35.0).abs() < 140.0 / slider.width(), "{value}");
    let sets: Vec<bool> = window
        .state()
        .log
        .iter()
        .filter_map(|action| match action {
            Action::SetControl { control, dragging, .. } if *control == turn => Some(*dragging),
            _ => None,
        })
        .collect();
    let (last, before) = sets.split_last().unwrap();
    assert!(before.len() >= 2 && before.iter().all(|dragging| *dragging) && !last, "{sets:?}");
}

#[test]
fn a_control_moves_its_slider() {
    let mut window = window();
    let open = window.state().control("jaw.open");
    window.state_mut().values[open] = 12.5;
    window.step();
    let slider = window.get_by_label("jaw.open, degrees");
    assert_eq!(slider.accesskit_node().numeric_value(), Some(12.5));
    let entry = window.get_by_label("value of jaw.open, degrees");
    assert_eq!(entry.accesskit_node().numeric_value(), Some(12.5));
}

#[test]
fn a_typed_value_is_taken_and_kept_within_the_range() {
    let mut window = window();
    let open = window.state().control("jaw.open");
    for (typed, expected) in [("7.5", 7.5), ("99", 20.0)] {
        window.get_by_label("value of jaw.open, degrees").click();
        window.run_steps(2);
        window.key_combination_modifiers(egui::Modifiers::COMMAND, &[Key::A]);
        window.event(Event::Text(typed.to_owned()));
        window.run_steps(2);
        window.key_press(Key::Enter);
        window.run_steps(2);
        assert_eq!(window.state().values[open], expected);
    }
}

#[test]
fn a_double_click_resets() {
    let mut window = window();
    let turn = window.state().control("head.turn");
    window.state_mut().values[turn] = 40.0;
    window.step();
    let middle = at(window.get_by_label("head.turn, degrees").rect(), 0.9);
    move_to(&mut window, middle);
    for pressed in [true, false, true, false] {
        press(&mut window, middle, pressed);
    }
    window.step();
    assert!(window.state().log.contains(&Action::ResetControl(turn)));
    assert_eq!(window.state().values[turn], 0.0);
}

#[test]
fn the_dot_of_a_changed_control_resets_it_and_an_unchanged_one_has_none() {
    let mut window = window();
    let smile = window.state().control("smile");
    assert!(window.query_by_label("Reset smile").is_none());
    window.state_mut().values[smile] = 0.4;
    window.step();
    window.get_by_label("Reset smile").click();
    window.run_steps(3);
    assert_eq!(window.state().values[smile], 0.0);
    assert!(window.query_by_label("Reset smile").is_none());
}

#[test]
fn all_controls_are_reset_at_once() {
    let mut window = window();
    assert!(window.get_by_label("Reset all").accesskit_node().is_disabled());
    window.state_mut().values.fill(0.5);
    window.step();
    window.get_by_label("Reset all").click();
    window.run_steps(2);
    assert_eq!(window.state().values, window.state().controls.defaults());
}

#[test]
fn arrow_keys_move_the_focused_slider_and_only_that() {
    let mut window = window();
    let turn = window.state().control("head.turn");
    window.get_by_label("head.turn, degrees").focus();
    window.run_steps(2);
    window.key_press(Key::ArrowRight);
    window.run_steps(2);
    let once = window.state().values[turn];
    assert!(once > 0.0);
    window.key_press(Key::ArrowLeft);
    window.key_press(Key::ArrowLeft);
    window.run_steps(2);
    assert!(window.state().values[turn] < 0.0);
    assert!(window.get_by_label("head.turn, degrees").is_focused());
    let others =
        window.state().values.iter().enumerate().filter(|(index, value)| *index != turn && **value != 0.0);
    assert_eq!(others.count(), 0);
}

#[test]
fn the_keyboard_passes_by_without_rounding_what_it_passes() {
    let mut window = window();
    window.state_mut().values.fill(0.123_456_7);
    for _ in 0..70 {
        window.key_press(Key::Tab);
        window.run_steps(2);
    }
    let changed = |action: &&Action| matches!(action, Action::SetControl { .. });
    let changes: Vec<_> = window.state().log.iter().filter(changed).collect();
    assert!(changes.is_empty(), "{changes:?}");
}

#[test]
fn hovering_tells_the_control_once_and_that_it_ends() {
    let mut window = window();
    let (bow, open) = (window.state().control("head.bow"), window.state().control("jaw.open"));
    let over = |window: &Window<'_>, name: &str| window.get_by_label(name).rect().center();
    let place = over(&window, "head.bow, degrees");
    move_to(&mut window, place);
    window.run_steps(3);
    let place = over(&window, "value of jaw.open, degrees");
    move_to(&mut window, place);
    window.run_steps(3);
    move_to(&mut window, pos2(50.0, 350.0));
    window.run_steps(3);
    let hovers: Vec<_> =
        window.state().log.iter().filter(|action| matches!(action, Action::Hover(_))).cloned().collect();
    assert_eq!(hovers, [Action::Hover(Some(bow)), Action::Hover(Some(open)), Action::Hover(None)]);
}

#[test]
fn the_search_filters() {
    let mut window = window();
    window.get_by_label("Search controls").click();
    window.run_steps(2);
    window.get_by_label("Search controls").type_text("EYE up");
    window.run_steps(3);
    assert!(window.query_by_label("eye.left.ud, degrees").is_none());
    window.get_by_label("Clear the search").click();
    window.run_steps(3);
    window.get_by_label("Search controls").click();
    window.run_steps(2);
    window.get_by_label("Search controls").type_text("ye UD");
    window.run_steps(3);
    let sliders = window.get_all_by_role(Role::Slider).filter_map(|node| node.accesskit_node().label());
    assert_eq!(sliders.collect::<Vec<_>>(), ["eye.left.ud, degrees", "eye.right.ud, degrees"]);
}

#[test]
fn a_group_folds_and_opens() {
    let mut window = window();
    window.get_by_label("Head, 3 controls, open").click();
    window.run_steps(3);
    assert!(window.query_by_label("head.turn, degrees").is_none());
    assert!(window.query_by_label("jaw.open, degrees").is_some());
    window.get_by_label("Head, 3 controls, closed").click();
    window.run_steps(3);
    assert!(window.query_by_label("head.turn, degrees").is_some());
}

#[test]
fn tab_reaches_every_one_of_a_hundred_controls() {
    let mut window = World::with(many(100)).window([600.0, 400.0]);
    window.run_steps(3);
    let mut reached = std::collections::BTreeSet::new();
    for _ in 0..260 {
        window.key_press(Key::Tab);
        window.run_steps(2);
        let focused = window.query_all_by_role(Role::Slider).find(|node| node.is_focused());
        if let Some(label) = focused.and_then(|node| node.accesskit_node().label()) {
            reached.insert(label);
        }
    }
    assert_eq!(reached.len(), 100, "{reached:?}");
}

#[test]
#[expect(clippy::disallowed_methods, reason = "it is a clock that is needed")]
fn three_hundred_controls_take_little_more_time_than_thirty() {
    let frame_ms = |count: usize| {
        let mut window = World::with(many(count)).window(SIZE);
        window.run_steps(5);
        let frame = |window: &mut Window<'_>| {
            let start = std::time::Instant::now();
            window.step();
            1000.0 * start.elapsed().as_secs_f64()
        };
        let mut times: Vec<f64> = (0..60).map(|_| frame(&mut window)).collect();
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    };
    let (few, many) = (frame_ms(30), frame_ms(300));
    println!("a frame with 30 controls: {few:.2} ms, with 300: {many:.2} ms");
    assert!(many < 3.0 * few, "30 controls: {few:.2} ms, 300: {many:.2} ms");
}
