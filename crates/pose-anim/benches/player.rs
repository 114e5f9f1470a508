//! Time per player and tick, beside a plain lerp of as many values.

use divan::{Bencher, black_box};
use pose_anim::{Clip, ControlTable, Easing, Key, LayerMode, Layers, Player, Pose, Track, Wrap};
use std::sync::Arc;

fn main() {
    divan::main();
}

const DT_SECS: f64 = 1.0 / 240.0;

/// A pose of all controls, at a share of their way up; the move takes an hour.
fn slow(table: &ControlTable, share: f32) -> Pose {
    let values: Vec<_> = table.controls().iter().map(|control| share * control.max).collect();
    Pose::from_values("all", &values).lasting(3600.0)
}

/// A player all of whose controls move for the next hour.
fn moving(table: &ControlTable) -> Player {
    let mut player = Player::new(table);
    player.press(&slow(table, 0.5));
    player
}

/// A clip for all controls, smooth and without end.
fn clip(table: &ControlTable) -> Arc<Clip> {
    let tracks = table.controls().iter().enumerate().filter_map(|(index, control)| {
        let key = |time: f64, share: f32| Key::new(time, f64::from(share * control.max), Easing::MinimumJerk);
        Track::new(index, vec![key(0.0, 0.1), key(0.7, 0.9), key(1.3, 0.3), key(2.0, 0.1)]).ok()
    });
    Arc::new(Clip::new("clip", tracks.collect()).unwrap_or_default().wrapped(Wrap::Loop))
}

fn bench(bencher: Bencher<'_, '_>, mut player: Player) {
    bencher.bench_local(|| black_box(&mut player).advance(black_box(DT_SECS)));
}

/// The floor: a lerp of the same 15 values.
#[divan::bench]
fn lerp_15_values(bencher: Bencher<'_, '_>) {
    let (from, to) = (vec![0.25f32; 15], vec![0.75f32; 15]);
    let mut out = vec![0.0f32; 15];
    bencher.bench_local(|| {
        let s = black_box(0.3f32);
        for ((out, from), to) in out.iter_mut().zip(black_box(&from)).zip(black_box(&to)) {
            *out = from + s * (to - from);
        }
        black_box(&out);
    });
}

#[divan::bench]
fn player_at_rest(bencher: Bencher<'_, '_>) {
    bench(bencher, Player::new(&ControlTable::default_face()));
}

#[divan::bench]
fn player_moving(bencher: Bencher<'_, '_>) {
    bench(bencher, moving(&ControlTable::default_face()));
}

/// The most that a control can have to do: every press asks for a slow move out of a fast one, which would
/// leave the range.
#[divan::bench]
fn player_in_four_nested_fades(bencher: Bencher<'_, '_>) {
    let table = ControlTable::default_face();
    let mut player = Player::new(&table);
    player.press(&slow(&table, 1.0).lasting(3.0));
    let mut runs = player.advance(1.5).is_ok();
    for share in [0.9, 0.8, 0.95, 0.85] {
        player.press(&slow(&table, share));
        runs &= player.advance(0.01).is_ok();
    }
    assert!(runs);
    bench(bencher, player);
}

#[divan::bench]
fn player_along_a_transition(bencher: Bencher<'_, '_>) {
    let table = ControlTable::default_face();
    let mut player = Player::new(&table);
    let easing = Easing::from_name("ease-in-out").unwrap_or(Easing::Linear);
    player.press(&slow(&table, 0.5).along(easing));
    bench(bencher, player);
}

#[divan::bench]
fn player_with_a_clip(bencher: Bencher<'_, '_>) {
    let table = ControlTable::default_face();
    let mut player = Player::new(&table);
    player.play(&clip(&table), Some(0.1));
    assert!(player.advance(0.2).is_ok());
    bench(bencher, player);
}

/// A base and three layers, all of whose controls and weights move.
#[divan::bench]
fn three_layers(bencher: Bencher<'_, '_>) {
    let table = ControlTable::default_face();
    let mut layers = Layers::new(&table);
    layers.base().press(&slow(&table, 0.5));
    for mode in [LayerMode::Additive, LayerMode::Override, LayerMode::Additive] {
        let layer = layers.add(&table, mode, &vec![0.5; table.len()]);
        layers.fade_to(layer, 1.0, 3600.0);
        if let Some(player) = layers.layer(layer) {
            player.press(&slow(&table, 0.3));
        }
    }
    bencher.bench_local(|| black_box(&mut layers).advance(black_box(DT_SECS)));
}

#[divan::bench(args = [10, 100, 1_000, 10_000])]
fn players_in_one_slice(bencher: Bencher<'_, '_>, count: usize) {
    let mut players = vec![moving(&ControlTable::default_face()); count];
    bencher
        .counter(divan::counter::ItemsCount::new(count))
        .bench_local(|| Player::advance_all(black_box(&mut players), black_box(DT_SECS)));
}
