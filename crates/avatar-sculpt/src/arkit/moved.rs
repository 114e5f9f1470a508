//! From fields to offsets of vertices.

use glam::{DVec2, DVec3};

use super::{
    CORRECTIVES, FIELDS, FURTHER, Field, Kind, Spot, Weight, clear,
    evened::Corners,
    jaw, lid_arc, opened,
    whole::{LEAST, LEAST_TURN, Whole, drop_traces},
};
use crate::{
    math::smooth,
    mesh::{self, Part},
    parts::teeth,
    sculpture::Sculpture,
    skin::Skin,
};

/// The stem of the skin's files.
pub(super) const SKIN: &str = "MarsienneSkin";

/// What one shape does to one part: offsets of its vertices, and changes of their normals.
#[derive(Clone, Debug)]
pub struct Moved {
    /// Name of the shape.
    pub name: String,
    /// Stem of the part's files.
    pub stem: &'static str,
    /// Where its weight comes from.
    pub weight: Weight,
    /// Offset of every vertex.
    pub offsets: Vec<DVec3>,
    /// Change of every normal.
    pub normals: Vec<DVec3>,
}

/// All shapes, in the order of their names; a shape that moves several parts has an entry for each.
#[must_use]
pub fn moved(sculpture: &Sculpture) -> Vec<Moved> {
    let skin = &sculpture.skin;
    let whole = Whole::new(skin);
    let mut all = Vec::new();
    let (corners, canthi) = (Corners::of_mouth(&whole, skin), Corners::of_eyes(&whole, skin));
    let (still, jaw_open) = (vec![jaw::opened(0.0); skin.vertices.len()], jaw::bones(skin));
    let lids_closed = lid_arc::SIDES.map(|(_, _, side)| lid_arc::bones(skin, side, 1.0));
    let mut parted = corners.turned(&whole, skin, &jaw_open);
    drop_traces(&mut parted, LEAST);
    let mut parted_normals = whole.changes(skin, &parted, &jaw_open);
    drop_traces(&mut parted_normals, LEAST_TURN);
    let (open_mouth, open_mouth_normals) = {
        let mut offsets = offsets(skin, Kind::Both(opened::face), 1.0);
        corners.offsets(&whole, &mut offsets);
        offsets.iter_mut().zip(&parted).for_each(|(d, corner)| *d += *corner);
        drop_traces(&mut offsets, LEAST);
        let mut normals = whole.changes(skin, &offsets, &jaw_open);
        drop_traces(&mut normals, LEAST_TURN);
        (offsets, normals)
    };
    let fields = FIELDS.into_iter().map(|(name, kind)| (name, kind, Weight::Control));
    for (name, kind, weight) in fields.chain(CORRECTIVES) {
        let sides: &[(&str, f64)] = match kind {
            Kind::Both(_) | Kind::WithJaw(_) | Kind::OpenJaw(_) => &[("", 1.0)],
            Kind::Sided(..) | Kind::Across(_) => &[("Left", 1.0), ("Right", -1.0)],
        };
        for (side, (suffix, own)) in sides.iter().enumerate() {
            let mut offsets = offsets(skin, kind, *own);
            // Lips that the jaw has parted close exactly.
            if !matches!(kind, Kind::OpenJaw(_)) {
                corners.offsets(&whole, &mut offsets);
            }
            let bones = match weight {
                Weight::Control | Weight::Follows(..) => &still,
                Weight::OfSide(_, [of_lid, _]) if of_lid.starts_with("lid.") => &lids_closed[side],
                Weight::Product(_) | Weight::OfSide(..) => &jaw_open,
            };
            let mut normals = whole.changes(skin, &offsets, bones);
            if matches!(kind, Kind::OpenJaw(_)) {
                // Closed lips need no evened corners: what the jaw brings along is taken away again.
                offsets.iter_mut().zip(&parted).for_each(|(d, corner)| *d -= *corner);
                normals.iter_mut().zip(&parted_normals).for_each(|(n, corner)| *n -= *corner);
            }
            drop_traces(&mut offsets, LEAST);
            drop_traces(&mut normals, LEAST_TURN);
            let weight = weight.of_side(side);
            all.push(Moved { name: format!("{name}{suffix}"), stem: SKIN, weight, offsets, normals });
        }
    }
    for (name, at) in lid_arc::SHARES {
        for (suffix, control, side) in lid_arc::SIDES {
            let bones = lid_arc::bones(skin, side, at);
            let mut offsets = canthi.closed(&whole, skin, &bones, &lid_arc::offsets(skin, side, at, &bones));
            let mut normals = whole.changes(skin, &offsets, &bones);
            drop_traces(&mut offsets, LEAST);
            drop_traces(&mut normals, LEAST_TURN);
            let (name, weight) = (format!("{name}{suffix}"), Weight::Follows(control, at));
            all.push(Moved { name, stem: SKIN, weight, offsets, normals });
        }
    }
    all.push(Moved {
        name: "openMouth".to_owned(),
        stem: SKIN,
        weight: Weight::Follows("jaw.open", 1.0),
        offsets: open_mouth,
        normals: open_mouth_normals,
    });
    for (name, side) in [("jawCornersLeft", 1.0), ("jawCornersRight", -1.0)] {
        let bones = jaw::bones_aside(skin, side);
        let mut offsets = corners.turned(&whole, skin, &bones);
        drop_traces(&mut offsets, LEAST);
        let mut normals = whole.changes(skin, &offsets, &bones);
        drop_traces(&mut normals, LEAST_TURN);
        let weight = Weight::Follows("jaw.jut", side);
        all.push(Moved { name: name.to_owned(), stem: SKIN, weight, offsets, normals });
    }
    for (stem, part) in sculpture.parts.iter().filter(|(stem, _)| *stem == "LowerJaw") {
        let moved = |tongue: fn(DVec3) -> DVec3, teeth: DVec3| -> Vec<DVec3> {
            let of = |(p, uv): (&DVec3, &DVec2)| if teeth::is_tongue(*uv) { tongue(*p) } else { teeth };
            part.positions.iter().zip(&part.uvs).map(of).collect()
        };
        let [back_up, tip_up] = FURTHER;
        for (name, offsets) in [
            ("jawForward", moved(|_| jaw::FORWARD, jaw::FORWARD)),
            ("tongueOut", moved(jaw::tongue_out, jaw::TONGUE_DROP)),
            (back_up, moved(jaw::tongue_back_up, DVec3::ZERO)),
            (tip_up, moved(jaw::tongue_tip_up, DVec3::ZERO)),
        ] {
            let normals = part_changes(part, &offsets);
            all.push(Moved { name: name.to_owned(), stem, weight: Weight::Control, offsets, normals });
        }
    }
    // Shapes of their own first; the skin comes before the rigid parts.
    all.sort_by_key(|m| (m.weight != Weight::Control, m.name.clone(), m.stem != SKIN));
    all
}

/// Offsets of all vertices of the skin; `own` is 1 where the shape's own side is the left one, −1 for right.
fn offsets(skin: &Skin, kind: Kind, own: f64) -> Vec<DVec3> {
    let on = |field: Field, i: usize, half: f64| {
        let spot = Spot { node: skin.half.mover(i), side: own * half };
        clear::of_teeth(&spot, clear::of_eye(&spot, field(&spot)))
    };
    skin.vertices
        .iter()
        .map(|v| {
            let half = if v.p.x < 0.0 { -1.0 } else { 1.0 };
            // On the midline both halves must agree: a mirrored field has no way across it.
            let on_midline = |d: DVec3| if v.p.x == 0.0 { DVec3::new(0.0, d.y, d.z) } else { d };
            let d = match kind {
                Kind::Both(field) | Kind::WithJaw(field) | Kind::OpenJaw(field) => {
                    on_midline(on(field, v.source, half))
                }
                Kind::Sided(field, width) => {
                    // A pull sideways is one direction on both sides, as far as it reaches across.
                    let d = on(field, v.source, half);
                    DVec3::new(d.x * own * half, d.y, d.z) * smooth(-width, width, own * v.p.x)
                }
                Kind::Across(field) => on(field, v.source, half),
            };
            DVec3::new(d.x * half, d.y, d.z)
        })
        .collect()
}

/// How the normals of a rigid part change under offsets; its vertices share normals where they share a place.
fn part_changes(part: &Part, offsets: &[DVec3]) -> Vec<DVec3> {
    let welded = mesh::weld(&part.positions);
    let triangles: Vec<[usize; 3]> = part.triangles.iter().map(|t| t.map(|i| welded[i as usize])).collect();
    let moved: Vec<DVec3> = part.positions.iter().zip(offsets).map(|(p, d)| *p + *d).collect();
    let turned = mesh::normals(&moved, &triangles);
    let mut changes: Vec<DVec3> =
        part.normals.iter().enumerate().map(|(i, n)| turned[welded[i]] - *n).collect();
    drop_traces(&mut changes, LEAST_TURN);
    changes
}
