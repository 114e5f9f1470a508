use crate::cli::InfoArgs;
use crate::standard;
use anyhow::Result;
use avatar_pack::{ImportReport, Level, Pack, Texture, Textures};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

#[derive(Serialize)]
struct Report<'a> {
    parts: Vec<PartReport<'a>>,
    joints: Vec<String>,
    /// What moves by itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    springs: Option<SpringsReport>,
    /// Shapes beside the two of the raw format.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    further_shapes: Vec<String>,
    controls: Vec<ControlReport>,
    /// Axes that make other people of the face.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    identity: Vec<AxisReport>,
    poses: Vec<PoseReport>,
    clips: Vec<ClipReport>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    levels: Vec<LevelReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    import: Option<ImportedReport>,
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
    #[serde(skip_serializing_if = "Option::is_none")]
    group: Option<String>,
}

/// Joints that swing and joints that turn with others.
#[derive(Serialize)]
struct SpringsReport {
    swinging: Vec<String>,
    colliders: usize,
    turning: Vec<String>,
}

fn springs(pack: &Pack) -> Option<SpringsReport> {
    let springs = pack.springs();
    let name = |joint: usize| pack.rig().names().get(joint).cloned();
    (!springs.is_empty()).then(|| SpringsReport {
        swinging: springs.springs.iter().filter_map(|spring| name(spring.joint)).collect(),
        colliders: springs.colliders.len(),
        turning: springs.constraints.iter().filter_map(|constraint| name(constraint.joint)).collect(),
    })
}

/// An axis of the identity, from -1 to 1, and what the face is called at both ends.
#[derive(Serialize)]
struct AxisReport {
    name: String,
    less: String,
    more: String,
}

#[derive(Serialize)]
struct PoseReport {
    name: String,
    key: Option<String>,
}

#[derive(Serialize)]
struct ClipReport {
    name: String,
    seconds: f32,
}

/// A level of detail.
#[derive(Serialize)]
struct LevelReport {
    level: usize,
    /// Height of the avatar in the picture up to which it is made; the whole avatar has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pixels: Option<f32>,
    vertices: usize,
    triangles: usize,
    error: f32,
}

fn levels(pack: &Pack) -> Vec<LevelReport> {
    let made = Level::all(pack, pack.hair().is_some());
    let of_levels = made.iter().map(|level| (&level.pack, level.error));
    let all = std::iter::once((pack, 0.0)).chain(of_levels).enumerate();
    all.map(|(level, (pack, error))| LevelReport {
        level,
        pixels: level.checked_sub(1).and_then(|place| Level::HEIGHTS.get(place).copied()),
        vertices: pack.parts().iter().map(|part| part.mesh.positions.len()).sum(),
        triangles: pack.parts().iter().map(|part| part.mesh.triangles.len()).sum(),
        error,
    })
    .collect()
}

/// What was recognised in a file of an interchange format.
#[derive(Serialize)]
struct ImportedReport {
    /// Name, authors, licence and terms of use.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    about: BTreeMap<String, String>,
    joints: BTreeMap<String, String>,
    shape_sets: BTreeMap<String, usize>,
    shapes_by_own_name: Vec<String>,
    shapes_by_node: Vec<String>,
    joints_by_own_name: Vec<String>,
}

fn import(report: &ImportReport) -> ImportedReport {
    let named = report.joints.iter().map(|(role, joint)| (role.to_string(), joint.clone()));
    ImportedReport {
        about: report.about.iter().cloned().collect(),
        joints: named.collect(),
        shape_sets: report.shape_sets.iter().map(|(set, count)| (set.to_string(), *count)).collect(),
        shapes_by_own_name: report.other_shapes.clone(),
        shapes_by_node: report.apart.clone(),
        joints_by_own_name: report.other_joints.clone(),
    }
}

pub(super) fn run(args: &InfoArgs) -> Result<()> {
    let files = super::open(&args.pack)?;
    // Not `load_pack`: warnings are part of the report here, and not told twice.
    let pack = files.read_pack()?;
    let textures = files.read_textures(&Texture::ALL);
    let import = files.report().map(import);
    let levels = if args.levels { levels(&pack) } else { Vec::new() };
    let report = Report { import, levels, ..report(&pack, &textures) };
    if args.json {
        return standard::print(&format!("{}\n", serde_json::to_string_pretty(&report)?));
    }
    standard::print(&text(&report))
}

fn report<'a>(pack: &'a Pack, textures: &Textures) -> Report<'a> {
    let parts = pack.parts().iter().map(|part| {
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
    let controls = pack.controls().controls().iter().map(|control| ControlReport {
        name: control.name.clone(),
        min: control.min,
        max: control.max,
        default: control.default,
        group: control.group.clone(),
    });
    let axes = pack.identity().into_iter().flat_map(|identity| &identity.axes).map(|axis| AxisReport {
        name: axis.name.clone(),
        less: axis.less.clone(),
        more: axis.more.clone(),
    });
    let poses = pack.poses().iter().map(|pose| PoseReport { name: pose.name.clone(), key: pose.key.clone() });
    let clips = pack.motion().into_iter().flat_map(|motion| {
        let clip =
            |name: String| ClipReport { seconds: motion.duration_secs(&name).unwrap_or(0.0) as f32, name };
        motion.clips().into_iter().map(clip)
    });
    let of_controls = pack.clips().clips.iter();
    let of_controls =
        of_controls.map(|clip| ClipReport { seconds: clip.duration_secs() as f32, name: clip.name.clone() });
    let further = pack.further_shapes().into_iter().flat_map(|list| &list.shapes);
    let warnings = pack.warnings().iter().chain(&textures.warnings);
    Report {
        parts: parts.collect(),
        joints: pack.rig().names().to_vec(),
        springs: springs(pack),
        further_shapes: further.map(|shape| shape.name.clone()).collect(),
        controls: controls.collect(),
        identity: axes.collect(),
        poses: poses.collect(),
        clips: clips.chain(of_controls).collect(),
        levels: Vec::new(),
        import: None,
        warnings: warnings.map(ToString::to_string).collect(),
    }
}

/// How wide a column of names is: as the longest of them, within reason.
fn width<'a>(head: &str, names: impl Iterator<Item = &'a str>) -> usize {
    const USUAL: usize = 15;
    const MOST: usize = 40;
    names.map(|name| name.chars().count()).chain([head.len(), USUAL]).max().unwrap_or(USUAL).min(MOST)
}

fn text(report: &Report<'_>) -> String {
    let mut out = String::new();
    let wide = width("part", report.parts.iter().map(|part| part.name));
    let _ = writeln!(out, "{:<wide$} vertices  triangles      bytes  bounds", "part");
    for part in &report.parts {
        let ([x0, y0, z0], [x1, y1, z1]) = (part.min, part.max);
        let _ = writeln!(
            out,
            "{:<wide$} {:>8} {:>10} {:>10}  {x0:.3} {y0:.3} {z0:.3} … {x1:.3} {y1:.3} {z1:.3}",
            part.name, part.vertices, part.triangles, part.bytes
        );
    }
    let _ = writeln!(out, "\njoints: {}", report.joints.join(", "));
    if let Some(SpringsReport { swinging, colliders, turning }) = &report.springs {
        if !swinging.is_empty() {
            let _ = writeln!(out, "\njoints that swing, with {colliders} colliders: {}", swinging.join(", "));
        }
        if !turning.is_empty() {
            let _ = writeln!(out, "\njoints that turn with others: {}", turning.join(", "));
        }
    }
    if !report.further_shapes.is_empty() {
        let _ = writeln!(out, "\nfurther shapes: {}", report.further_shapes.join(", "));
    }
    let wide = width("control", report.controls.iter().map(|control| control.name.as_str()));
    let _ = writeln!(out, "\n{:<wide$}     min     max  default", "control");
    for control in &report.controls {
        let (min, max, default) = (control.min, control.max, control.default);
        let group = control.group.as_ref().map(|group| format!("  {group}")).unwrap_or_default();
        let _ = writeln!(out, "{:<wide$} {min:>7} {max:>7} {default:>8}{group}", control.name);
    }
    if !report.identity.is_empty() {
        let wide = width("identity", report.identity.iter().map(|axis| axis.name.as_str()));
        let _ = writeln!(out, "\n{:<wide$} -1 … 1", "identity");
        for axis in &report.identity {
            let _ = writeln!(out, "{:<wide$} {} … {}", axis.name, axis.less, axis.more);
        }
    }
    let wide = width("pose", report.poses.iter().map(|pose| pose.name.as_str()));
    let _ = writeln!(out, "\n{:<wide$} key", "pose");
    for pose in &report.poses {
        let _ = writeln!(out, "{:<wide$} {}", pose.name, pose.key.as_deref().unwrap_or("-"));
    }
    let wide = width("clip", report.clips.iter().map(|clip| clip.name.as_str()));
    if !report.clips.is_empty() {
        let _ = writeln!(out, "\n{:<wide$} seconds", "clip");
    }
    for clip in &report.clips {
        let _ = writeln!(out, "{:<wide$} {:.3}", clip.name, clip.seconds);
    }
    if report.levels.is_empty() {
        let heights = Level::HEIGHTS.map(|pixels| pixels.to_string()).join(", ");
        let _ = writeln!(
            out,
            "\nlevels of detail up to {heights} pixels of height (--levels makes and lists them)"
        );
    } else {
        let _ = writeln!(out, "\n{:<15} vertices  triangles      error", "level, up to px");
    }
    for LevelReport { level, pixels, vertices, triangles, error } in &report.levels {
        let name = pixels.map_or_else(|| level.to_string(), |pixels| format!("{level}, {pixels}"));
        let _ = writeln!(out, "{name:<15} {vertices:>8} {triangles:>10} {error:>10.4}");
    }
    if let Some(import) = &report.import {
        out.push('\n');
        for (what, text) in &import.about {
            let _ = writeln!(out, "{what}: {text}");
        }
        for (role, joint) in &import.joints {
            let _ = writeln!(out, "joint {joint:?} is the {role}");
        }
        for (set, count) in &import.shape_sets {
            let _ = writeln!(out, "{count} shapes of {set}");
        }
        for (what, names) in [
            ("shapes under their own names", &import.shapes_by_own_name),
            ("shapes of one name that differ between nodes", &import.shapes_by_node),
            ("joints under their own names", &import.joints_by_own_name),
        ] {
            if !names.is_empty() {
                let _ = writeln!(out, "{what}: {}", names.join(", "));
            }
        }
    }
    for warning in &report.warnings {
        let _ = writeln!(out, "\nwarning: {warning}");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::width;

    #[test]
    fn columns_are_as_wide_as_their_names_within_reason() {
        assert_eq!(width("pose", ["smile"].into_iter()), 15);
        assert_eq!(width("control", ["smile", "expression.relaxed"].into_iter()), 18);
        assert_eq!(width("part", ["x".repeat(500).as_str()].into_iter()), 40);
    }
}
