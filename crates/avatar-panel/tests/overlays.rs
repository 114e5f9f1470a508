//! Help, messages, statistics, folding, display, and the keyboard's way through everything.

mod support;

use avatar_panel::{Action, FilmProgress, Loading, Message, Panel, PanelState, Severity, Stats, Tab, Theme};
use egui::accesskit::Role;
use egui::{Event, Key};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use std::collections::BTreeSet;
use support::{Window, World, click};

fn window<'a>(world: World) -> Window<'a> {
    let mut window = world.window([900.0, 700.0]);
    window.run_steps(4);
    window
}

const ERROR: Message<'static> = Message {
    severity: Severity::Error,
    title: "poses.toml was not read",
    text: "poses.toml: line 12, column 9: expected a number from 0 to 20, found 45",
    dismissible: true,
};

#[test]
fn the_help_holds_all_keys_with_their_meanings() {
    let mut window = window(World::new());
    assert!(window.query_by_label("Keys").is_none());
    window.key_press(Key::F1);
    window.run_steps(4);
    for row in window.state().keys.clone() {
        assert!(window.query_by_label(row.key).is_some(), "{}", row.key);
        assert!(window.query_by_label(row.meaning).is_some(), "{}", row.meaning);
        assert_eq!(window.query_all_by_label(row.group).count(), 1, "{}", row.group);
    }
}

#[test]
fn the_help_opens_and_closes_by_its_keys_and_buttons() {
    let mut window = window(World::new());
    let open = |window: &Window<'_>| window.query_by_label("Close help").is_some();
    let question = Event::Text("?".to_owned());
    for close in [Key::F1, Key::Escape, Key::Questionmark] {
        window.key_press(Key::F1);
        window.run_steps(4);
        assert!(open(&window));
        window.key_press(close);
        window.run_steps(4);
        assert!(!open(&window), "{close:?}");
    }
    window.event(question.clone());
    window.run_steps(4);
    assert!(open(&window));
    click(&mut window, "Close help");
    assert!(!open(&window));
    click(&mut window, "Help");
    assert!(open(&window));
    window.key_press(Key::Escape);
    window.run_steps(4);
    // A question mark in a text is a question mark.
    click(&mut window, "Search controls");
    window.event(question);
    window.run_steps(4);
    assert!(!open(&window));
    assert_eq!(window.get_by_label("Search controls").value().as_deref(), Some("?"));
}

#[test]
fn a_message_is_shown_takes_room_and_is_dismissed() {
    let mut window = window(World::new());
    let free = window.state().free;
    window.state_mut().messages =
        vec![ERROR, Message { dismissible: false, title: "no GPU", text: "", ..ERROR }];
    window.run_steps(4);
    assert!(window.query_by_label("Error: poses.toml was not read").is_some());
    assert!(window.query_by_label(ERROR.text).is_some());
    assert!(window.query_by_label("Error: no GPU").is_some());
    assert!(window.query_by_label("Dismiss: no GPU").is_none());
    assert!(window.state().free.top() > free.top() + 30.0);
    click(&mut window, "Dismiss: poses.toml was not read");
    assert_eq!(window.state().log, [Action::Dismiss(0)]);
    window.state_mut().messages.clear();
    window.run_steps(4);
    assert_eq!(window.state().free, free);
}

#[test]
fn loading_and_filming_tell_how_far_they_are() {
    let mut world = World::new();
    world.loading = Some(Loading { what: "Skin.png", fraction: Some(0.25) });
    world.film = Some(FilmProgress { done: 30, of: 120, remaining_secs: Some(75) });
    let mut window = window(world);
    let bars: Vec<_> = window
        .get_all_by_role(Role::ProgressIndicator)
        .map(|bar| (bar.accesskit_node().label().unwrap(), bar.accesskit_node().numeric_value()))
        .collect();
    assert_eq!(bars.len(), 2, "{bars:?}");
    assert!(bars[0].0.contains("Skin.png") && bars[0].0.contains("25"), "{bars:?}");
    assert!(bars[1].0.contains("30 of 120, 1:15 min left"), "{bars:?}");
    click(&mut window, "Stop the film");
    assert_eq!(window.state().log, [Action::StopFilm]);
}

#[test]
fn statistics_are_shown_when_they_are_wanted() {
    let mut world = World::new().on(Tab::View);
    world.stats = Stats {
        adapter: "Some GPU",
        triangles: 48_212,
        strands: 7,
        passes: &[("shadows", 1.25)],
        frame_ms: &[10.0, 20.0, 30.0],
    };
    let mut window = window(world);
    assert!(window.query_by_label("Some GPU").is_none());
    click(&mut window, "Statistics");
    for text in [
        "Some GPU",
        "48\u{2009}212",
        "shadows",
        "1.25 ms",
        "30.0 ms",
        "20.0 ms, 50/s",
        "Times of the last 3 frames",
    ] {
        assert!(window.query_by_label(text).is_some(), "{text}");
    }
    assert_eq!(window.state().log, [Action::Remember]);
    assert!(window.state().panel.state().show_stats);
}

#[test]
fn folding_gives_the_room_to_the_face() {
    let mut window = window(World::new());
    let free = window.state().free;
    assert!(free.width() < 700.0);
    click(&mut window, "Fold the panel");
    assert_eq!(window.state().free, window.ctx.content_rect());
    assert!(window.query_by_label("head.turn, degrees").is_none());
    click(&mut window, "Open the panel");
    assert_eq!(window.state().free, free);
    assert_eq!(window.state().log, [Action::Remember, Action::Remember]);
}

#[test]
fn the_panel_leaves_room_in_a_narrow_window_and_keeps_its_width_for_wider_ones() {
    let mut window = World::new().window([480.0, 360.0]);
    window.run_steps(4);
    assert!(window.state().free.width() >= 180.0, "{}", window.state().free);
    assert_eq!(window.state().panel.state().width, PanelState::default().width);
}

#[test]
fn theme_and_text_size_take_effect_and_are_told() {
    let mut window = window(World::new().on(Tab::View));
    assert!(window.ctx.global_style().visuals.dark_mode);
    click(&mut window, "Theme Light");
    assert!(!window.ctx.global_style().visuals.dark_mode);
    let slider = window.get_by_role_and_label(Role::Slider, "Text size");
    slider.set_value_accesskit(1.5);
    window.run_steps(4);
    assert_eq!(window.ctx.zoom_factor(), 1.5);
    let told = [Action::Theme(Theme::Light), Action::Remember, Action::TextScale(1.5), Action::Remember];
    assert_eq!(window.state().log, told);
}

#[test]
fn the_panel_is_widened_at_its_edge() {
    let mut window = window(World::new());
    let edge = window.state().free.right_center();
    window.hover_at(edge);
    window.step();
    window.drag_at(edge);
    window.step();
    for way in [20.0, 60.0] {
        window.hover_at(edge - egui::vec2(way, 0.0));
        window.step();
    }
    window.drop_at(edge - egui::vec2(60.0, 0.0));
    window.run_steps(4);
    let width = window.state().panel.state().width;
    assert!((width - PanelState::default().width - 60.0).abs() < 4.0, "{width}");
    assert!((window.state().free.right() - (900.0 - width)).abs() < 1.5, "{}", window.state().free);
    assert!(window.state().log.contains(&Action::Remember));
}

#[test]
fn the_scale_follows_the_keys_that_zoom() {
    let mut window = window(World::new());
    window.key_press_modifiers(egui::Modifiers::COMMAND, Key::Plus);
    window.run_steps(4);
    let scale = window.state().panel.state().text_scale;
    assert!(scale > 1.0);
    assert_eq!(window.ctx.zoom_factor(), scale);
    assert_eq!(window.state().log, [Action::Remember]);
}

#[test]
fn keys_are_the_panels_only_where_it_needs_them() {
    let mut window = window(World::new());
    let takes = |window: &Window<'_>| {
        let panel = &window.state().panel;
        [Key::Num1, Key::Space, Key::Tab, Key::F1].map(|key| panel.takes_key(&window.ctx, key))
    };
    assert_eq!(takes(&window), [false, false, true, true]);
    window.get_by_label("head.turn, degrees").focus();
    window.run_steps(2);
    assert_eq!(takes(&window), [false, true, true, true]);
    click(&mut window, "Search controls");
    assert_eq!(takes(&window), [true; 4]);
    window.key_press(Key::Escape);
    window.run_steps(2);
    assert_eq!(takes(&window), [false, false, true, true]);
    // A click leaves the keyboard where it is: keys go on calling poses.
    click(&mut window, "Poses tab");
    assert_eq!(takes(&window), [false, false, true, true]);
    window.key_press(Key::F1);
    window.run_steps(2);
    assert_eq!(takes(&window), [true; 4]);
}

#[test]
fn the_hint_goes_for_good() {
    let mut world = World::new();
    world.panel = Panel::new(PanelState::default());
    let mut window = window(world);
    click(&mut window, "Got it");
    assert!(window.query_by_label("Got it").is_none());
    let state = window.state().panel.state();
    assert!(state.seen_hint);
    let text = serde_json::to_string(&state).unwrap();
    assert_eq!(serde_json::from_str::<PanelState>(&text).unwrap(), state);
    // Files of other versions have more or less in them.
    assert_eq!(serde_json::from_str::<PanelState>("{}").unwrap(), PanelState::default());
}

#[test]
fn what_is_remembered_is_brought_within_its_ranges() {
    let state = PanelState { width: f32::NAN, text_scale: 40.0, ..PanelState::default() };
    let sound = Panel::new(state).state();
    assert_eq!((sound.width, sound.text_scale), (PanelState::default().width, 2.0));
}

#[test]
fn the_view_asks_for_files_pictures_films_and_cameras() {
    let mut window = window(World::new().on(Tab::View));
    for label in ["Open…", "Save picture", "Film: PNG frames", "Camera left", "Full screen", "Quit"] {
        click(&mut window, label);
    }
    let film = Action::Film { format: 0, clip: None };
    let expected =
        [Action::OpenFile, Action::Picture, film, Action::Camera(1), Action::FullScreen, Action::Quit];
    assert_eq!(window.state().log, expected);
}

/// Tab goes round all that can be clicked or dragged, on every tab, and each of them has a name.
#[test]
fn the_keyboard_reaches_everything_and_everything_has_a_name() {
    for (tab, name) in Tab::ALL {
        let mut world = World::new().nodding().on(tab);
        world.messages = vec![ERROR];
        world.active_pose = Some(1);
        world.undo = Some("delete yawn");
        world.values.fill(0.25);
        let mut window = world.window([1000.0, 900.0]);
        window.run_steps(4);
        let roles = [
            Role::Button,
            Role::Slider,
            Role::CheckBox,
            Role::TextInput,
            Role::SpinButton,
            Role::ComboBox,
            Role::DisclosureTriangle,
        ];
        let nodes = window.root().children_recursive().map(|node| node.accesskit_node());
        let active = nodes.filter(|node| roles.contains(&node.role()) && !node.is_disabled());
        let widgets: Vec<_> = active.map(|node| node.label().unwrap_or_default()).collect();
        assert!(widgets.len() > 5, "{name}: {widgets:?}");
        assert!(widgets.iter().all(|label| !label.is_empty()), "{name}: {widgets:?}");
        let mut reached = BTreeSet::new();
        for _ in 0..2 * widgets.len() + 10 {
            window.key_press(Key::Tab);
            window.run_steps(2);
            let focused = window.root().children_recursive().find(|node| node.is_focused());
            reached.extend(focused.and_then(|node| node.accesskit_node().label()));
        }
        let missed: Vec<_> = widgets.iter().filter(|label| !reached.contains(*label)).collect();
        assert!(missed.is_empty(), "{name}: {missed:?}");
    }
}
