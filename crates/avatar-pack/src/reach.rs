use crate::{FaceState, Pack, Part};
use avatar_mesh::Bounds;
use glam::Vec3;
use std::cmp::Reverse;

/// A vertex counts as moved from this share of the face's height on.
const MOVED: f32 = 0.002;
/// A control that moves more than this share of the face's vertices moves the whole head.
const WHOLE: f32 = 0.9;

/// Which vertices each control moves, and which controls move a vertex: for highlighting what a slider does,
/// and the sliders of what is pointed at.
///
/// A control moves a vertex if at one end of its range, with the other controls at their defaults and
/// couplings at work, the vertex is more than 0.2 % of the face's height from where it is at the default. The
/// face is what follows the joint of `head.turn`; all vertices without such a control.
#[derive(Clone, Debug)]
pub struct Reach {
    controls: Vec<ControlReach>,
}

#[derive(Clone, Debug)]
struct ControlReach {
    /// Per part; `None` where nothing moves.
    parts: Vec<Option<Field>>,
    /// How much of the face's vertices moves, 0 to 1.
    share: f32,
}

/// A byte for some of a part's vertices: a bit per vertex, and a byte for each bit that is set.
#[derive(Clone, Debug)]
struct Field {
    bits: Vec<u64>,
    /// Per word of bits how many are set before it.
    before: Vec<u32>,
    /// How far the vertex moves; 255 is the furthest that the control moves any.
    strengths: Vec<u8>,
}

impl Reach {
    /// Tries out both ends of all controls on the CPU, part by part; parts that a control leaves alone cost
    /// nothing. It takes long enough to be left to a thread beside the one that draws.
    pub fn new(pack: &Pack) -> Self {
        let mut state = FaceState::new(pack);
        let mut values = pack.controls().defaults();
        // With values of the right number, all finite, nothing fails; what did would count as not moved.
        let _ = state.pose(pack, &values);
        let rest = state.clone();
        let used: Vec<Vec<usize>> = pack.parts().iter().map(used_bones).collect();
        let at_rest: Vec<Vec<Vec3>> =
            (0..pack.parts().len()).map(|part| positions(pack, &rest, part)).collect();
        let face = Face::of(pack, &at_rest);
        let mut ways: Vec<Vec<f32>> = at_rest.iter().map(|part| vec![0.0; part.len()]).collect();
        let mut controls = Vec::with_capacity(values.len());
        for (index, control) in pack.controls().controls().iter().enumerate() {
            ways.iter_mut().for_each(|part| part.fill(0.0));
            for end in [control.min, control.max].into_iter().filter(|end| *end != control.default) {
                values[index] = end;
                let _ = state.pose(pack, &values);
                for (part, ways) in ways.iter_mut().enumerate() {
                    if !differs(&pack.parts()[part], &used[part], &rest, &state) {
                        continue;
                    }
                    let moved = positions(pack, &state, part);
                    for ((way, from), to) in ways.iter_mut().zip(&at_rest[part]).zip(&moved) {
                        *way = way.max(from.distance(*to));
                    }
                }
            }
            values[index] = control.default;
            controls.push(ControlReach::of(&ways, &face));
        }
        Self { controls }
    }

    /// The vertices that a control moves, as pairs of part and vertex; none for a control that does not
    /// exist.
    pub fn moved(&self, control: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let parts = self.controls.get(control).map_or(&[][..], |control| &control.parts);
        parts.iter().enumerate().flat_map(|(part, field)| {
            field.iter().flat_map(Field::vertices).map(move |vertex| (part, vertex))
        })
    }

    /// Whether a control moves a vertex, and how far: as a share of the longest way that it makes any vertex
    /// go, above 0 to 1.
    pub fn strength(&self, control: usize, part: usize, vertex: usize) -> Option<f32> {
        let byte = self.controls.get(control)?.parts.get(part)?.as_ref()?.get(vertex)?;
        Some(f32::from(byte) / 255.0)
    }

    /// Fills `out` with the controls that move a vertex, the one that is most about it first: by
    /// [`Reach::strength`], divided by how much of the face moves. Those that move the whole head come last.
    pub fn controls_at(&self, part: usize, vertex: usize, out: &mut Vec<usize>) {
        out.clear();
        out.extend(
            (0..self.controls.len()).filter(|control| self.strength(*control, part, vertex).is_some()),
        );
        let rank = |control: usize| {
            let share = self.controls.get(control).map_or(1.0, |control| control.share);
            let about = self.strength(control, part, vertex).unwrap_or(0.0) / share.max(f32::MIN_POSITIVE);
            // Numbers that are not negative are in the order of their bits.
            (share > WHOLE, Reverse(about.to_bits()), control)
        };
        out.sort_unstable_by_key(|control| rank(*control));
    }

    /// Bytes that the tables take.
    pub fn memory_bytes(&self) -> usize {
        let fields = self.controls.iter().flat_map(|control| control.parts.iter().flatten());
        fields.map(|field| field.bits.len() * 12 + field.strengths.len()).sum()
    }
}

/// What stands for the face where shares are counted.
struct Face {
    /// Per part and vertex.
    is_face: Vec<Vec<bool>>,
    count: usize,
    /// The least way that counts.
    moved: f32,
}

impl Face {
    fn of(pack: &Pack, positions: &[Vec<Vec3>]) -> Self {
        let mut is_face: Vec<Vec<bool>> = pack.parts().iter().map(|part| on_head(pack, part)).collect();
        if !is_face.iter().flatten().any(|is_face| *is_face) {
            is_face.iter_mut().for_each(|part| part.fill(true));
        }
        let both = positions.iter().flatten().zip(is_face.iter().flatten());
        let face: Vec<Vec3> = both.filter(|(_, is_face)| **is_face).map(|(position, _)| *position).collect();
        let height = Bounds::of(&face).map_or(0.0, |bounds| bounds.max.y - bounds.min.y);
        Self { is_face, count: face.len(), moved: MOVED * height }
    }
}

/// Per vertex whether most of its weight is on the joint of `head.turn` and what hangs from it.
fn on_head(pack: &Pack, part: &Part) -> Vec<bool> {
    let control = pack
        .controls()
        .index(pose_anim::face::HEAD_TURN)
        .and_then(|index| pack.controls().controls().get(index));
    let head = control.and_then(|control| match &control.drives {
        pose_anim::Drive::Joint { joint, .. } => pack.rig().joint(joint),
        pose_anim::Drive::Shape { .. } => None,
    });
    let is_head = |bone: usize| {
        let mut joint = pack.palette().get(bone).map(|bone| bone.joint);
        while joint.is_some() && joint != head {
            joint = joint.and_then(|joint| pack.rig().parents().get(joint.index()).copied().flatten());
        }
        joint.is_some()
    };
    let count = part.mesh.positions.len();
    match (&part.mesh.skinning, part.bone) {
        (Some(skinning), None) => {
            let bones: Vec<bool> = (0..pack.palette().len()).map(is_head).collect();
            let is_on_head = |vertex| {
                let all = skinning.influences(vertex);
                let on_head = all.filter(|(bone, _)| bones.get(usize::from(*bone)) == Some(&true));
                on_head.map(|(_, weight)| weight).sum::<f32>() > 0.5
            };
            (0..skinning.bones.len()).map(is_on_head).collect()
        }
        (_, bone) => vec![is_head(bone.unwrap_or(0)); count],
    }
}

/// The bones that move anything of a part.
fn used_bones(part: &Part) -> Vec<usize> {
    match part.mesh.skinning.as_ref().filter(|_| part.bone.is_none()) {
        Some(skinning) => skinning.used_bones().into_iter().map(usize::from).collect(),
        None => vec![part.bone.unwrap_or(0)],
    }
}

/// Whether anything that moves a part is not as at rest.
fn differs<'a>(part: &Part, used: &[usize], rest: &'a FaceState, state: &'a FaceState) -> bool {
    let weights = |state: &'a FaceState| state.weights().get(part.shapes()).unwrap_or_default();
    let shapes = part.mesh.shapes.iter().zip(weights(rest).iter().zip(weights(state)));
    used.iter().any(|bone| rest.bones().get(*bone) != state.bones().get(*bone)) || { shapes }
        .any(|(shape, (rest, now))| rest != now && shape.moved_vertices() > 0)
}

fn positions(pack: &Pack, state: &FaceState, part: usize) -> Vec<Vec3> {
    state.deform(pack, part).map(|deformed| deformed.positions).unwrap_or_default()
}

impl ControlReach {
    fn of(ways: &[Vec<f32>], face: &Face) -> Self {
        let longest = ways.iter().flatten().fold(0.0f32, |longest, way| longest.max(*way));
        let parts = ways.iter().map(|ways| Field::of(ways, face.moved, longest)).collect();
        let both = ways.iter().flatten().zip(face.is_face.iter().flatten());
        let moved = both.filter(|(way, is_face)| **is_face && **way > face.moved).count();
        Self { parts, share: moved as f32 / face.count.max(1) as f32 }
    }
}

impl Field {
    fn of(ways: &[f32], least: f32, longest: f32) -> Option<Self> {
        let mut field = Self { bits: Vec::new(), before: Vec::new(), strengths: Vec::new() };
        for ways in ways.chunks(64) {
            field.before.push(field.strengths.len() as u32);
            let mut word = 0;
            for (bit, way) in ways.iter().enumerate().filter(|(_, way)| **way > least) {
                word |= 1 << bit;
                field.strengths.push((255.0 * way / longest).ceil().max(1.0) as u8);
            }
            field.bits.push(word);
        }
        field.strengths.shrink_to_fit();
        (!field.strengths.is_empty()).then_some(field)
    }

    fn get(&self, vertex: usize) -> Option<u8> {
        let (word, bit) = (vertex / 64, vertex % 64);
        let bits = *self.bits.get(word)?;
        if bits >> bit & 1 == 0 {
            return None;
        }
        let lower = bits & ((1 << bit) - 1);
        self.strengths.get(*self.before.get(word)? as usize + lower.count_ones() as usize).copied()
    }

    fn vertices(&self) -> impl Iterator<Item = usize> + '_ {
        let bits = |word: u64| (0..64).filter(move |bit| word >> bit & 1 == 1);
        self.bits.iter().enumerate().flat_map(move |(at, word)| bits(*word).map(move |bit| at * 64 + bit))
    }
}
