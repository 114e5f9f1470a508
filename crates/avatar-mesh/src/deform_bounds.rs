use crate::{Bounds, Mesh, Skinning};
use glam::{Affine3A, DVec3, Vec3};

/// A box around whatever [`crate::deform()`] makes of a mesh, without looking at its vertices: never too
/// small.
///
/// A deformed vertex is a mean of what its bones make of its blended position, so it lies within the union of
/// boxes that each bone moves ([`BoneBounds`]). Bone weights below 0 or with another sum than 1 widen the
/// union by as much as they can carry a vertex out of it; so does what f32 may round.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeformBounds {
    bones: Vec<BoneBounds>,
    /// Largest sum of negative bone weights of a vertex, as a positive number.
    overshoot: f64,
    /// How far the sum of a vertex's bone weights is from 1 at most.
    sum_off: f64,
}

/// Where a cell of the vertices that one bone moves is, before it moves them: the box of the undeformed ones,
/// and what each shape makes of it.
#[derive(Clone, Debug, PartialEq)]
pub struct BoneBounds {
    bone: usize,
    /// Of all vertices without shapes.
    rest: Bounds,
    /// The box of the vertices that no shape moves; its minimum lies above its maximum without such vertices.
    still: Bounds,
    /// Shapes that move any.
    reach: Vec<Reach>,
    /// For each of +x, +y, +z, −x, −y, −z: the numbers of `reach`, furthest first by where what they move is
    /// at rest.
    furthest_first: [Vec<u32>; 6],
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Reach {
    shape: usize,
    /// Where the moved vertices are without shapes.
    rest: Bounds,
    /// Between which offsets they are moved at weight 1.
    offsets: Bounds,
    moves_all: bool,
}

/// Cells of a bone: 2 to this power. A box that a bone turns grows by up to its own size, so small ones fit
/// better. Of a head that turns by up to 0.6 radians, the longest edge is too long by 1.3 to 1.4 on average
/// and 1.8 at most with one box per bone, by 1.2 and 1.5 with 32.
const HALVINGS: usize = 5;
/// Vertices of a cell that is not halved any more.
const SMALLEST_CELL: usize = 8;

const NOTHING: Bounds = Bounds { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

fn with(bounds: Bounds, point: Vec3) -> Bounds {
    bounds.union(Bounds { min: point, max: point })
}

/// The coordinate of a box that is furthest in a direction, as a distance in that direction.
fn extreme(bounds: Bounds, direction: usize) -> f64 {
    match direction {
        0..3 => bounds.max[direction].into(),
        _ => (-bounds.min[direction % 3]).into(),
    }
}

impl DeformBounds {
    /// Of a mesh that follows its own bones; one without skinning follows bone 0.
    pub fn new(mesh: &Mesh) -> Self {
        let Some(skinning) = &mesh.skinning else { return Self::rigid(mesh, 0) };
        // Half the memory for the usual four.
        if skinning.more_bones.is_empty() {
            Self::skinned::<4>(mesh, skinning)
        } else {
            Self::skinned::<8>(mesh, skinning)
        }
    }

    /// Of a mesh that has up to so many bones a vertex.
    fn skinned<const BONES: usize>(mesh: &Mesh, skinning: &Skinning) -> Self {
        let mut bounds = Self::default();
        let mut bones_of = vec![[None; BONES]; mesh.positions.len()];
        for (vertex, slots) in bones_of.iter_mut().enumerate() {
            let (mut sum, mut below_zero) = (0.0, 0.0);
            for (slot, (bone, weight)) in skinning.influences(vertex).take(BONES).enumerate() {
                let bone = Some(usize::from(bone));
                if weight != 0.0 && !slots[..slot].contains(&bone) {
                    slots[slot] = bone;
                }
                sum += f64::from(weight);
                below_zero += (-f64::from(weight)).max(0.0);
            }
            // Without any weight a vertex is carried to the origin: the sum of 0 widens the box as far.
            if *slots == [None; BONES] {
                slots[0] = skinning.bones.get(vertex).map(|bones| usize::from(bones[0]));
            }
            bounds.overshoot = bounds.overshoot.max(below_zero);
            bounds.sum_off = bounds.sum_off.max((sum - 1.0).abs());
        }
        bounds.bones = bone_bounds(mesh, bones_of);
        bounds
    }

    /// Of a mesh all of whose vertices follow one bone, whatever its skinning says.
    pub fn rigid(mesh: &Mesh, bone: usize) -> Self {
        let bones_of = vec![[Some(bone)]; mesh.positions.len()];
        Self { bones: bone_bounds(mesh, bones_of), ..Self::default() }
    }

    /// The boxes, several for each bone that moves anything, in ascending order of bones.
    pub fn bones(&self) -> &[BoneBounds] {
        &self.bones
    }

    /// How far bone weights carry vertices out of the union of the boxes that bones move, at most:
    /// `[overshoot, sum_off]`, the largest sum of negative weights of a vertex, and how far the sum of its
    /// weights is from 1. That is `overshoot · size + sum_off · largest` on each side, with the union's size
    /// and its largest coordinate.
    pub fn excess(&self) -> [f32; 2] {
        [self.overshoot as f32, self.sum_off as f32]
    }

    /// The box around the mesh with these bone matrices, and these weights of its shapes. `None` without
    /// vertices; bones beyond the palette, which [`crate::deform()`] refuses, and missing weights count as
    /// nothing.
    pub fn around(&self, bones: &[Affine3A], weights: &[f32]) -> Option<Bounds> {
        let weight = |shape: usize| weights.get(shape).copied().unwrap_or(0.0);
        self.around_within(bones, |shape| [weight(shape); 2])
    }

    /// The box around the mesh with these bone matrices, for all weights between two of each shape.
    pub fn around_within(&self, bones: &[Affine3A], range: impl Fn(usize) -> [f32; 2]) -> Option<Bounds> {
        let (mut min, mut max, mut furthest) = (DVec3::INFINITY, DVec3::NEG_INFINITY, DVec3::ZERO);
        for around in &self.bones {
            let Some(bone) = bones.get(around.bone) else { continue };
            let shaped = around.shaped_wide(&range);
            let (center, half) = ((shaped.0 + shaped.1) * 0.5, (shaped.1 - shaped.0) * 0.5);
            let matrix = bone.matrix3.as_dmat3();
            let shift = bone.translation.as_dvec3();
            let reach = matrix.abs();
            let (middle, half) = (matrix * center + shift, reach * half);
            (min, max) = (min.min(middle - half), max.max(middle + half));
            furthest = furthest.max(reach * (center.abs() + (shaped.1 - shaped.0) * 0.5) + shift.abs());
        }
        // Matrix times vector times weight, up to eight times, in f32: 13 roundings of half an epsilon.
        let rounding = 16.0 * f64::from(f32::EPSILON) * (1.0 + 2.0 * self.overshoot) * furthest;
        let wider = rounding + self.overshoot * (max - min) + self.sum_off * furthest;
        (min.x <= max.x).then(|| outward(min - wider, max + wider))
    }
}

impl BoneBounds {
    /// The bone.
    pub fn bone(&self) -> usize {
        self.bone
    }

    /// The box before the bone moves it, for all weights between two of each shape, of any size and sign.
    pub fn shaped(&self, range: impl Fn(usize) -> [f32; 2]) -> Bounds {
        let (min, max) = self.shaped_wide(&range);
        outward(min, max)
    }

    /// In every direction the smaller of two bounds:
    ///
    /// - the furthest vertex at rest, plus the most that each shape moves anything;
    /// - for a vertex, among the shapes that move it, take the one whose vertices lie least far at rest. The
    ///   vertex lies no further, and only shapes that lie at least as far move it, too: the largest of `rest
    ///   + moves` over all shapes in that place. So what raises the chin does not raise the crown.
    fn shaped_wide(&self, range: &impl Fn(usize) -> [f32; 2]) -> (DVec3, DVec3) {
        let mut far = [0.0; 6];
        for (direction, far) in far.iter_mut().enumerate() {
            let mut all = extreme(self.rest, direction);
            let mut furthest = extreme(self.still, direction);
            let (mut before, mut size) = (0.0, all.abs().max(extreme(self.rest, (direction + 3) % 6).abs()));
            for reach in self.furthest_first[direction].iter().filter_map(|k| self.reach.get(*k as usize)) {
                let [least, most] = range(reach.shape).map(f64::from);
                let (a, b) =
                    (extreme(reach.offsets, direction), -extreme(reach.offsets, (direction + 3) % 6));
                let products = [least * a, least * b, most * a, most * b];
                // f64::max passes over the NaN of an infinite weight times 0.
                let moves = products.into_iter().fold(f64::NEG_INFINITY, f64::max);
                size += products.into_iter().fold(0.0, |size, product| f64::max(size, product.abs()));
                furthest = furthest.max(extreme(reach.rest, direction) + moves + before);
                before += moves.max(0.0);
                all += if reach.moves_all { moves } else { moves.max(0.0) };
            }
            // Each shape is a product and a sum in f32.
            let rounding = f64::from(f32::EPSILON) * (self.reach.len() + 1) as f64 * size;
            *far = furthest.min(all) + rounding;
        }
        let [x, y, z, below_x, below_y, below_z] = far;
        (-DVec3::new(below_x, below_y, below_z), DVec3::new(x, y, z))
    }
}

/// As f32, rounded away from the middle.
fn outward(min: DVec3, max: DVec3) -> Bounds {
    let (min, max) = (min.as_vec3(), max.as_vec3());
    Bounds { min: min.to_array().map(f32::next_down).into(), max: max.to_array().map(f32::next_up).into() }
}

/// Gives each vertex, instead of its bones, the cells of these bones that it lies in, and says whose each
/// cell is.
fn cells<const BONES: usize>(mesh: &Mesh, bones_of: &mut [[Option<usize>; BONES]]) -> Vec<usize> {
    let mut slots: Vec<(usize, usize, usize)> = Vec::new();
    for (vertex, bones) in bones_of.iter().enumerate() {
        let used = bones.iter().enumerate().filter_map(|(slot, bone)| Some((slot, (*bone)?)));
        slots.extend(used.map(|(slot, bone)| (bone, vertex, slot)));
    }
    slots.sort_unstable();
    let mut cells = Vec::new();
    for of_bone in slots.chunk_by_mut(|a, b| a.0 == b.0) {
        let mut open = vec![(of_bone, 0)];
        while let Some((slots, depth)) = open.pop() {
            let place = |slot: &(usize, usize, usize)| mesh.positions[slot.1];
            let size = slots.iter().map(place).fold(NOTHING, with).size();
            if depth < HALVINGS && slots.len() > SMALLEST_CELL && size.max_element() > 0.0 {
                let axis = size.max_position();
                let middle = slots.len() / 2;
                slots.select_nth_unstable_by(middle, |a, b| place(a)[axis].total_cmp(&place(b)[axis]));
                let (below, above) = slots.split_at_mut(middle);
                open.extend([(above, depth + 1), (below, depth + 1)]);
            } else if let Some(&(bone, ..)) = slots.first() {
                slots.iter().for_each(|(_, vertex, slot)| bones_of[*vertex][*slot] = Some(cells.len()));
                cells.push(bone);
            }
        }
    }
    cells
}

fn bone_bounds<const BONES: usize>(
    mesh: &Mesh,
    mut bones_of: Vec<[Option<usize>; BONES]>,
) -> Vec<BoneBounds> {
    let cells = cells(mesh, &mut bones_of);
    let of = |vertex: usize| bones_of.get(vertex).copied().unwrap_or([None; BONES]).into_iter().flatten();
    let mut moved = vec![false; mesh.positions.len()];
    for (vertex, _) in mesh.shapes.iter().flat_map(|shape| shape.positions.iter()) {
        moved.get_mut(vertex).into_iter().for_each(|moved| *moved = true);
    }
    let nothing = (0usize, NOTHING, NOTHING);
    // Of each cell: how many vertices, where they are at rest, and those that no shape moves.
    let mut rests = vec![nothing; cells.len()];
    for (vertex, position) in mesh.positions.iter().enumerate() {
        for cell in of(vertex) {
            let (count, rest, still) = &mut rests[cell];
            *count += 1;
            *rest = with(*rest, *position);
            if !moved[vertex] {
                *still = with(*still, *position);
            }
        }
    }
    let mut reaches: Vec<Vec<Reach>> = vec![Vec::new(); cells.len()];
    for (shape, offsets) in mesh.shapes.iter().map(|shape| &shape.positions).enumerate() {
        // Of each cell: how many vertices the shape moves, where they are at rest, and their offsets.
        let mut of_cell = vec![nothing; cells.len()];
        let vertices =
            offsets.iter().filter_map(|(vertex, d)| Some((vertex, *mesh.positions.get(vertex)?, d)));
        for (vertex, position, offset) in vertices {
            for cell in of(vertex) {
                let (count, rest, offsets) = &mut of_cell[cell];
                *count += 1;
                (*rest, *offsets) = (with(*rest, position), with(*offsets, offset));
            }
        }
        for ((reach, (count, rest, offsets)), all) in reaches.iter_mut().zip(of_cell).zip(&rests) {
            if count > 0 {
                reach.push(Reach { shape, rest, offsets, moves_all: count == all.0 });
            }
        }
    }
    let all = cells.into_iter().zip(rests).zip(reaches);
    all.map(|((bone, (_, rest, still)), reach)| {
        let furthest_first = std::array::from_fn(|direction| {
            let mut order: Vec<u32> = (0..reach.len() as u32).collect();
            let far = |k: &u32| extreme(reach[*k as usize].rest, direction);
            order.sort_by(|a, b| far(b).total_cmp(&far(a)));
            order
        });
        BoneBounds { bone, rest, still, reach, furthest_first }
    })
    .collect()
}
