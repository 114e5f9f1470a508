//! Which shapes of one name share a control.

use super::shape_sets::ShapeSet;
use super::spellings;
use crate::unique::short;
use avatar_exchange::{ChannelTarget, Interpolation, Scene};
use avatar_mesh::Mesh;
use glam::Vec3;
use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};

/// A slider, or a shape that is its own: what a control is made for.
#[derive(Debug)]
pub(super) struct Slot {
    /// Its node.
    pub(super) node: usize,
    /// Its name in the file; several nodes may have one of it.
    pub(super) name: String,
    /// The number of the shape at its node that it moves alone; `None` for what moves several, or in steps.
    pub(super) shape: Option<usize>,
    /// Its value at rest.
    pub(super) rest: f32,
}

/// What controls drive, for each slot: slots of the same name here move together.
#[derive(Debug, Default)]
pub(super) struct Driven {
    /// Names, in the order of the slots.
    pub(super) names: Vec<String>,
    /// What the names mean that are known.
    pub(super) known: HashMap<String, (ShapeSet, &'static str)>,
    /// Names that were made since shapes of one name differ between nodes.
    pub(super) apart: Vec<String>,
    /// Shapes of a node that would be the same.
    pub(super) notes: Vec<String>,
}

impl Driven {
    /// Slots of one name, or of names that mean one shape of a face tracker, share a control: head, teeth and
    /// brows of one face. Those that rest at other weights do not, since one control has one value at rest;
    /// nor do those of nodes with the same mesh that a clip moves otherwise, since these are not parts of one
    /// face but several of the same kind.
    pub(super) fn of(scene: &Scene, slots: &[Slot], node_names: &[String]) -> Self {
        let mut driven = Self::default();
        let known = known(slots, node_names, &mut driven.notes);
        let motions = Motions::of(scene);
        // Per meaning, in the order of the slots, those that share a control.
        let mut by_meaning: HashMap<&str, usize> = HashMap::new();
        let mut meanings: Vec<Vec<Group>> = Vec::new();
        let mut places: HashMap<(usize, Key), usize> = HashMap::new();
        for (number, (slot, known)) in slots.iter().zip(&known).enumerate() {
            let meaning =
                known.filter(|(set, _)| is_shared(*set)).map_or(slot.name.as_str(), |(_, name)| name);
            let place = *by_meaning.entry(meaning).or_insert(meanings.len());
            if place == meanings.len() {
                meanings.push(Vec::new());
            }
            // 0.0 and -0.0 are equal, so both have to be hashed as 0.0.
            let key = ((slot.rest + 0.0).to_bits(), motions.kind(slot));
            let group = *places.entry((place, key)).or_insert(meanings[place].len());
            if group == meanings[place].len() {
                meanings[place].push(Vec::new());
            }
            meanings[place][group].push(number);
        }
        driven.names = vec![String::new(); slots.len()];
        let mut used: HashSet<String> = HashSet::new();
        let mut left = Vec::new();
        for groups in meanings {
            let name = common_name(&groups, slots, &known);
            let plain = with_plain_name(&groups);
            for (place, numbers) in groups.into_iter().enumerate() {
                if Some(place) == plain {
                    numbers.iter().for_each(|number| driven.names[*number].clone_from(&name));
                    used.insert(name.clone());
                } else {
                    left.push((name.clone(), numbers));
                }
            }
        }
        for (name, numbers) in left {
            let node = numbers.first().and_then(|first| node_names.get(slots[*first].node));
            let wanted = format!("{}.{name}", node.map_or("", String::as_str));
            let mut unique = wanted.clone();
            let mut count = 1;
            while !used.insert(unique.clone()) {
                count += 1;
                unique = format!("{wanted}.{count}");
            }
            numbers.iter().for_each(|number| driven.names[*number].clone_from(&unique));
            driven.apart.push(unique);
        }
        for (name, known) in driven.names.iter().zip(known) {
            if let Some(known) = known {
                driven.known.entry(name.clone()).or_insert(known);
            }
        }
        driven
    }
}

/// Weight at rest, and the kind of motion among the nodes of one mesh: what those that share a control share.
type Key = (u32, usize);
/// Slots that share a control.
type Group = Vec<usize>;

/// Whether parts of a face spell names of this set differently and mean the same: one has `head.jawOpen`, the
/// other `teeth.jawOpen`.
fn is_shared(set: ShapeSet) -> bool {
    matches!(set, ShapeSet::ArKit | ShapeSet::Visemes)
}

/// What the names of the slots mean. Of two at a node that mean the same, that one does which is spelt as the
/// set has it, or else the first; the other is by its own name.
fn known(
    slots: &[Slot],
    node_names: &[String],
    notes: &mut Vec<String>,
) -> Vec<Option<(ShapeSet, &'static str)>> {
    let mut known = Vec::with_capacity(slots.len());
    for of_node in slots.chunk_by(|a, b| a.node == b.node) {
        let names: Vec<&str> = of_node.iter().map(|slot| slot.name.as_str()).collect();
        let first = known.len();
        known.extend(spellings::find_all(&names));
        let mut places: HashMap<(ShapeSet, &str), usize> = HashMap::new();
        for place in 0..names.len() {
            let Some(meaning) = known[first + place] else { continue };
            let Some(other) = places.insert(meaning, place) else { continue };
            let (kept, left) = if names[place] == meaning.1 { (place, other) } else { (other, place) };
            places.insert(meaning, kept);
            known[first + left] = None;
            let node = of_node.first().and_then(|slot| node_names.get(slot.node)).map_or("", String::as_str);
            notes.push(format!(
                "node {node:?}: the shapes {:?} and {:?} both mean {:?} of {}: the first does, the other is by its own name",
                short(names[kept]), short(names[left]), meaning.1, meaning.0
            ));
        }
    }
    known
}

/// The name that all of them have, or else that which the set has for them.
fn common_name(groups: &[Group], slots: &[Slot], known: &[Option<(ShapeSet, &'static str)>]) -> String {
    let mut numbers = groups.iter().flatten();
    let Some(first) = numbers.next() else { return String::new() };
    let name = &slots[*first].name;
    match known[*first] {
        Some((_, known)) if numbers.any(|other| slots[*other].name != *name) => known.to_owned(),
        _ => name.clone(),
    }
}

/// Which of several groups goes by the name alone: the only one, or the one with the most.
fn with_plain_name(groups: &[Group]) -> Option<usize> {
    let most = groups.iter().map(Vec::len).max()?;
    let mut largest = groups.iter().enumerate().filter(|(_, numbers)| numbers.len() == most);
    let (place, _) = largest.next()?;
    largest.next().is_none().then_some(place)
}

/// How clips move shapes at nodes that have the same mesh.
#[derive(Debug, Default)]
struct Motions {
    /// By node and shape: which of the kinds of motion that there are among the nodes of its mesh. What is
    /// not there is moved as at all others of its mesh.
    kinds: HashMap<(usize, usize), usize>,
    /// By node: the greatest of these.
    of_nodes: HashMap<usize, usize>,
}

impl Motions {
    fn of(scene: &Scene) -> Self {
        let mut motions = Self::default();
        if scene.clips.is_empty() {
            return motions;
        }
        let mut channels: HashMap<usize, Vec<(usize, &avatar_exchange::Channel)>> = HashMap::new();
        for (clip, channel) in scene
            .clips
            .iter()
            .enumerate()
            .flat_map(|(number, clip)| clip.channels.iter().map(move |channel| (number, channel)))
        {
            if channel.target == ChannelTarget::Weights {
                channels.entry(channel.node).or_default().push((clip, channel));
            }
        }
        for nodes in same_meshes(scene) {
            let shapes = nodes.first().map_or(0, |node| scene.nodes[*node].weights.len());
            for shape in 0..shapes {
                let mut kinds: HashMap<Vec<u64>, usize> = HashMap::new();
                for node in &nodes {
                    let of_node = channels.get(node).map_or(&[][..], Vec::as_slice);
                    let count = kinds.len();
                    let kind = *kinds.entry(motion(of_node, shape, shapes)).or_insert(count);
                    if kind > 0 {
                        motions.kinds.insert((*node, shape), kind);
                        let most = motions.of_nodes.entry(*node).or_insert(kind);
                        *most = kind.max(*most);
                    }
                }
            }
        }
        motions
    }

    /// Of a slider of several shapes, what one of its node's shapes does that is moved otherwise.
    fn kind(&self, slot: &Slot) -> usize {
        let kind = match slot.shape {
            Some(shape) => self.kinds.get(&(slot.node, shape)),
            None => self.of_nodes.get(&slot.node),
        };
        kind.copied().unwrap_or(0)
    }
}

/// All that clips do with a shape, as numbers that are equal where the motion is.
fn motion(channels: &[(usize, &avatar_exchange::Channel)], shape: usize, shapes: usize) -> Vec<u64> {
    let mut all = Vec::new();
    for (clip, channel) in channels {
        let how = match channel.interpolation {
            Interpolation::Step => 0,
            Interpolation::Linear => 1,
            Interpolation::CubicSpline => 2,
        };
        all.extend([*clip as u64, how, channel.times.len() as u64]);
        all.extend(channel.times.iter().map(|time| time.to_bits()));
        let of_shape = channel.values.iter().skip(shape).step_by(shapes.max(1));
        all.extend(of_shape.map(|value| u64::from(value.to_bits())));
    }
    all
}

/// The nodes that have the same meshes with shapes, two or more of each.
fn same_meshes(scene: &Scene) -> Vec<Vec<usize>> {
    let mut parts: HashMap<usize, Vec<&Mesh>> = HashMap::new();
    for part in scene.parts.iter().filter(|part| !part.mesh.shapes.is_empty()) {
        parts.entry(part.node).or_default().push(&part.mesh);
    }
    let mut nodes: Vec<usize> = parts.keys().copied().collect();
    nodes.sort_unstable();
    // By a hash of what the meshes have: only those of one hash are compared in full.
    let mut by_hash: HashMap<u64, Vec<Vec<usize>>> = HashMap::new();
    for node in nodes {
        let meshes = &parts[&node];
        let groups = by_hash.entry(hash_of(meshes)).or_default();
        let is_same = |other: &usize| {
            let others = &parts[other];
            meshes.len() == others.len() && meshes.iter().zip(others).all(|(a, b)| is_same_mesh(a, b))
        };
        match groups.iter_mut().find(|group| group.first().is_some_and(is_same)) {
            Some(group) => group.push(node),
            None => groups.push(vec![node]),
        }
    }
    let mut same: Vec<Vec<usize>> = by_hash.into_values().flatten().filter(|group| group.len() > 1).collect();
    same.sort();
    same
}

fn is_same_mesh(a: &Mesh, b: &Mesh) -> bool {
    a.positions == b.positions && a.triangles == b.triangles && a.shapes == b.shapes
}

/// A hash that is equal for equal meshes.
fn hash_of(meshes: &[&Mesh]) -> u64 {
    // 0.0 and -0.0 are equal, so both have to be hashed as 0.0.
    let bits = |at: Vec3| at.to_array().map(|x| (x + 0.0).to_bits());
    let mut hasher = DefaultHasher::new();
    for mesh in meshes {
        mesh.positions.len().hash(&mut hasher);
        mesh.positions.iter().for_each(|at| bits(*at).hash(&mut hasher));
        mesh.triangles.hash(&mut hasher);
        for shape in &mesh.shapes {
            shape.name.hash(&mut hasher);
            let offsets = shape.positions.iter();
            offsets.for_each(|(vertex, by)| (vertex, bits(by)).hash(&mut hasher));
        }
    }
    hasher.finish()
}
