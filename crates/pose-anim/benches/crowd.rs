//! Time per face and tick of many faces: players in motion, couplings and local transforms, bone matrices;
//! together as a crowd and one by one (divan prints items per second: faces).
#![allow(clippy::unwrap_used, reason = "a bench may panic")]

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::Mat4;
use lanes::Lanes;
use pose_anim::{Binding, ControlTable, Player, PlayerCrowd, Pose};
use rig_core::{RawJoint, RawRig, Rig, RigCrowd};

fn main() {
    divan::main();
}

const FACES: usize = 1024;
const DT_SECS: f64 = 1.0 / 240.0;

fn rig() -> Rig {
    let names = [
        "LtUpperLidJoint",
        "RtUpperLidJoint",
        "LtLowerLidJoint",
        "RtLowerLidJoint",
        "JawJoint",
        "LtEyeJoint",
        "RtEyeJoint",
    ];
    let bind = |i: usize| Mat4::from_translation(glam::Vec3::new(0.1, 1.0, i as f32 * 0.1));
    let mut raw = RawRig::default();
    raw.joints.push(RawJoint::new("NeckJoint", None, bind(0)));
    raw.joints.push(RawJoint::new("HeadJoint", Some("NeckJoint"), bind(1)));
    raw.joints.extend(
        names.iter().enumerate().map(|(i, name)| RawJoint::new(*name, Some("HeadJoint"), bind(i + 2))),
    );
    Rig::from_raw(&raw).unwrap()
}

/// A pose of all controls, other for each face; the move takes an hour.
fn slow(table: &ControlTable, face: usize) -> Pose {
    let share = |control: usize| ((face * 31 + control * 17) % 97) as f32 / 97.0;
    let values: Vec<_> = table.controls().iter().enumerate().map(|(i, c)| share(i) * c.max).collect();
    Pose::from_values("all", &values).lasting(3600.0)
}

fn players(table: &ControlTable) -> PlayerCrowd {
    let mut players = PlayerCrowd::new(table, FACES);
    (0..FACES).for_each(|face| players.press(face, &slow(table, face)).unwrap());
    players.advance(DT_SECS).unwrap();
    players
}

struct Crowd {
    players: PlayerCrowd,
    binding: Binding,
    effective: Vec<Lanes>,
    weights: Vec<Lanes>,
    rigs: RigCrowd,
}

fn crowd() -> Crowd {
    let table = ControlTable::default_face();
    let (rig, players) = (rig(), players(&table));
    let rigs = RigCrowd::new(&rig, FACES);
    Crowd {
        effective: players.values().to_vec(),
        weights: vec![Lanes::splat(0.0); 2 * rigs.blocks()],
        binding: table.bind(&rig, &["SSmile", "Frown"]).unwrap(),
        players,
        rigs,
    }
}

#[divan::bench]
fn crowd_players(bencher: Bencher<'_, '_>) {
    let mut players = players(&ControlTable::default_face());
    bencher
        .counter(ItemsCount::new(FACES))
        .bench_local(|| black_box(&mut players).advance(black_box(DT_SECS)));
}

#[divan::bench]
fn crowd_couplings(bencher: Bencher<'_, '_>) {
    let mut crowd = crowd();
    bencher.counter(ItemsCount::new(FACES)).bench_local(|| {
        let Crowd { players, binding, effective, .. } = black_box(&mut crowd);
        binding.couple_crowd(players.values(), effective);
    });
}

#[divan::bench]
fn crowd_local_transforms(bencher: Bencher<'_, '_>) {
    let mut crowd = crowd();
    bencher.counter(ItemsCount::new(FACES)).bench_local(|| {
        let Crowd { binding, effective, weights, rigs, .. } = black_box(&mut crowd);
        binding.apply_crowd(effective, rigs, weights)
    });
}

#[divan::bench]
fn crowd_bones(bencher: Bencher<'_, '_>) {
    let mut crowd = crowd();
    bencher.counter(ItemsCount::new(FACES)).bench_local(|| black_box(&mut crowd).rigs.update());
}

/// All of it.
#[divan::bench]
fn crowd_faces(bencher: Bencher<'_, '_>) {
    let mut crowd = crowd();
    bencher.counter(ItemsCount::new(FACES)).bench_local(|| {
        let Crowd { players, binding, effective, weights, rigs } = black_box(&mut crowd);
        players.advance(black_box(DT_SECS)).unwrap();
        binding.couple_crowd(players.values(), effective);
        binding.apply_crowd(effective, rigs, weights).unwrap();
        rigs.update();
    });
}

/// The same by players, locals and poses of one face each.
#[divan::bench]
fn faces_one_by_one(bencher: Bencher<'_, '_>) {
    let table = ControlTable::default_face();
    let rig = rig();
    let binding = table.bind(&rig, &["SSmile", "Frown"]).unwrap();
    let mut faces: Vec<_> = (0..FACES)
        .map(|face| {
            let mut player = Player::new(&table);
            player.press(&slow(&table, face));
            (player, table.defaults(), rig.locals(), [0.0; 2], rig.pose())
        })
        .collect();
    bencher.counter(ItemsCount::new(FACES)).bench_local(|| {
        for (player, effective, locals, weights, pose) in black_box(&mut faces) {
            player.advance(black_box(DT_SECS)).unwrap();
            binding.couple(player.values(), effective);
            binding.apply(effective, locals, weights).unwrap();
            rig.update(locals.as_slice(), pose).unwrap();
        }
    });
}
