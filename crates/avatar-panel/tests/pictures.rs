//! What it looks like.

mod support;

use avatar_panel::{FilmProgress, Loading, Message, Panel, PanelState, Severity, Stats, Tab, Theme};
use egui_kittest::{SnapshotOptions, kittest::Queryable as _};
use support::World;

const STATS: Stats<'static> = Stats {
    adapter: "Software rasteriser",
    triangles: 48_212,
    strands: 120_000,
    passes: &[("deform", 0.42), ("shadows", 1.31), ("skin", 3.8), ("hair", 6.25)],
    frame_ms: &[16.0, 17.0, 16.4, 16.9, 33.1, 18.0, 16.2, 16.8, 16.0, 16.1, 25.0, 17.0, 16.0, 15.8, 16.5],
};

fn world() -> World {
    let mut world = World::new().nodding();
    for (name, value) in [("head.turn", 22.0), ("smile", 0.6)] {
        let control = world.control(name);
        world.values[control] = value;
    }
    world.highlighted = vec![world.control("jaw.open"), world.control("jaw.jut")];
    world.stats = STATS;
    world.active_pose = Some(1);
    world.undo = Some("delete yawn");
    world
}

fn dressed(mut world: World, state: PanelState) -> World {
    world.panel = Panel::new(state);
    world
}

/// A few pixels may differ, as edges of glyphs do from processor to processor; the smallest dot has more.
fn compare(window: &mut support::Window<'_>, name: &str) {
    let options = SnapshotOptions::new().max_failed_pixels(12);
    assert_eq!(window.try_snapshot_options(name, &options).map_err(|error| error.to_string()), Ok(()));
}

#[test]
fn sliders_in_the_dark() {
    let state = PanelState { seen_hint: true, show_stats: true, ..PanelState::default() };
    let mut window = dressed(world(), state).window([560.0, 360.0]);
    window.run_steps(10);
    compare(&mut window, "sliders");
}

#[test]
fn a_clip_in_the_light() {
    let state = PanelState { tab: Tab::Clips, theme: Theme::Light, seen_hint: true, ..PanelState::default() };
    let mut window = dressed(world(), state).window([560.0, 360.0]);
    window.run_steps(10);
    window.get_by_label("key 2 of head.bow, 0.50 s, 10.00").click();
    window.run_steps(4);
    window.remove_cursor();
    window.run_steps(10);
    compare(&mut window, "clip");
}

/// Not compared: to be looked at, in the folder of build products.
#[test]
#[ignore = "writes pictures to look at"]
fn gallery() {
    let out = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("panel");
    std::fs::create_dir_all(&out).unwrap();
    let sizes = [("wide", [1100.0, 700.0]), ("narrow", [480.0, 360.0])];
    for (tab, tab_name) in Tab::ALL {
        for (theme, theme_name) in [(Theme::Dark, "dark"), (Theme::Light, "light")] {
            for text_scale in [1.0, 2.0] {
                for (size_name, size) in sizes {
                    let state =
                        PanelState { tab, theme, text_scale, show_stats: true, ..PanelState::default() };
                    let mut world = dressed(world(), state);
                    if theme == Theme::Light {
                        world.messages = vec![Message {
                            severity: Severity::Error,
                            title: "poses.toml was not read",
                            text: "poses.toml: line 12, column 9: expected a number from 0 to 20, found 45",
                            dismissible: true,
                        }];
                        world.loading = Some(Loading { what: "marsienne/Skin.png", fraction: Some(0.4) });
                        world.film = Some(FilmProgress { done: 31, of: 120, remaining_secs: Some(75) });
                    }
                    let mut window = world.window(size);
                    window.run_steps(6);
                    if tab == Tab::Clips
                        && let Some(key) = window.query_by_label("key 2 of head.bow, 0.50 s, 10.00")
                    {
                        key.click();
                        window.run_steps(3);
                    }
                    let name = format!("{tab_name}-{theme_name}-{text_scale}-{size_name}.png");
                    window.render().unwrap().save(out.join(name)).unwrap();
                }
            }
        }
    }
    let mut window = world().window([1100.0, 700.0]);
    window.key_press(egui::Key::F1);
    window.run_steps(6);
    window.render().unwrap().save(out.join("help.png")).unwrap();
    let mut grid = world().on(Tab::Poses);
    grid.thumbnails = vec![Some(egui::TextureId::default()); 9];
    let mut window = grid.window([700.0, 560.0]);
    window.run_steps(6);
    window.render().unwrap().save(out.join("grid.png")).unwrap();
    let mut window = world().on(Tab::Poses).window([700.0, 560.0]);
    window.run_steps(4);
    window.get_by_label("Save this face…").click();
    window.run_steps(4);
    window.render().unwrap().save(out.join("form.png")).unwrap();
}
