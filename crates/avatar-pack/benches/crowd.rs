//! 1,024 faces in motion, on one core, time per face (divan prints items per second: faces): the built-in
//! avatar with its couplings and nine joints, and a face whose shapes stand behind sliders.
#![allow(clippy::expect_used, clippy::disallowed_methods, reason = "a bench: it may panic and read files")]

use avatar_mesh::drivers::{Input, Rule, ShapeDrivers, ShapeRule};
use avatar_pack::{Expressions, FaceCrowd, FaceState, MemorySource, Pack, Sliders};
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use pose_anim::{Control, ControlTable, Drive, Pace, Player, PlayerCrowd, Pose};
use std::path::Path;

fn main() {
    divan::main();
}

const FACES: usize = 1024;
const DT_SECS: f64 = 1.0 / 240.0;

/// The built-in avatar without its textures.
fn built_in() -> Pack {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne");
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(folder).expect("the built-in avatar") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        if !name.ends_with(".png") {
            source.files.insert(name, std::fs::read(path).expect("a file"));
        }
    }
    let pack = Pack::load(&source).expect("a good pack");
    assert!(!pack.controls().couplings().is_empty() && pack.rig().len() == 9, "not the face that is meant");
    pack
}

/// Its shapes behind two sliders: one is an in-between of the other's way, one a product.
fn behind_sliders() -> Pack {
    let mut contents = built_in().into_contents();
    let names = ["slide", "slide.more"].map(str::to_owned);
    let input = |name: &str| Input::Driver(name.to_owned());
    let rules = [
        ShapeRule {
            shape: contents.shapes[0].clone(),
            rule: Rule::Follows { input: input(&names[0]), full_weight: 0.5 },
        },
        ShapeRule {
            shape: contents.shapes[1].clone(),
            rule: Rule::Product(names.iter().map(|name| input(name)).collect()),
        },
    ];
    let drivers = ShapeDrivers::new(&names, &contents.shapes, &rules).expect("rules");
    let old = std::mem::take(&mut contents.controls);
    let is_of_joint = |control: &&Control| matches!(control.drives, Drive::Joint { .. });
    let mut controls: Vec<Control> = old.controls().iter().filter(is_of_joint).cloned().collect();
    controls.extend(names.iter().map(|name| Control {
        name: name.clone(),
        drives: Drive::Shape { shape: name.clone() },
        min: 0.0,
        max: 1.0,
        default: 0.0,
        pace: Pace::SHAPE,
        group: None,
    }));
    let couplings = old.couplings().to_vec();
    contents.controls = ControlTable::with_couplings(controls, couplings).expect("controls");
    contents.poses = pose_anim::PoseSet::default();
    contents.sliders = Some(Sliders {
        names: names.into(),
        of_shapes: vec![vec![0], vec![0, 1]],
        drivers,
        expressions: Expressions::default(),
        of_controls: Vec::new(),
        mixing: Vec::new(),
    });
    Pack::new(contents).expect("a pack")
}

/// A pose of all controls, another one for each face; the move takes an hour.
fn slow(pack: &Pack, face: usize) -> Pose {
    let share = |control: usize| ((face * 31 + control * 17) % 97) as f32 / 97.0;
    let controls = pack.controls().controls().iter().enumerate();
    let values: Vec<_> = controls.map(|(i, c)| c.min + share(i) * (c.max - c.min)).collect();
    Pose::from_values("all", &values).lasting(3600.0)
}

fn players(pack: &Pack) -> PlayerCrowd {
    let mut players = PlayerCrowd::new(pack.controls(), FACES);
    (0..FACES).for_each(|face| players.press(face, &slow(pack, face)).expect("a face"));
    // Half of the way: couplings and joints have something to do.
    players.advance(1800.0).expect("time");
    players
}

fn crowd(bencher: Bencher<'_, '_>, pack: &Pack) {
    let (mut players, mut faces) = (players(pack), FaceCrowd::new(pack, FACES));
    bencher.counter(ItemsCount::new(FACES)).bench_local(|| {
        players.advance(black_box(DT_SECS)).expect("time");
        faces.pose(pack, &players).expect("faces");
        black_box(&mut faces);
    });
}

fn one_by_one(bencher: Bencher<'_, '_>, pack: &Pack) {
    let mut faces: Vec<_> = (0..FACES)
        .map(|face| {
            let mut player = Player::new(pack.controls());
            player.press(&slow(pack, face));
            player.advance(1800.0).expect("time");
            (player, FaceState::new(pack))
        })
        .collect();
    bencher.counter(ItemsCount::new(FACES)).bench_local(|| {
        for (player, state) in black_box(&mut faces) {
            player.advance(black_box(DT_SECS)).expect("time");
            state.pose(pack, player.values()).expect("a face");
        }
    });
}

#[divan::bench]
fn built_in_crowd(bencher: Bencher<'_, '_>) {
    crowd(bencher, &built_in());
}

#[divan::bench]
fn built_in_one_by_one(bencher: Bencher<'_, '_>) {
    one_by_one(bencher, &built_in());
}

#[divan::bench]
fn sliders_crowd(bencher: Bencher<'_, '_>) {
    crowd(bencher, &behind_sliders());
}

#[divan::bench]
fn sliders_one_by_one(bencher: Bencher<'_, '_>) {
    one_by_one(bencher, &behind_sliders());
}

/// Of the built-in face in the crowd, the players alone.
#[divan::bench]
fn players_alone(bencher: Bencher<'_, '_>) {
    let mut players = players(&built_in());
    bencher.counter(ItemsCount::new(FACES)).bench_local(|| {
        players.advance(black_box(DT_SECS)).expect("time");
        black_box(&mut players);
    });
}

/// Of the built-in face in the crowd, couplings, local transforms, weights and bones alone.
#[divan::bench]
fn faces_alone(bencher: Bencher<'_, '_>) {
    let pack = built_in();
    let (players, mut faces) = (players(&pack), FaceCrowd::new(&pack, FACES));
    bencher.counter(ItemsCount::new(FACES)).bench_local(|| {
        faces.pose(&pack, black_box(&players)).expect("faces");
        black_box(&mut faces);
    });
}
