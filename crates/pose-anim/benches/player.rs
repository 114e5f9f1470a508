//! Time per player and tick, beside a plain lerp of as many values.

use divan::{Bencher, black_box};
use pose_anim::{ControlTable, Player, Pose, PoseSet};

fn main() {
    divan::main();
}

const DT_SECS: f64 = 1.0 / 240.0;

/// A player that moves for the next hour.
fn moving(table: &ControlTable, name: &str) -> Player {
    let mut player = Player::new(table);
    let poses = PoseSet::default_face(table);
    if let Some(pose) = poses.get(name) {
        player.press(&pose.clone().lasting(3600.0));
    }
    player
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
    let mut player = Player::new(&ControlTable::default_face());
    bencher.bench_local(|| black_box(&mut player).advance(black_box(DT_SECS)));
}

#[divan::bench]
fn player_moving(bencher: Bencher<'_, '_>) {
    // Every pose that moves all 15 controls does.
    let table = ControlTable::default_face();
    let mut player = moving(&table, "neutral");
    let everywhere: Vec<_> = table.controls().iter().map(|control| 0.5 * control.max).collect();
    player.press(&Pose::from_values("all", &everywhere).lasting(3600.0));
    bencher.bench_local(|| black_box(&mut player).advance(black_box(DT_SECS)));
}

#[divan::bench(args = [10, 100, 1_000, 10_000])]
fn players_in_one_slice(bencher: Bencher<'_, '_>, count: usize) {
    let mut players = vec![moving(&ControlTable::default_face(), "laugh"); count];
    bencher
        .counter(divan::counter::ItemsCount::new(count))
        .bench_local(|| Player::advance_all(black_box(&mut players), black_box(DT_SECS)));
}
