//! What springs cost a frame, and what an avatar without springs pays for them: nothing that can be measured.
#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a bench: it may panic and read files"
)]

use avatar_pack::{FaceState, MemorySource, Pack};
use divan::{Bencher, black_box};
use glam::{Affine3A, Mat4, Vec3};
use rig_core::{RawJoint, RawRig};
use std::fmt::Write;
use std::path::Path;

const CHAINS: usize = 10;
const JOINTS: usize = 4;

fn main() {
    divan::main();
}

/// The built-in avatar without its textures, with ten chains of four joints on its head; they swing or not.
fn pack(swings: bool) -> Pack {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne");
    let mut source = MemorySource::default();
    for entry in std::fs::read_dir(folder).expect("the built-in avatar") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        if !name.ends_with(".png") {
            source.files.insert(name, std::fs::read(path).expect("a file"));
        }
    }
    let mut rig = RawRig::from_xml(&source.files["Transformations.xml"]).expect("a good rig");
    let mut springs =
        String::from("[[collider]]\nname = \"c\"\njoint = \"HeadJoint\"\nsphere = { radius = 2 }\n");
    for chain in 0..CHAINS {
        let mut above = "HeadJoint".to_owned();
        let mut names = Vec::new();
        for joint in 0..=JOINTS {
            let name = format!("chain {chain} {joint}");
            let place = Mat4::from_translation(Vec3::new(0.1 * chain as f32, -1.0, 0.0));
            rig.joints.push(RawJoint::new(&name, Some(above.as_str()), place));
            names.push(format!("{name:?}"));
            above = name;
        }
        let names = names.join(", ");
        writeln!(springs, "[[chain]]\njoints = [{names}]\nstiffness = 1\ncolliders = [\"c\"]").unwrap();
    }
    source.files.insert("Transformations.xml".to_owned(), rig.to_xml().expect("a rig").into_bytes());
    if swings {
        source.files.insert("springs.toml".to_owned(), springs.into_bytes());
    }
    Pack::load(&source).expect("a good pack")
}

/// A frame of a turning head: the pose, and what swings after it.
fn frame(bencher: Bencher<'_, '_>, swings: bool, follow: impl Fn(&mut FaceState, &Pack)) {
    let pack = pack(swings);
    let head = pack.rig().joint("HeadJoint").expect("a head");
    let (mut state, values) = (FaceState::new(&pack), pack.controls().defaults());
    let mut angle = 0.0f32;
    bencher.bench_local(|| {
        angle += 0.05;
        let turn = Affine3A::from_rotation_y(angle.sin());
        state.pose_with(&pack, black_box(&values), |_| {}, &[(head, turn)]).expect("a pose");
        follow(&mut state, &pack);
        black_box(state.bones()).len()
    });
}

#[divan::bench]
fn pose_alone(bencher: Bencher<'_, '_>) {
    frame(bencher, false, |_, _| {});
}

#[divan::bench]
fn without_springs(bencher: Bencher<'_, '_>) {
    frame(bencher, false, |state, pack| state.swing(pack, 1.0 / 60.0).expect("a pose"));
}

#[divan::bench]
fn forty_joints_swing(bencher: Bencher<'_, '_>) {
    frame(bencher, true, |state, pack| state.swing(pack, 1.0 / 60.0).expect("a pose"));
}

#[divan::bench]
fn forty_joints_settle(bencher: Bencher<'_, '_>) {
    frame(bencher, true, |state, pack| state.settle(pack).expect("a pose"));
}
