use crate::cli::InfoArgs;
use crate::output;
use anyhow::Result;
use avatar_pack::{Pack, Textures};
use serde::Serialize;
use std::fmt::Write;

#[derive(Serialize)]
struct Report<'a> {
    parts: Vec<PartReport<'a>>,
    joints: Vec<String>,
    controls: Vec<ControlReport>,
    poses: Vec<PoseReport>,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct PartReport<'a> {
    name: &'a str,
    vertices: usize,
    triangles: usize,
    bytes: usize,
    min: [f32; 3],
    max: [f32; 3],
}

#[derive(Serialize)]
struct ControlReport {
    name: String,
    min: f32,
    max: f32,
    default: f32,
}

#[derive(Serialize)]
struct PoseReport {
    name: String,
    key: Option<String>,
}

pub(super) fn run(args: &InfoArgs) -> Result<()> {
    let files = super::open(&args.pack)?;
    // Not `load_pack`: warnings are part of the report here, and not told twice.
    let pack = Pack::load(&files)?;
    let textures = Textures::load(&files);
    let report = report(&pack, &textures);
    if args.json {
        return output::print(&format!("{}\n", serde_json::to_string_pretty(&report)?));
    }
    output::print(&text(&report))
}

fn report<'a>(pack: &'a Pack, textures: &Textures) -> Report<'a> {
    let parts = pack.parts.iter().map(|part| {
        let bounds = part.bounds;
        PartReport {
            name: &part.name,
            vertices: part.mesh.positions.len(),
            triangles: part.mesh.triangles.len(),
            bytes: part.bytes,
            min: bounds.map_or([0.0; 3], |bounds| bounds.min.to_array()),
            max: bounds.map_or([0.0; 3], |bounds| bounds.max.to_array()),
        }
    });
    let controls = pack.controls.controls().iter().map(|control| ControlReport {
        name: control.name.clone(),
        min: control.min,
        max: control.max,
        default: control.default,
    });
    let poses = pack.poses.iter().map(|pose| PoseReport { name: pose.name.clone(), key: pose.key.clone() });
    let warnings = pack.warnings.iter().chain(&textures.warnings);
    Report {
        parts: parts.collect(),
        joints: pack.rig.names().to_vec(),
        controls: controls.collect(),
        poses: poses.collect(),
        warnings: warnings.map(ToString::to_string).collect(),
    }
}

fn text(report: &Report<'_>) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "part            vertices  triangles      bytes  bounds");
    for part in &report.parts {
        let ([x0, y0, z0], [x1, y1, z1]) = (part.min, part.max);
        let _ = writeln!(
            out,
            "{:<15} {:>8} {:>10} {:>10}  {x0:.3} {y0:.3} {z0:.3} … {x1:.3} {y1:.3} {z1:.3}",
            part.name, part.vertices, part.triangles, part.bytes
        );
    }
    let _ = writeln!(out, "\njoints: {}", report.joints.join(", "));
    let _ = writeln!(out, "\ncontrol             min     max  default");
    for control in &report.controls {
        let (min, max, default) = (control.min, control.max, control.default);
        let _ = writeln!(out, "{:<16} {min:>6} {max:>7} {default:>8}", control.name);
    }
    let _ = writeln!(out, "\npose            key");
    for pose in &report.poses {
        let _ = writeln!(out, "{:<15} {}", pose.name, pose.key.as_deref().unwrap_or("-"));
    }
    for warning in &report.warnings {
        let _ = writeln!(out, "\nwarning: {warning}");
    }
    out
}
