use super::joints::Bones;
use super::merge::Merged;
use super::shapes::{Place, Places};
use crate::{Pack, Part};
use avatar_mesh::{FACE_BONES, FACE_PARTS, Follows, Mesh, PartKind, Shape};
use glam::{Vec2, Vec3};

/// An avatar's parts as those of the format, in the order of [`FACE_PARTS`].
pub(super) struct Parts {
    pub(super) meshes: Vec<Mesh>,
    /// The part of the pack whose looks each has.
    pub(super) looks: Vec<Option<usize>>,
    /// Of each part the further shapes, all in their order; those that move nothing of it, too.
    pub(super) further: Vec<Vec<Shape>>,
}

impl Parts {
    pub(super) fn of(pack: &Pack, bones: &Bones, shapes: &Places<'_>, notes: &mut Vec<String>) -> Self {
        let filled = || pack.parts().iter().enumerate().filter(|(_, part)| !part.mesh.positions.is_empty());
        let places: Vec<(usize, usize)> =
            filled().map(|(index, part)| (index, place_of(pack, part, bones, shapes))).collect();
        let (mut meshes, mut looks, mut further) = (Vec::new(), Vec::new(), Vec::new());
        for (place, spec) in FACE_PARTS.iter().enumerate() {
            let members: Vec<usize> =
                places.iter().filter(|(_, other)| *other == place).map(|(index, _)| *index).collect();
            let score = |index: &&usize| {
                let part = &pack.parts()[**index];
                let is_named = part.name == spec.name;
                let is_kind = part.kind == spec.kind;
                (is_named, is_kind, part.mesh.positions.len(), std::cmp::Reverse(**index))
            };
            let look = members.iter().max_by_key(score).copied();
            let mut merged = Merged::default();
            for index in members {
                let part = &pack.parts()[index];
                let first = merged.len();
                let appended = merged.append(pack, part, bones, shapes);
                if part.name != spec.name {
                    let with = if Some(index) == look { "" } else { ", with its looks" };
                    notes.push(format!(
                        "part {:?} is vertices {first} and up of {}{with}",
                        part.name, spec.name
                    ));
                }
                if appended.reduced > 0 {
                    let text = "vertices have more than four bones: the four largest are kept";
                    notes.push(format!("part {:?}: {} {text}", part.name, appended.reduced));
                }
                if appended.is_unfit {
                    let text = "rests in another pose than that of its binding: where joints share vertices it bends otherwise";
                    notes.push(format!("part {:?} {text}", part.name));
                }
                if !part.mesh.tangents.is_empty() {
                    notes.push(format!("part {:?}: its tangents are left out", part.name));
                }
            }
            further.push(merged.take_further(shapes));
            meshes.push(merged.into_mesh(spec.follows));
            looks.push(look);
        }
        fill(&mut meshes, notes);
        Self { meshes, looks, further }
    }
}

/// The one joint of the format that a whole part follows.
fn only_bone(part: &Part, bones: &Bones) -> Option<&'static str> {
    let place = |bone: usize| bones.places.get(bone).copied().flatten();
    let bone = match (part.bone, &part.mesh.skinning) {
        (Some(bone), _) => bone,
        (None, None) => return None,
        (None, Some(skinning)) => match skinning.used_bones()[..] {
            [bone] => bone.into(),
            _ => return None,
        },
    };
    FACE_BONES.get(place(bone)?).copied()
}

/// Which of [`FACE_PARTS`] a part becomes.
fn place_of(pack: &Pack, part: &Part, bones: &Bones, shapes: &Places<'_>) -> usize {
    const SKIN: usize = 0;
    // Only the skin's vertices have places for shapes; further ones are of any part.
    let is_of_skin = |(name, shape): (&String, &Shape)| {
        shape.moved_vertices() > 0 && !matches!(shapes.place(name), Some(Place::Further(_)))
    };
    if pack.shapes().iter().skip(part.first_shape).zip(&part.mesh.shapes).any(is_of_skin) {
        return SKIN;
    }
    let Some(joint) = only_bone(part, bones) else { return SKIN };
    let fits = |(_, spec): &(usize, &avatar_mesh::PartSpec)| spec.follows == Follows::Joint(joint);
    let mut of_joint = FACE_PARTS.iter().enumerate().filter(fits);
    if let Some((place, _)) = of_joint.clone().find(|(_, spec)| spec.name == part.name) {
        return place;
    }
    if part.kind == PartKind::Skin || FACE_PARTS[SKIN].name == part.name {
        return SKIN;
    }
    // Much hangs from a head.
    let name = part.name.to_lowercase();
    let is_mouth = ["teeth", "tooth", "gum", "upper"].iter().any(|word| name.contains(word));
    if joint == "HeadJoint" && !is_mouth {
        return SKIN;
    }
    let is_cornea = part.kind == PartKind::Cornea;
    of_joint.find(|(_, spec)| (spec.kind == PartKind::Cornea) == is_cornea).map_or(SKIN, |(place, _)| place)
}

/// A part must have a vertex. It stands where others are, so that it makes nothing larger.
fn fill(meshes: &mut [Mesh], notes: &mut Vec<String>) {
    let place = meshes.iter().find_map(|mesh| mesh.positions.first().copied()).unwrap_or_default();
    for (mesh, spec) in meshes.iter_mut().zip(FACE_PARTS).filter(|(mesh, _)| mesh.positions.is_empty()) {
        notes.push(format!("there is no {}: it has one vertex and no triangle", spec.name));
        let mut merged = Merged::default();
        merged.point(place, Vec3::Z, Vec2::ZERO);
        *mesh = merged.into_mesh(spec.follows);
    }
}
