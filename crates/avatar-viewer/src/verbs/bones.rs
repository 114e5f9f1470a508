use crate::cli::BonesArgs;
use crate::ending;
use crate::output::{Contents, OutputFile};
use anyhow::Result;
use avatar_pack::FaceState;
use clap::ArgMatches;
use glam::Affine3A;
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
struct Report<'a> {
    joints: Vec<Joint<'a>>,
    weights: BTreeMap<&'a str, f32>,
}

#[derive(Serialize)]
struct Joint<'a> {
    name: &'a str,
    parent: Option<&'a str>,
    world_bind: [f32; 16],
    world: [f32; 16],
    skin: [f32; 16],
}

pub(super) fn run(args: &BonesArgs, matches: &ArgMatches) -> Result<()> {
    ending::format(&args.out, None, &[("json", ())], "")?;
    let out = OutputFile::check(&args.out, Contents::Text)?;
    let pack = super::open(&args.pack)?.load_pack()?;
    let mut state = FaceState::new(&pack);
    args.face.resolve(&pack, matches)?.apply(&pack, &mut state)?;

    let rig = pack.rig();
    let joints = rig.joints().map(|joint| Joint {
        name: &rig.names()[joint.index()],
        parent: rig.parents()[joint.index()].map(|parent| rig.names()[parent.index()].as_str()),
        world_bind: row_by_row(rig.world_from_bind()[joint.index()]),
        world: row_by_row(state.rig_pose().world_from_joint()[joint.index()]),
        skin: row_by_row(state.rig_pose().posed_from_bind()[joint.index()]),
    });
    let weights = pack.shapes().iter().map(|shape| public_name(shape)).zip(state.weights().iter().copied());
    let report = Report { joints: joints.collect(), weights: weights.collect() };
    out.write(format!("{}\n", serde_json::to_string_pretty(&report)?).as_bytes())
}

/// The raw format's shapes under the names of their controls.
fn public_name(shape: &str) -> &str {
    match shape {
        "SSmile" => "smile",
        "Frown" => "frown",
        other => other,
    }
}

fn row_by_row(matrix: Affine3A) -> [f32; 16] {
    glam::Mat4::from(matrix).transpose().to_cols_array()
}
