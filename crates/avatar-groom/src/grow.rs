use crate::{Groom, OTHER_BONES, PlantedStrand, Region, RegionStyle, SEGMENTS, Strand};
use glam::{Affine3A, Mat3, Mat3A, Vec2, Vec3};

/// The deformed triangle of a root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Corners in the world.
    pub positions: [Vec3; 3],
    /// Their normals in the world, unit length.
    pub normals: [Vec3; 3],
}

/// How far strands keep from the skin, as a fraction of its height.
pub const MARGIN: f32 = 0.009;

/// Strands inside of the skin are pushed out by this many times their depth: the way out of an ear is rarely
/// straight. Found by trial on the built-in face.
pub const DEEPER: f32 = 2.2;

/// Length of the first segment by that of an even one.
pub const FIRST_SEGMENT: f32 = 0.15;

/// How far from the skin hair is still combed along it, as a fraction of the skin's height.
pub const COMBED_REACH: f32 = 0.08;

/// The largest radius of a curl by the length of its strand.
pub const CURL_SHARE: f32 = 0.08;

/// How near to its guide a strand is fully drawn to it; twice as far away it goes its own way. As a fraction
/// of the skin's height.
pub const LOCK_REACH: f32 = 0.06;

/// The points of a guide in the world: a strand that follows no other, without curls. `strand` is an index to
/// [`Groom::strands`].
pub fn grow_guide(groom: &Groom, strand: usize, triangle: &Triangle, bones: &[Affine3A]) -> Option<Strand> {
    let length = groom.strands().get(strand)?.length;
    let head = *bones.get(groom.head_bone() as usize)?;
    Some(
        grow_to(groom, strand, length, triangle, bones, None, None)?
            .map(|point| head.transform_point3(point)),
    )
}

/// The points of a strand in the world; the twin of `grow_main` in WGSL, line by line. `guide` is what
/// [`grow_guide`] made of its guide, if it has one.
pub fn grow(
    groom: &Groom,
    strand: usize,
    triangle: &Triangle,
    bones: &[Affine3A],
    guide: Option<&Strand>,
) -> Option<Strand> {
    let head = *bones.get(groom.head_bone() as usize)?;
    let planted = groom.strands().get(strand)?;
    let points = grow_to(groom, strand, planted.length, triangle, bones, guide, Some(planted.phase))?;
    Some(points.map(|point| head.transform_point3(point)))
}

/// A strand of a length, in the head's bind pose; without a `phase` only its middle line.
///
/// It starts on the triangle, goes on along the normal for a short segment, and turns to where it is combed
/// and pulled, outside of the skin. `bones` take the skin from bind pose to its pose of now.
pub(crate) fn grow_to(
    groom: &Groom,
    strand: usize,
    length: f32,
    triangle: &Triangle,
    bones: &[Affine3A],
    guide: Option<&Strand>,
    phase: Option<f32>,
) -> Option<Strand> {
    let head = *bones.get(groom.head_bone() as usize)?;
    let others: [Affine3A; OTHER_BONES] = std::array::from_fn(|i| {
        let other = bones.get(groom.field().bones[i] as usize).copied().unwrap_or(head);
        offset_from_head(head, other)
    });
    let PlantedStrand { root, comb: comb_local, .. } = groom.strands().get(strand)?;
    let style = groom.style().region(root.region);
    let [w0, w1, w2] = root.barycentric;
    let [a, b, c] = triangle.positions;
    let start_world = a * w0 + b * w1 + c * w2;
    let [na, nb, nc] = triangle.normals;
    let normal_world = (na * w0 + nb * w1 + nc * w2).normalize_or(Vec3::Y);
    let [x, y, z] = axes(triangle.positions);
    let bind_from_posed = Mat3::from(head.matrix3).transpose();
    let to_bind = |point: Vec3| bind_from_posed * (point - Vec3::from(head.translation));
    let start = to_bind(start_world);
    let normal = bind_from_posed * normal_world;
    let comb = bind_from_posed * (x * comb_local.x + y * comb_local.y + z * comb_local.z);
    let down = bind_from_posed * Vec3::NEG_Y;

    // The first segment only says where the strand leaves; long hair would stand off by its whole length
    // otherwise.
    let first = FIRST_SEGMENT * length / SEGMENTS as f32;
    let own = Vec3::from_array([root.random[0], root.random[1], root.random[2]]) * 2.0 - 1.0;
    let margin = MARGIN * groom.height();
    // Strands lie over one another instead of in one shell.
    let lift = style.volume * groom.height() * root.random[2] + curl_radius(style, groom.height(), length);

    // Curls wind around the strand: beside it is what is across the plane that it bends in.
    let beside = normal.cross(down + comb).normalize_or(Vec3::X);
    let radius = if phase.is_some() { curl_radius(style, groom.height(), length) } else { 0.0 };
    let mut phase = phase.map_or(Vec2::X, |phase| Vec2::new(libm::cosf(phase), libm::sinf(phase)));
    let turn = style.curl_turn();

    let mut points = [start; SEGMENTS + 1];
    points[1] = start + normal * first;
    let mut before = points[1];
    let (mut direction, mut skin_normal, mut near) = (normal, normal, 1.0f32);
    let back = others.map(|other| Mat3::from(other.matrix3).transpose());
    let mut shares = [0.0; OTHER_BONES];
    for i in 2..=SEGMENTS {
        let t = (i - 1) as f32 / (SEGMENTS - 1) as f32;
        let step = (length - first) * step_share(i);
        // Along the skin: what supports hair takes the comb's push into it.
        let combed = (comb - skin_normal * (comb.dot(skin_normal) * near)) * near.max(style.hold * (1.0 - t));
        let force = combed + own * (style.noise * t) + down * style.gravity - skin_normal * (style.tuck * t);
        // A force straight back is ignored: the sum might have no direction.
        let across = force - direction * force.dot(direction).min(0.0);
        direction = (direction + across * style.bend).normalize_or(direction);
        let mut next = before + direction * step;
        if let Some(guide) = guide {
            let toward = to_bind(guide[i]) - next;
            let share = (2.0 - toward.length() / (LOCK_REACH * groom.height())).clamp(0.0, 1.0);
            next += toward * (style.clump * t * share);
        }
        // Where the skin moves with other bones, the place is sought where they have it at bind pose. The
        // shares are those of the point before.
        let mut seek = |place: Vec3| {
            let moved = |i: usize| others[i].transform_point3(place) * shares[i];
            let near = groom.field().at(place + moved(0) + moved(1));
            let turned = |i: usize| back[i] * near.outward * near.shares[i];
            shares = near.shares;
            (near.distance, (near.outward + turned(0) + turned(1)).normalize_or(near.outward))
        };
        let (mut distance, mut outward) = match root.region {
            Region::Scalp => seek(next),
            // Lids and brows move in the head's frame, and their hair is short: the plane of the skin says
            // it.
            _ => ((next - start).dot(normal), normal),
        };
        let least = margin * (4.0 * t).min(1.0) + lift * (3.0 * t).min(1.0);
        next += outward * (least - distance.min(distance * DEEPER)).max(0.0);
        // Deep inside, the direction outward is inexact: once more from the new place.
        let again = (-distance / margin - 1.0).clamp(0.0, 1.0);
        if again > 0.0 && root.region == Region::Scalp {
            let (from_there, direction) = seek(next);
            next += direction * ((least - from_there).max(0.0) * again);
            distance += (from_there - distance) * again;
            outward = (outward + (direction - outward) * again).normalize_or(outward);
        }
        // Pushed back, the segment keeps its length by what leads along the skin: as far out as it is, it has
        // to stay. It may get shorter, since at its full length it would be inside again.
        let out = outward * (next - before).dot(outward);
        let along = next - before - out;
        let left = (step * step - out.length_squared()).max(0.0) / along.length_squared().max(1e-30);
        let segment = out + along * left.min(1.0).sqrt();
        direction = segment.normalize_or(direction);
        before += direction * step.min(segment.length());
        phase = turn.rotate(phase);
        let side = direction.cross(beside).normalize_or(normal);
        points[i] = before + (beside * phase.x + side * phase.y) * (radius * (3.0 * t).min(1.0));
        skin_normal = outward;
        near = (1.0 - (distance - least) / (COMBED_REACH * groom.height())).clamp(0.0, 1.0);
    }
    Some(points)
}

/// Length of the segment before a point, as a share of what the first one leaves: longer toward the tip,
/// because strands bend most where they leave the skin.
pub(crate) fn step_share(point: usize) -> f32 {
    (point + 1) as f32 / STEP_SUM as f32
}

/// Sum of `point + 1` over the points from 2 to the last.
pub const STEP_SUM: u32 = ((SEGMENTS * (SEGMENTS + 1)) / 2 - 1 + (SEGMENTS - 1)) as u32;

/// How far bones take a point of the head's bind pose from where another bone has it at bind pose: a map to
/// what is to be added to the point. Nothing, where both move alike.
pub fn offset_from_head(head: Affine3A, other: Affine3A) -> Affine3A {
    let Affine3A { matrix3, translation } = rigid_inverse(other) * head;
    Affine3A { matrix3: matrix3 - Mat3A::IDENTITY, translation }
}

fn rigid_inverse(bone: Affine3A) -> Affine3A {
    let rotation = bone.matrix3.transpose();
    Affine3A { matrix3: rotation, translation: -(rotation * bone.translation) }
}

/// The frame of a triangle.
pub(crate) fn axes([a, b, c]: [Vec3; 3]) -> [Vec3; 3] {
    let x = (b - a).normalize_or(Vec3::X);
    let z = x.cross(c - a).normalize_or(Vec3::Z);
    [x, z.cross(x), z]
}

/// Short strands do not reach around a whole curl.
pub(crate) fn curl_radius(style: &RegionStyle, height: f32, length: f32) -> f32 {
    (style.curl_radius * height).min(CURL_SHARE * length)
}
