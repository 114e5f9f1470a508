//! Mixtures as morph targets, for programs that know no mixtures.

use super::ExportTarget;
use crate::{FaceState, Pack};
use avatar_mesh::{Offsets, Shape};
use glam::{DMat3, DVec3, Mat3};
use pose_anim::Drive;
use std::collections::BTreeSet;

/// What all targets may take together: a mixture takes a few bytes in a file, and may move every vertex.
pub(super) const MOST_BYTES: usize = 128 << 20;

/// The targets of all parts, and what of the mixtures they do not represent.
#[derive(Debug, Default)]
pub(super) struct Baked {
    /// For each part the targets of those mixtures that move it.
    pub(super) of_parts: Vec<Vec<Shape>>,
    /// Names of the mixtures for which `MOST_BYTES` had no room.
    pub(super) left_out: Vec<String>,
}

/// One target of its name for each mixture and part that it moves: the way of every vertex from the face with
/// the mixture at 0 to the face with it at 1, all other controls at their defaults. So bones, shapes,
/// couplings and correctives are all in it, and at weight 1 a target shows what the mixture does, to
/// rounding. On the way there vertices go straight, where bones turn them.
pub(super) fn baked(pack: &Pack, most_bytes: usize) -> Baked {
    let mut baked = Baked::new(pack);
    let Some(sliders) = pack.sliders() else { return baked };
    let mixtures: BTreeSet<usize> = sliders.mixing.iter().map(|one| one.from).collect();
    let mut left = most_bytes;
    for control in mixtures {
        let Some(Drive::Shape { shape: name }) = pack.controls().controls().get(control).map(|c| &c.drives)
        else {
            continue;
        };
        if let Some([from, to]) = ends(pack, control) {
            baked.add(pack, name, [&from, &to], &mut left);
        }
    }
    baked
}

/// One target for each of these, and part that it moves: from the face at rest to the one of its values.
/// Targets whose values do not fit the pack are left out by name.
pub(super) fn asked(pack: &Pack, targets: &[ExportTarget], most_bytes: usize) -> Baked {
    let mut baked = Baked::new(pack);
    let mut left = most_bytes;
    let rest = FaceState::new(pack);
    let mut to = FaceState::new(pack);
    for target in targets {
        match to.pose(pack, &target.values) {
            Ok(()) => baked.add(pack, &target.name, [&rest, &to], &mut left),
            Err(_) => baked.left_out.push(target.name.clone()),
        }
    }
    baked
}

impl Baked {
    fn new(pack: &Pack) -> Self {
        Self { of_parts: vec![Vec::new(); pack.parts().len()], left_out: Vec::new() }
    }

    /// Adds the target from one face to another, if `left` has room for it.
    fn add(&mut self, pack: &Pack, name: &str, [from, to]: [&FaceState; 2], left: &mut usize) {
        let moved: Vec<Option<Shape>> =
            (0..pack.parts().len()).map(|part| target(pack, part, name, from, to)).collect();
        let bytes = moved.iter().flatten().map(Shape::memory_bytes).sum();
        match left.checked_sub(bytes) {
            _ if bytes == 0 => {}
            None => self.left_out.push(name.to_owned()),
            Some(rest) => {
                *left = rest;
                for (targets, shape) in self.of_parts.iter_mut().zip(moved) {
                    targets.extend(shape);
                }
            }
        }
    }
}

/// The face with a mixture at 0 and at 1.
fn ends(pack: &Pack, control: usize) -> Option<[FaceState; 2]> {
    let posed = |value: f32| {
        let mut values = pack.controls().defaults();
        *values.get_mut(control)? = value;
        let mut state = FaceState::new(pack);
        state.pose(pack, &values).ok()?;
        Some(state)
    };
    Some([posed(0.0)?, posed(1.0)?])
}

/// The target of a part, if any vertex or normal of it moves.
fn target(pack: &Pack, part: usize, name: &str, from: &FaceState, to: &FaceState) -> Option<Shape> {
    let (before, after) = (from.deform(pack, part).ok()?, to.deform(pack, part).ok()?);
    let mesh = &pack.parts().get(part)?.mesh;
    // The file's nodes are at bind pose, and move what a target has added.
    let bind = FaceState::new(pack);
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    for vertex in 0..mesh.positions.len() {
        let way = after.positions[vertex].as_dvec3() - before.positions[vertex].as_dvec3();
        if way == DVec3::ZERO && after.normals[vertex] == before.normals[vertex] {
            continue;
        }
        let world_from_mesh = turn(pack, part, vertex, &bind);
        let number = u32::try_from(vertex).ok()?;
        positions.push((number, (inverse(&world_from_mesh) * way).as_vec3()));
        // From the normal of the mesh, so that the sum has the direction of the moved one.
        let normal = mesh.normals[vertex].as_dvec3();
        let moved = world_from_mesh.transpose() * after.normals[vertex].as_dvec3();
        normals.push((number, (moved.normalize_or(normal) - normal).as_vec3()));
    }
    if positions.is_empty() {
        return None;
    }
    let shape = Shape::from_pairs(name, mesh.positions.len(), positions).ok()?;
    Some(shape.with_normals(Offsets::from_pairs(mesh.positions.len(), normals).ok()?))
}

/// What bones do to directions at a vertex.
fn turn(pack: &Pack, part: usize, vertex: usize, state: &FaceState) -> DMat3 {
    let of_bone = |bone: usize| {
        let bone = state.bones().get(bone).copied().unwrap_or_default();
        Mat3::from(bone.matrix3).as_dmat3()
    };
    let part = pack.parts().get(part);
    match part.and_then(|part| Some((part.bone, part.mesh.skinning.as_ref()?))) {
        Some((None, skinning)) => skinning
            .influences(vertex)
            .fold(DMat3::ZERO, |sum, (bone, weight)| sum + f64::from(weight) * of_bone(bone.into())),
        _ => of_bone(part.and_then(|part| part.bone).unwrap_or(0)),
    }
}

/// The inverse, or nothing at all where a matrix makes everything flat.
fn inverse(matrix: &DMat3) -> DMat3 {
    let inverse = matrix.inverse();
    if matrix.determinant() != 0.0 && inverse.is_finite() { inverse } else { DMat3::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MemorySource;

    #[test]
    #[allow(clippy::disallowed_methods, reason = "a test: it may read files")]
    fn what_has_no_room_is_left_out_by_name() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/marsienne");
        let mut source = MemorySource::default();
        for entry in std::fs::read_dir(folder).expect("the built-in face") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
            source.files.insert(name, std::fs::read(&path).expect("a file"));
        }
        let pack = Pack::load(&source).expect("a pack");
        let bytes = |baked: &Baked| baked.of_parts.iter().flatten().map(Shape::memory_bytes).sum::<usize>();
        let all = baked(&pack, MOST_BYTES);
        assert!(all.left_out.is_empty() && bytes(&all) > 1 << 20, "{}", bytes(&all));
        let half = bytes(&all) / 2;
        let some = baked(&pack, half);
        assert!(!some.left_out.is_empty() && bytes(&some) > 0 && bytes(&some) <= half);
        let names: BTreeSet<&String> = some.of_parts.iter().flatten().map(|shape| &shape.name).collect();
        assert!(some.left_out.iter().all(|name| !names.contains(name)));
        let none = baked(&pack, 0);
        let mixtures = &pack.further_shapes().expect("shapes").mixtures;
        assert!(none.left_out.iter().eq(mixtures.iter().map(|mixture| &mixture.name)), "{:?}", none.left_out);
    }
}
