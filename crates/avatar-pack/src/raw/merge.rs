use super::joints::Bones;
use super::shapes::{Place, Places};
use crate::{FurtherShape, Pack, Part};
use avatar_mesh::{FACE_SHAPES, Follows, Mesh, Offsets, Shape, Skinning, normal_matrix, turns_evenly};
use glam::{Affine3A, DAffine3, DMat3, DVec3, Vec2, Vec3};

/// How far the bones of a vertex may disagree about where it rests, as a share of its distance from their
/// origins.
const DISAGREEMENT: f64 = 1e-5;

/// Several parts as one, at rest in world space.
#[derive(Default)]
pub(super) struct Merged {
    mesh: Mesh,
    skinning: Skinning,
    offsets: [(Vec<Vec3>, Vec<Vec3>); FACE_SHAPES.len()],
    /// Of each further shape the vertices that it moves, ascending.
    further: Vec<(Pairs, Pairs)>,
}

/// Vertices with their offsets.
type Pairs = Vec<(u32, Vec3)>;

impl Merged {
    /// Number of vertices.
    pub(super) fn len(&self) -> usize {
        self.mesh.positions.len()
    }

    /// Adds a vertex that follows the first bone.
    pub(super) fn point(&mut self, position: Vec3, normal: Vec3, uv: Vec2) {
        self.mesh.positions.push(position);
        self.mesh.normals.push(normal);
        self.mesh.uvs.push(uv);
        self.skinning.bones.push([0; 4]);
        self.skinning.weights.push([1.0, 0.0, 0.0, 0.0]);
        self.skinning.blend_index.push(Vec3::ZERO);
        for (positions, normals) in &mut self.offsets {
            positions.push(Vec3::ZERO);
            normals.push(Vec3::ZERO);
        }
    }

    /// Adds a part.
    pub(super) fn append(
        &mut self,
        pack: &Pack,
        part: &Part,
        bones: &Bones,
        shapes: &Places<'_>,
    ) -> Appended {
        let first = self.len() as u32;
        let from = &part.mesh;
        let names = pack.shapes().iter().skip(part.first_shape).zip(&from.shapes);
        let placed: Vec<(Place, &Shape)> =
            names.filter_map(|(name, shape)| Some((shapes.place(name)?, shape))).collect();
        self.further.resize_with(shapes.list.shapes.len(), Default::default);
        let mut appended = Appended::default();
        let mut is_mirrored = vec![false; from.positions.len()];
        for (vertex, position) in from.positions.iter().enumerate() {
            let at_rest = AtRest::of(bones, &influences(part, vertex), *position, &mut appended.is_unfit);
            is_mirrored[vertex] = at_rest.is_mirrored();
            let (of_vertex, weights) = four_influences(part, vertex, &mut appended.reduced);
            let normal = from.normals.get(vertex).copied().unwrap_or_default();
            let uv = from.uvs.get(vertex).copied().unwrap_or_default();
            let (normal, shorter) = at_rest.normal(normal);
            self.point(at_rest.point(*position), normal, uv);
            for (place, shape) in &placed {
                let of_normal = shape.normals.as_ref().and_then(|normals| normals.get(vertex));
                let offset = at_rest.offset(shape.positions.get(vertex));
                let of_normal = at_rest.offset_of_normal(of_normal, shorter);
                match *place {
                    Place::Skin(place) => {
                        let Some((positions, normals)) = self.offsets.get_mut(place) else { continue };
                        add(positions, offset);
                        add(normals, of_normal);
                    }
                    Place::Further(place) => {
                        let Some((positions, normals)) = self.further.get_mut(place) else { continue };
                        add_pair(positions, first + vertex as u32, offset);
                        add_pair(normals, first + vertex as u32, of_normal);
                    }
                }
            }
            let place =
                |bone: u16| bones.places.get(usize::from(bone)).copied().flatten().unwrap_or(0) as u16;
            set_last(&mut self.skinning.bones, of_vertex.map(place));
            set_last(&mut self.skinning.weights, weights);
            let unknown = from.skinning.as_ref().and_then(|skinning| skinning.blend_index.get(vertex));
            set_last(&mut self.skinning.blend_index, unknown.copied().unwrap_or_default());
        }
        let run = |[a, b, c]: [u32; 3]| {
            let mirrored =
                [a, b, c].into_iter().filter(|corner| is_mirrored.get(*corner as usize) == Some(&true));
            if mirrored.count() > 1 { [a, c, b] } else { [a, b, c] }
        };
        self.mesh
            .triangles
            .extend(from.triangles.iter().map(|corners| run(*corners).map(|corner| corner + first)));
        appended
    }

    /// Takes the further shapes out of it, in the order of these.
    pub(super) fn take_further(&mut self, shapes: &Places<'_>) -> Vec<Shape> {
        let vertices = self.len();
        let shape = |((positions, normals), listed): ((Pairs, Pairs), &FurtherShape)| {
            // Pairs ascend and are of vertices that there are.
            let offsets = |pairs: Pairs| Offsets::from_pairs(vertices, pairs).unwrap_or_default();
            Shape::new(listed.name.clone(), offsets(positions)).with_normals(offsets(normals))
        };
        std::mem::take(&mut self.further).into_iter().zip(&shapes.list.shapes).map(shape).collect()
    }

    /// The mesh; of a rigid part without bones and shapes, else with the two shapes of the format.
    pub(super) fn into_mesh(self, follows: Follows) -> Mesh {
        let Self { mesh, skinning, offsets, .. } = self;
        match follows {
            Follows::Joint(_) => mesh,
            Follows::Bones => {
                let shape = |(name, (positions, normals)): (&str, (Vec<Vec3>, Vec<Vec3>))| {
                    Shape::new(name, positions).with_normals(normals)
                };
                let shapes = FACE_SHAPES.into_iter().zip(offsets).map(shape).collect();
                Mesh { skinning: Some(skinning), shapes, ..mesh }
            }
        }
    }
}

fn set_last<T>(list: &mut [T], value: T) {
    if let Some(last) = list.last_mut() {
        *last = value;
    }
}

/// Adds to the last offset; what is alone stays as it is, to the sign of its zeros.
fn add(offsets: &mut [Vec3], offset: Option<Vec3>) {
    if let (Some(last), Some(offset)) = (offsets.last_mut(), offset) {
        *last = if *last == Vec3::ZERO { offset } else { *last + offset };
    }
}

/// Adds to the offset of the last vertex, or one more vertex where it moves.
fn add_pair(pairs: &mut Pairs, vertex: u32, offset: Option<Vec3>) {
    let Some(offset) = offset.filter(|offset| offset.to_array().iter().any(|x| x.to_bits() != 0)) else {
        return;
    };
    match pairs.last_mut() {
        Some((last, sum)) if *last == vertex => *sum += offset,
        _ => pairs.push((vertex, offset)),
    }
}

/// What adding a part tells.
#[derive(Default)]
pub(super) struct Appended {
    /// Whether the bones of a vertex disagree about where it rests.
    pub(super) is_unfit: bool,
    /// Vertices of which the format does not hold all bones.
    pub(super) reduced: usize,
}

/// The bones of a vertex and their weights.
fn influences(part: &Part, vertex: usize) -> Vec<(u16, f32)> {
    match (&part.bone, &part.mesh.skinning) {
        (Some(bone), _) => vec![(u16::try_from(*bone).unwrap_or(u16::MAX), 1.0)],
        (None, Some(skinning)) => skinning.influences(vertex).collect(),
        (None, None) => vec![(0, 1.0)],
    }
}

/// The four that the format holds. Counts the vertices that have more.
fn four_influences(part: &Part, vertex: usize, reduced: &mut usize) -> ([u16; 4], [f32; 4]) {
    const WHOLE: [f32; 4] = [1.0, 0.0, 0.0, 0.0];
    match (&part.bone, &part.mesh.skinning) {
        (Some(bone), _) => ([u16::try_from(*bone).unwrap_or(u16::MAX), 0, 0, 0], WHOLE),
        (None, Some(skinning)) if vertex < skinning.weights.len() => {
            let four = skinning.largest_four(vertex);
            let kept = four.1.iter().filter(|weight| **weight != 0.0).count();
            let all = skinning.influences(vertex).filter(|(_, weight)| *weight != 0.0).count();
            *reduced += usize::from(all > kept);
            four
        }
        _ => ([0; 4], WHOLE),
    }
}

/// `world_from_mesh` of one vertex at rest, and what turns its normals; `None` leaves it where it is.
struct AtRest(Option<(DAffine3, DMat3)>);

impl AtRest {
    fn of(bones: &Bones, influences: &[(u16, f32)], position: Vec3, is_unfit: &mut bool) -> Self {
        let position = position.as_dvec3();
        let rest = |bone: u16| bones.rest.get(usize::from(bone)).copied().flatten();
        let moving = || influences.iter().copied().filter(|(_, weight)| *weight != 0.0);
        if moving().all(|(bone, _)| rest(bone).is_none()) {
            return Self(None);
        }
        let mut sum = DAffine3::ZERO;
        let mut first: Option<DVec3> = None;
        let mut is_even = true;
        for (bone, weight) in moving() {
            let matrix = rest(bone).unwrap_or(DAffine3::IDENTITY);
            let place = matrix.transform_point3(position);
            let reference = *first.get_or_insert(place);
            let reach = reference.length() + matrix.translation.length();
            *is_unfit |= (place - reference).length() > DISAGREEMENT * reach;
            is_even &= turns_evenly(&Affine3A::from_mat3(matrix.matrix3.as_mat3()));
            let weight = f64::from(weight);
            sum = DAffine3 {
                matrix3: sum.matrix3 + matrix.matrix3 * weight,
                translation: sum.translation + matrix.translation * weight,
            };
        }
        Self(Some((sum, if is_even { sum.matrix3 } else { normal_matrix(&sum.matrix3) })))
    }

    fn is_mirrored(&self) -> bool {
        self.0.is_some_and(|(matrix, _)| matrix.matrix3.determinant() < 0.0)
    }

    fn point(&self, point: Vec3) -> Vec3 {
        self.0.map_or(point, |(matrix, _)| matrix.transform_point3(point.as_dvec3()).as_vec3())
    }

    /// The normal at rest with the length that it has in the mesh, and what offsets of normals are multiplied
    /// by.
    fn normal(&self, normal: Vec3) -> (Vec3, f64) {
        let Some((_, turn)) = self.0 else { return (normal, 1.0) };
        let moved = turn * normal.as_dvec3();
        let shorter = f64::from(normal.length()) / moved.length();
        if shorter.is_finite() { ((moved * shorter).as_vec3(), shorter) } else { (normal, 1.0) }
    }

    fn offset(&self, offset: Option<Vec3>) -> Option<Vec3> {
        let offset = offset?;
        Some(self.0.map_or(offset, |(matrix, _)| matrix.transform_vector3(offset.as_dvec3()).as_vec3()))
    }

    fn offset_of_normal(&self, offset: Option<Vec3>, factor: f64) -> Option<Vec3> {
        let offset = offset?;
        Some(self.0.map_or(offset, |(_, turn)| (turn * offset.as_dvec3() * factor).as_vec3()))
    }
}
