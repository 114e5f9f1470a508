//! A frame of the panel: laying it out and cutting it into triangles, for faces of more and more controls.
#![allow(clippy::expect_used, reason = "a bench may panic")]

use avatar_panel::{Model, Panel, PanelState, Tab};
use divan::Bencher;
use egui::{Context, RawInput, Rect, Vec2};
use pose_anim::{Control, ControlTable, Drive, Pace, PoseSet};

fn main() {
    divan::main();
}

fn shapes(count: usize) -> ControlTable {
    let controls = (0..count).map(|index| {
        let name = format!("shape{index}");
        let drives = Drive::Shape { shape: name.clone() };
        Control {
            pace: Pace::named(&name, &drives),
            name,
            drives,
            min: 0.0,
            max: 1.0,
            default: 0.0,
            group: None,
        }
    });
    ControlTable::new(controls.collect()).expect("a good table")
}

/// Shows the panel of 1280 × 720 points while the first of its controls moves; the number of triangles at the
/// end.
fn frames(bencher: Bencher, controls: &ControlTable, state: PanelState) {
    let poses = PoseSet::default_face(controls);
    let mut values = controls.defaults();
    let mut panel = Panel::new(state);
    let ctx = Context::default();
    let mut actions = Vec::new();
    let mut time = 0.0;
    bencher.bench_local(|| {
        time += 1.0 / 60.0;
        values[0] = (time as f32).sin().abs();
        let model = Model { values: &values, ..Model::new(controls, &poses) };
        let screen_rect = Some(Rect::from_min_size(egui::Pos2::ZERO, Vec2::new(1280.0, 720.0)));
        let input = RawInput { screen_rect, time: Some(time), ..RawInput::default() };
        let mut output = ctx.run_ui(input, |ui| _ = panel.show(ui, &model, &mut actions));
        output.textures_delta.clear();
        actions.clear();
        ctx.tessellate(output.shapes, output.pixels_per_point).len()
    });
}

fn open(tab: Tab) -> PanelState {
    PanelState { seen_hint: true, tab, ..PanelState::default() }
}

#[divan::bench]
fn folded_away(bencher: Bencher) {
    frames(bencher, &ControlTable::default_face(), PanelState { folded: true, ..open(Tab::Face) });
}

#[divan::bench]
fn sliders_of_the_nine_joint_face(bencher: Bencher) {
    frames(bencher, &ControlTable::default_face(), open(Tab::Face));
}

#[divan::bench(args = [52, 300, 1000])]
fn sliders_of_shapes(bencher: Bencher, count: usize) {
    frames(bencher, &shapes(count), open(Tab::Face));
}

#[divan::bench]
fn poses(bencher: Bencher) {
    frames(bencher, &ControlTable::default_face(), open(Tab::Poses));
}

#[divan::bench]
fn clips(bencher: Bencher) {
    frames(bencher, &ControlTable::default_face(), open(Tab::Clips));
}

#[divan::bench]
fn view(bencher: Bencher) {
    frames(bencher, &ControlTable::default_face(), open(Tab::View));
}
