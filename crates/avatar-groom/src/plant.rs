//! Plants hair: where strands grow, how long they are, which strand each follows.

use crate::grow::{axes, grow_to};
use crate::random::unit;
use crate::roots::scatter_on;
use crate::{DensityMap, Field, Groom, PlantedStrand, Region, Root, SEGMENTS, Style, Triangle, guides};
use avatar_mesh::{Bounds, Mesh};
use glam::{Affine3A, Vec2, Vec3};
use std::collections::BTreeMap;

/// Strands of one lock curl together; their curls begin within this share of a turn of each other.
const PHASE_SPREAD: f32 = 0.12;
/// Where the cut is not quite even, as a fraction of the length.
const CUT_SPREAD: f32 = 0.05;
/// Densities between which strands grow to their full length, and what share of it the first ones have.
const HAIRLINE: [f32; 2] = [0.4, 0.85];
const HAIRLINE_LENGTH: f32 = 0.08;
/// How often the length to the cut is halved.
const CUT_STEPS: usize = 9;

impl Groom {
    /// Plants hair on a skin that is a head and no more; see [`crate::scatter`] for the arguments.
    pub fn new(
        skin: &Mesh,
        density: &DensityMap,
        eyes: &[Bounds],
        style: Style,
        strands: f32,
        seed: u64,
    ) -> Self {
        Self::on_head(skin, skin.bounds(), density, eyes, style, strands, seed)
    }

    /// As [`Groom::new`], on a skin of which only `head` is the head: its height is the unit of lengths, and
    /// cuts are measured from its lower end.
    pub fn on_head(
        skin: &Mesh,
        head: Option<Bounds>,
        density: &DensityMap,
        eyes: &[Bounds],
        style: Style,
        strands: f32,
        seed: u64,
    ) -> Self {
        let bounds = head.unwrap_or(Bounds { min: Vec3::ZERO, max: Vec3::ONE });
        let height = bounds.size().y.max(1e-6);
        let middle = (bounds.min.x + bounds.max.x) * 0.5;
        let roots = scatter_on(skin, bounds, density, eyes, &style, strands, seed);
        let positions: Vec<Vec3> = roots.iter().map(|root| position(skin, root)).collect();
        let parting = middle + style.scalp.parting * height;
        let guides = guides::choose(&roots);
        let guide_of = guides::assign(&roots, &positions, &guides, |p| p.x < parting);
        let head_bone = head_bone(skin, &roots);
        let planted = |(strand, (root, guide)): (usize, (Root, Option<u32>))| PlantedStrand {
            comb: comb(skin, &root, eyes, &style, middle, height),
            length: length(skin, density, &root, &style, height),
            phase: phase(strand, guide.and_then(|guide| guides.get(guide as usize)), seed),
            guide,
            root,
        };
        let mut groom = Self {
            strands: roots.into_iter().zip(guide_of).enumerate().map(planted).collect(),
            field: Field::around(skin, bounds, head_bone),
            head_bone,
            strands_per_square: strands,
            guides,
            style,
            height,
        };
        groom.cut(skin, bounds.min.y);
        groom
    }

    /// Shortens what would hang below the cut at bind pose, lock by lock: hair has one length in all poses.
    fn cut(&mut self, skin: &Mesh, lowest: f32) {
        let height = lowest + self.style.scalp.cut * self.height;
        let lengths: Vec<f32> =
            (self.guides.iter()).map(|&guide| self.length_to(skin, guide as usize, height)).collect();
        for strand in &mut self.strands {
            let Some(length) = strand.guide.and_then(|guide| lengths.get(guide as usize)) else { continue };
            // The strand's own may be shorter already.
            let uneven = length * (1.0 - CUT_SPREAD * strand.root.random[0]);
            strand.length = strand.length.min(uneven);
        }
    }

    /// The length at which a strand ends at a height at bind pose, or the style's if it does not reach that
    /// low. A strand bends from point to point, so that a shorter one lies otherwise: the length is sought,
    /// not measured.
    fn length_to(&self, skin: &Mesh, strand: usize, height: f32) -> f32 {
        let Some(PlantedStrand { root, .. }) = self.strands.get(strand) else { return 0.0 };
        let corner = |i: usize| root.corners[i] as usize;
        let of = |all: &[Vec3], i: usize| all.get(corner(i)).copied().unwrap_or(Vec3::Y);
        let triangle = Triangle {
            positions: [0, 1, 2].map(|i| of(&skin.positions, i)),
            normals: [0, 1, 2].map(|i| of(&skin.normals, i)),
        };
        let at_bind = vec![Affine3A::IDENTITY; self.head_bone as usize + 1];
        let reaches = |length: f32| {
            let points = grow_to(self, strand, length, &triangle, &at_bind, None, None);
            points.is_some_and(|points| points[SEGMENTS].y < height)
        };
        let whole = length_without_variation(root, &self.style, self.height);
        if !reaches(whole) {
            return whole;
        }
        let (mut above, mut below) = (0.0, whole);
        for _ in 0..CUT_STEPS {
            let middle = (above + below) * 0.5;
            *(if reaches(middle) { &mut below } else { &mut above }) = middle;
        }
        above
    }
}

/// Where the curls of a strand begin: those of a lock begin alike. `guide` is the strand that it follows.
fn phase(strand: usize, guide: Option<&u32>, seed: u64) -> f32 {
    let turn = |strand: usize| unit(seed ^ 0xC0A1, strand as u64);
    let of_lock = guide.map_or(0.0, |guide| turn(*guide as usize));
    let own = if guide.is_some() { PHASE_SPREAD * (turn(strand) - 0.5) } else { turn(strand) };
    // Within half a turn, where the GPU's cosines are exact enough.
    let turns = of_lock + own;
    std::f32::consts::TAU * (turns - turns.round())
}

/// The bone that moves most of the hair.
fn head_bone(skin: &Mesh, roots: &[Root]) -> u32 {
    let Some(skinning) = &skin.skinning else { return 0 };
    let mut weights: BTreeMap<u16, f32> = BTreeMap::new();
    for vertex in roots.iter().map(|root| root.corners[0] as usize) {
        for (bone, share) in skinning.influences(vertex) {
            *weights.entry(bone).or_default() += share;
        }
    }
    let most = weights.into_iter().max_by(|(_, a), (_, b)| a.total_cmp(b));
    most.map_or(0, |(bone, _)| u32::from(bone))
}

fn length_without_variation(root: &Root, style: &Style, height: f32) -> f32 {
    style.region(root.region).length * height
}

fn length(skin: &Mesh, density: &DensityMap, root: &Root, style: &Style, height: f32) -> f32 {
    let variation = style.region(root.region).length_variation;
    let uv = |i: usize| skin.uvs.get(root.corners[i] as usize).copied().unwrap_or(Vec2::ZERO);
    let thick = match root.region {
        Region::Scalp => density.at((0..3).map(|i| uv(i) * root.barycentric[i]).sum()),
        _ => 1.0,
    };
    // Where hair begins it is thin and short.
    let begun = ((thick - HAIRLINE[0]) / (HAIRLINE[1] - HAIRLINE[0])).clamp(0.0, 1.0);
    let share = HAIRLINE_LENGTH + (1.0 - HAIRLINE_LENGTH) * begun * begun;
    length_without_variation(root, style, height) * (1.0 - variation * root.random[0]) * share
}

fn position(skin: &Mesh, root: &Root) -> Vec3 {
    let corner = |i: usize| skin.positions.get(root.corners[i] as usize).copied().unwrap_or(Vec3::ZERO);
    (0..3).map(|i| corner(i) * root.barycentric[i]).sum()
}

/// Where a strand is combed, in the frame of its triangle.
fn comb(skin: &Mesh, root: &Root, eyes: &[Bounds], style: &Style, middle: f32, height: f32) -> Vec3 {
    let region = style.region(root.region);
    let place = position(skin, root);
    let x = place.x - middle - if root.region == Region::Scalp { region.parting * height } else { 0.0 };
    // Away from the parting on both sides, without a jump at it.
    let side = (x / (0.004 * height)).clamp(-1.0, 1.0);
    let [away, up, forward] = region.comb;
    // Lashes of lower lids are the mirror of those above the eye.
    let eye =
        eyes.iter().map(|eye| eye.center()).min_by(|a, b| a.distance(place).total_cmp(&b.distance(place)));
    let is_lower = root.region == Region::Lashes && eye.is_some_and(|eye| place.y < eye.y);
    let up = if is_lower { -up } else { up };
    let bind = Vec3::new(away * side, up, forward);
    let corner = |i: usize| skin.positions.get(root.corners[i] as usize).copied().unwrap_or(Vec3::ZERO);
    let [x, y, z] = axes([corner(0), corner(1), corner(2)]);
    Vec3::new(bind.dot(x), bind.dot(y), bind.dot(z))
}
