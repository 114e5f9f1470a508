//! Models that no program should make, and windows that nobody can use.

mod support;

use avatar_panel::{Action, FilmProgress, Loading, Panel, PanelState, Playback, Stats, Tab};
use egui::Key;
use pose_anim::{Clip, ControlTable, PoseSet, Track};
use support::World;

fn every_tab(mut world: impl FnMut() -> World, size: [f32; 2]) -> Vec<Action> {
    let mut log = Vec::new();
    for (tab, _) in Tab::ALL {
        for folded in [false, true] {
            let mut world = world();
            world.panel = Panel::new(PanelState { tab, folded, show_stats: true, ..PanelState::default() });
            let mut window = world.window(size);
            window.run_steps(4);
            for _ in 0..25 {
                window.key_press(Key::Tab);
                window.step();
            }
            window.key_press(Key::F1);
            window.run_steps(3);
            log.append(&mut window.state_mut().log);
        }
    }
    log
}

#[test]
fn indices_beyond_everything_and_numbers_that_are_none() {
    let odd = || {
        let mut world = World::new().nodding();
        world.values = vec![f32::NAN, f32::INFINITY, -1e30];
        world.highlighted = vec![0, 7, usize::MAX];
        world.active_pose = Some(usize::MAX);
        world.thumbnails = vec![None; 100];
        let keys = [(0.0, 0.0), (1e6, 1e12)];
        let of = |control| Track::from_samples(control, keys).unwrap();
        world.clips.push(Clip::new("", vec![of(3), of(900)]).unwrap());
        world.playback = Playback {
            clip: Some(5),
            time_secs: f64::NAN,
            playing: true,
            recording_secs: Some(f64::INFINITY),
            frame_rate: 0.0,
        };
        world.loading = Some(Loading { what: "", fraction: Some(f32::NAN) });
        world.film = Some(FilmProgress { done: 5, of: 0, remaining_secs: Some(u64::MAX) });
        world.stats = Stats {
            adapter: "",
            triangles: u64::MAX,
            strands: 0,
            passes: &[("", f32::NAN)],
            frame_ms: &[f32::NAN, -1.0, f32::INFINITY, 1e30],
        };
        world
    };
    let changes = every_tab(odd, [900.0, 700.0]);
    let harmless = |action: &Action| matches!(action, Action::Hover(_) | Action::Remember);
    // The keyboard only walks by, so nothing is to change.
    assert!(changes.iter().all(harmless), "{changes:?}");
}

#[test]
fn nothing_to_show() {
    let empty = || {
        let mut world = World::with(ControlTable::default());
        world.poses = PoseSet::default();
        world.keys.clear();
        world
    };
    assert!(every_tab(empty, [900.0, 700.0]).iter().all(|action| *action == Action::Remember));
}

#[test]
fn windows_without_room() {
    for size in [[1.0, 1.0], [60.0, 900.0], [900.0, 20.0], [200.0, 150.0]] {
        every_tab(|| World::new().nodding(), size);
    }
}
