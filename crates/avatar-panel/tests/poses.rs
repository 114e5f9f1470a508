//! The list of poses.

mod support;

use avatar_panel::{Action, Edit, Message, Model, PoseForm, Severity, Tab};
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use pose_anim::{DEFAULT_POSES_TOML, PoseSet};
use support::{Window, World, click};

fn window<'a>(world: World) -> Window<'a> {
    let mut window = world.on(Tab::Poses).window([900.0, 700.0]);
    window.run_steps(3);
    window
}

fn write(window: &mut Window<'_>, field: &str, text: &str) {
    click(window, field);
    window.key_combination_modifiers(egui::Modifiers::COMMAND, &[Key::A]);
    window.run_steps(2);
    window.get_by_label(field).type_text(text);
    window.run_steps(3);
}

fn names(window: &Window<'_>) -> Vec<String> {
    window.state().poses.iter().map(|pose| pose.name.clone()).collect()
}

#[test]
fn a_click_goes_to_the_pose_and_it_is_marked() {
    let mut window = window(World::new());
    let marked = |window: &Window<'_>| {
        let nodes = window.get_all_by_role(Role::Button);
        let toggled =
            nodes.filter(|node| node.accesskit_node().toggled() == Some(egui::accesskit::Toggled::True));
        toggled.filter_map(|node| node.accesskit_node().label()).collect::<Vec<_>>()
    };
    assert_eq!(marked(&window), ["Poses tab"]);
    click(&mut window, "pose frown, key 2");
    assert_eq!(window.state().log, [Action::GoTo(2)]);
    assert_eq!(marked(&window), ["Poses tab", "pose frown, key 2"]);
}

#[test]
fn space_and_enter_go_to_the_focused_pose() {
    let mut window = window(World::new());
    for (label, key, index) in [("pose smile, key 1", Key::Space, 1), ("pose laugh, key 3", Key::Enter, 3)] {
        window.get_by_label(label).focus();
        window.run_steps(2);
        window.key_press(key);
        window.run_steps(2);
        assert_eq!(window.state().log.last(), Some(&Action::GoTo(index)));
    }
}

#[test]
fn the_present_face_is_saved_once_name_and_key_are_right() {
    let mut window = window(World::new());
    let disabled = |window: &Window<'_>| window.get_by_label("Save pose").accesskit_node().is_disabled();
    click(&mut window, "Save this face…");
    assert!(window.query_by_label("Give the pose a name.").is_some());
    assert!(disabled(&window));
    write(&mut window, "Name of the pose", "smile");
    assert!(window.query_by_label_contains("There is a pose \"smile\" already").is_some());
    assert!(disabled(&window));
    write(&mut window, "Name of the pose", " grin ");
    let cases = [
        ("2", "The key 2 calls \"frown\""),
        ("not a key", "\"not a key\" is no key"),
        ("F1", "The key F1 has a meaning of its own"),
    ];
    for (key, complaint) in cases {
        write(&mut window, "Key of the pose", key);
        assert!(window.query_by_label_contains(complaint).is_some(), "{key}");
        assert!(disabled(&window));
    }
    write(&mut window, "Key of the pose", "g");
    click(&mut window, "fixed");
    click(&mut window, "Save pose");
    let form = PoseForm { name: "grin".to_owned(), key: Some("g".to_owned()), duration_secs: Some(0.5) };
    assert_eq!(window.state().log, [Action::Edit(Edit::SavePose(form))]);
    assert!(window.query_by_label("Save pose").is_none());
    assert!(names(&window).ends_with(&["grin".to_owned()]));
}

#[test]
fn enter_saves_and_escape_cancels() {
    let mut window = window(World::new());
    click(&mut window, "Save this face…");
    // The name has the keyboard at once.
    window.get_by_label("Name of the pose").type_text("grin");
    window.run_steps(3);
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert!(
        matches!(window.state().log.last(), Some(Action::Edit(Edit::SavePose(form))) if form.name == "grin")
    );
    let before = window.state().log.len();
    click(&mut window, "Save this face…");
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert!(window.query_by_label("Save pose").is_none());
    assert_eq!(window.state().log.len(), before);
}

#[test]
fn a_pose_is_edited_under_its_own_name() {
    let mut window = window(World::new());
    click(&mut window, "pose smile, key 1");
    click(&mut window, "Edit… smile");
    // Its own name and key are no doubles.
    assert!(!window.get_by_label("Save pose").accesskit_node().is_disabled());
    write(&mut window, "Name of the pose", "beam");
    click(&mut window, "Save pose");
    let form = PoseForm { name: "beam".to_owned(), key: Some("1".to_owned()), duration_secs: None };
    assert_eq!(window.state().log.last(), Some(&Action::Edit(Edit::EditPose { index: 1, form })));
    assert!(window.query_by_label("pose beam, key 1").is_some());
}

#[test]
fn buttons_update_move_and_delete() {
    let mut window = window(World::new());
    click(&mut window, "pose smile, key 1");
    click(&mut window, "Update smile");
    assert_eq!(window.state().log.last(), Some(&Action::Edit(Edit::UpdatePose(1))));
    click(&mut window, "Move smile down");
    assert_eq!(window.state().log.last(), Some(&Action::Edit(Edit::MovePose { from: 1, to: 2 })));
    // The tools stay with the pose.
    click(&mut window, "Move smile up");
    click(&mut window, "Move smile up");
    assert_eq!(names(&window)[..3], ["smile", "neutral", "frown"]);
    assert!(window.get_by_label("Move smile up").accesskit_node().is_disabled());
    click(&mut window, "Delete smile");
    assert_eq!(window.state().log.last(), Some(&Action::Edit(Edit::DeletePose(0))));
    assert_eq!(names(&window)[..2], ["neutral", "frown"]);
}

#[test]
fn poses_are_dragged_to_another_place() {
    let mut window = window(World::new());
    let from = window.get_by_label("pose smile, key 1").rect().center();
    let to = window.get_by_label("pose anger, key 5").rect().center();
    window.hover_at(from);
    window.step();
    window.drag_at(from);
    window.step();
    for share in [0.2, 0.6, 1.0] {
        window.hover_at(from + share * (to - from));
        window.step();
    }
    window.drop_at(to);
    window.run_steps(3);
    assert_eq!(window.state().log, [Action::Edit(Edit::MovePose { from: 1, to: 5 })]);
    assert_eq!(names(&window)[4..6], ["anger", "smile"]);
}

#[test]
fn undo_and_redo_say_what_they_do() {
    let mut world = World::new();
    world.undo = Some("delete smile");
    let mut window = window(world);
    assert!(window.get_by_label("Redo").accesskit_node().is_disabled());
    click(&mut window, "Undo delete smile");
    window.state_mut().redo = Some("delete smile");
    window.run_steps(2);
    click(&mut window, "Redo delete smile");
    assert_eq!(window.state().log, [Action::Edit(Edit::Undo), Action::Edit(Edit::Redo)]);
}

#[test]
fn poses_that_cannot_be_changed_say_why() {
    let mut world = World::new();
    world.can_save = Err("The poses of this face are built in.");
    let mut window = window(world);
    assert!(window.query_by_label("The poses of this face are built in.").is_some());
    assert!(window.get_by_label("Save this face…").accesskit_node().is_disabled());
    click(&mut window, "pose smile, key 1");
    for tool in ["Update smile", "Edit… smile", "Delete smile", "Move smile down"] {
        assert!(window.get_by_label(tool).accesskit_node().is_disabled(), "{tool}");
    }
}

#[test]
fn pictures_make_a_grid() {
    let mut world = World::new();
    world.thumbnails = vec![Some(egui::TextureId::default()); 3];
    let window = window(world);
    let place = |label: &str| window.get_by_label(label).rect();
    let (first, second) = (place("pose neutral, key 0"), place("pose smile, key 1"));
    assert_eq!(first.top(), second.top());
    assert!(first.right() < second.left());
    assert!(first.height() > first.width());
}

/// What the form lets through can be read back from a file, and what it holds back cannot.
#[test]
fn keys_and_durations_are_right_where_the_file_takes_them() {
    let world = World::new();
    let model = Model::new(&world.controls, &world.poses);
    let durations = [None, Some(0.0005), Some(0.001), Some(0.5), Some(3600.0), Some(3601.0)];
    let mut right = 0;
    for key in ["g", "é", "?", "F5", "F12", "ab", "no key", "?!", "ää", "1", "q"] {
        for duration_secs in durations {
            let form = PoseForm { name: "new one".to_owned(), key: Some(key.to_owned()), duration_secs };
            let duration = duration_secs.map_or_else(String::new, |secs| format!("duration = {secs}"));
            let own =
                format!("{}\n[[pose]]\nname = \"new one\"\nkey = {key:?}\n{duration}\n", DEFAULT_POSES_TOML);
            let read = PoseSet::from_toml(&own, &world.controls);
            assert_eq!(form.check(&model, None).is_ok(), read.is_ok(), "{form:?}: {read:?}");
            right += usize::from(read.is_ok());
        }
    }
    // Six keys of eleven are free and well made, four durations of six within the range.
    assert_eq!(right, 24);
}

#[test]
fn a_message_does_not_take_the_keyboard_from_a_form() {
    let mut window = window(World::new());
    click(&mut window, "Save this face…");
    window.event(egui::Event::Text("mi".to_owned()));
    window.run_steps(2);
    window.state_mut().messages =
        vec![Message { severity: Severity::Error, title: "Something", text: "is wrong", dismissible: true }];
    window.run_steps(2);
    window.event(egui::Event::Text("ne".to_owned()));
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(2);
    let form = PoseForm { name: "mine".to_owned(), ..PoseForm::default() };
    assert_eq!(window.state().log, [Action::Edit(Edit::SavePose(form))]);
}
