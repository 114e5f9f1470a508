use super::joints::Bones;
use super::shapes::Places;
use crate::{Pack, Part};
use avatar_mesh::{FACE_SHAPES, Follows, Mesh, Shape, Skinning};
use glam::{DAffine3, DVec3, Vec2, Vec3};

/// How far the bones of a vertex may disagree about where it rests, as a share of its distance from their
/// origins.
const DISAGREEMENT: f64 = 1e-5;

/// Several parts as one, at rest in world space.
#[derive(Default)]
pub(super) struct Merged {
    mesh: Mesh,
    skinning: Skinning,
    offsets: [(Vec<Vec3>, Vec<Vec3>); FACE_SHAPES.len()],
}

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

    /// Adds a part. Tells whether the bones of a vertex disagree about where it rests.
    pub(super) fn append(&mut self, pack: &Pack, part: &Part, bones: &Bones, shapes: &Places<'_>) -> bool {
        let first = self.len() as u32;
        let from = &part.mesh;
        let names = pack.shapes().iter().skip(part.first_shape).zip(&from.shapes);
        let placed: Vec<(usize, &Shape)> =
            names.filter_map(|(name, shape)| Some((shapes.place(name)?, shape))).collect();
        let mut unfit = false;
        for (vertex, position) in from.positions.iter().enumerate() {
            let (of_vertex, weights) = influences(part, vertex);
            let at_rest = AtRest::of(bones, of_vertex, weights, *position, &mut unfit);
            let normal = from.normals.get(vertex).copied().unwrap_or_default();
            let uv = from.uvs.get(vertex).copied().unwrap_or_default();
            let (normal, shorter) = at_rest.normal(normal);
            self.point(at_rest.point(*position), normal, uv);
            for (place, shape) in &placed {
                let Some((positions, normals)) = self.offsets.get_mut(*place) else { continue };
                let of_normal = shape.normals.as_ref().and_then(|normals| normals.get(vertex));
                add(positions, at_rest.offset(shape.positions.get(vertex), 1.0));
                add(normals, at_rest.offset(of_normal, shorter));
            }
            let place =
                |bone: u16| bones.places.get(usize::from(bone)).copied().flatten().unwrap_or(0) as u16;
            set_last(&mut self.skinning.bones, of_vertex.map(place));
            set_last(&mut self.skinning.weights, weights);
            let unknown = from.skinning.as_ref().and_then(|skinning| skinning.blend_index.get(vertex));
            set_last(&mut self.skinning.blend_index, unknown.copied().unwrap_or_default());
        }
        self.mesh.triangles.extend(from.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
        unfit
    }

    /// The mesh; of a rigid part without bones and shapes.
    pub(super) fn into_mesh(self, follows: Follows) -> Mesh {
        let Self { mesh, skinning, offsets } = self;
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

fn influences(part: &Part, vertex: usize) -> ([u16; 4], [f32; 4]) {
    const WHOLE: [f32; 4] = [1.0, 0.0, 0.0, 0.0];
    match (&part.bone, &part.mesh.skinning) {
        (Some(bone), _) => ([u16::try_from(*bone).unwrap_or(u16::MAX), 0, 0, 0], WHOLE),
        (None, Some(skinning)) => {
            let bones = skinning.bones.get(vertex).copied().unwrap_or_default();
            (bones, skinning.weights.get(vertex).copied().unwrap_or(WHOLE))
        }
        (None, None) => ([0; 4], WHOLE),
    }
}

/// `world_from_mesh` of one vertex at rest; `None` leaves it where it is.
struct AtRest(Option<DAffine3>);

impl AtRest {
    fn of(bones: &Bones, of_vertex: [u16; 4], weights: [f32; 4], position: Vec3, unfit: &mut bool) -> Self {
        let position = position.as_dvec3();
        let rest = |bone: u16| bones.rest.get(usize::from(bone)).copied().flatten();
        let moving = || of_vertex.into_iter().zip(weights).filter(|(_, weight)| *weight != 0.0);
        if moving().all(|(bone, _)| rest(bone).is_none()) {
            return Self(None);
        }
        let mut sum: Option<DAffine3> = None;
        let mut first: Option<DVec3> = None;
        for (bone, weight) in moving() {
            let matrix = rest(bone).unwrap_or(DAffine3::IDENTITY);
            let place = matrix.transform_point3(position);
            let reference = *first.get_or_insert(place);
            let reach = reference.length() + matrix.translation.length();
            *unfit |= (place - reference).length() > DISAGREEMENT * reach;
            let weight = f64::from(weight);
            let so_far = sum.unwrap_or(DAffine3::ZERO);
            sum = Some(DAffine3 {
                matrix3: so_far.matrix3 + matrix.matrix3 * weight,
                translation: so_far.translation + matrix.translation * weight,
            });
        }
        Self(sum)
    }

    fn point(&self, point: Vec3) -> Vec3 {
        self.0.map_or(point, |matrix| matrix.transform_point3(point.as_dvec3()).as_vec3())
    }

    /// The normal at rest with the length that it has in the mesh, and what offsets of normals are multiplied
    /// by.
    fn normal(&self, normal: Vec3) -> (Vec3, f64) {
        let Some(matrix) = self.0 else { return (normal, 1.0) };
        let moved = matrix.transform_vector3(normal.as_dvec3());
        let shorter = f64::from(normal.length()) / moved.length();
        if shorter.is_finite() { ((moved * shorter).as_vec3(), shorter) } else { (normal, 1.0) }
    }

    fn offset(&self, offset: Option<Vec3>, factor: f64) -> Option<Vec3> {
        let offset = offset?;
        Some(self.0.map_or(offset, |m| (m.transform_vector3(offset.as_dvec3()) * factor).as_vec3()))
    }
}
