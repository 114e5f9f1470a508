//! Plants hair: where strands grow, how long they are, which strand each follows.

use crate::grow::{axes, curl_radius, grow_to};
use crate::random::unit;
use crate::roots::scatter_on;
use crate::{
    DensityMap, Field, Groom, PlantedStrand, Region, Root, SEGMENTS, Strand, Style, Triangle, guides,
};
use avatar_mesh::{Bounds, Mesh};
use glam::{Affine3A, Vec2, Vec3};
use std::collections::BTreeMap;

/// Strands of one lock curl together; their curls begin within this share of a turn of each other.
const PHASE_SPREAD: f32 = 0.12;
/// Where the cut is not quite even, as a fraction of the length.
const CUT_SPREAD: f32 = 0.05;
/// Densities between which strands grow to their full length and thickness, and what shares of these the
/// first ones have: hairlines begin with fine hair.
const HAIRLINE: [f32; 2] = [0.1, 0.85];
const HAIRLINE_LENGTH: f32 = 0.3;
const HAIRLINE_THICKNESS: f32 = 0.2;
/// Where the parting ends and hair falls all around: the crown, as a share of the head's depth from its back.
const CROWN: f32 = 0.36;
/// How far before the crown the hairline is combed in its own way, as a share of the head's depth.
const TEMPLE: f32 = 0.15;
/// How deep in a crease, as behind an ear, hair may grow, in cells of the field: further in, strands would
/// have to go through the walls.
const DEEPEST_ROOT: f32 = 1.0;
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
        let crown = bounds.min.z + CROWN * bounds.size().z;
        let mut roots = scatter_on(skin, bounds, density, eyes, &style, strands, seed);
        let head_bone = head_bone(skin, &roots);
        let field = Field::around(skin, bounds, head_bone);
        roots.retain(|root| has_room(&field, root, position(skin, root)));
        let positions: Vec<Vec3> = roots.iter().map(|root| position(skin, root)).collect();
        let parting = middle + style.scalp.parting * height;
        let guides = guides::choose(&roots);
        let side = |p: Vec3| match p {
            _ if p.z <= crown => 0.0,
            _ if p.x < parting => -1.0,
            _ => 1.0,
        };
        let guide_of = guides::assign(&roots, &positions, &guides, side);
        let comber = Comber {
            skin,
            eyes,
            style: &style,
            parting: Vec3::new(parting, 0.0, crown),
            middle,
            depth: bounds.size().z.max(1e-6),
        };
        let planted = |(strand, (root, guide)): (usize, (Root, Option<u32>))| {
            let grown = grown(skin, density, &root);
            PlantedStrand {
                comb: comber.comb(&root, grown),
                length: length(&root, &style, height) * (HAIRLINE_LENGTH + (1.0 - HAIRLINE_LENGTH) * grown),
                thickness: HAIRLINE_THICKNESS + (1.0 - HAIRLINE_THICKNESS) * grown,
                phase: phase(strand, guide.and_then(|guide| guides.get(guide as usize)), seed),
                guide,
                root,
            }
        };
        let mut groom = Self {
            strands: roots.into_iter().zip(guide_of).enumerate().map(planted).collect(),
            field,
            head_bone,
            strands_per_square: strands,
            guides,
            style,
            height,
            top: None,
        };
        groom.cut(skin, bounds.min.y);
        groom.top = groom.highest(skin);
        groom
    }

    /// The highest point of the guides at bind pose, and above it the curls.
    fn highest(&self, skin: &Mesh) -> Option<f32> {
        let tops = self.guides.iter().filter_map(|guide| {
            let strand = self.strands.get(*guide as usize)?;
            let points = self.at_bind(skin, *guide as usize, strand.length)?;
            let curl = curl_radius(&self.style.scalp, self.height, strand.length);
            Some(curl + points.iter().fold(f32::MIN, |top, point| top.max(point.y)))
        });
        tops.reduce(f32::max)
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

    /// The middle line of a strand at bind pose, if it had this length.
    fn at_bind(&self, skin: &Mesh, strand: usize, length: f32) -> Option<Strand> {
        let root = &self.strands.get(strand)?.root;
        let of = |all: &[Vec3], i: usize| all.get(root.corners[i] as usize).copied().unwrap_or(Vec3::Y);
        let triangle = Triangle {
            positions: [0, 1, 2].map(|i| of(&skin.positions, i)),
            normals: [0, 1, 2].map(|i| of(&skin.normals, i)),
        };
        let bones = vec![Affine3A::IDENTITY; self.head_bone as usize + 1];
        grow_to(self, strand, length, &triangle, &bones, None, None)
    }

    /// The length at which a strand ends at a height at bind pose, or the style's if it does not reach that
    /// low. A strand bends from point to point, so that a shorter one lies otherwise: the length is sought,
    /// not measured.
    fn length_to(&self, skin: &Mesh, strand: usize, height: f32) -> f32 {
        let Some(PlantedStrand { root, .. }) = self.strands.get(strand) else { return 0.0 };
        let reaches = |length: f32| {
            self.at_bind(skin, strand, length).is_some_and(|points| points[SEGMENTS].y < height)
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

fn length(root: &Root, style: &Style, height: f32) -> f32 {
    let variation = style.region(root.region).length_variation;
    length_without_variation(root, style, height) * (1.0 - variation * root.random[0])
}

/// Whether a strand of the scalp can leave the crease that it grows in.
fn has_room(field: &Field, root: &Root, place: Vec3) -> bool {
    root.region != Region::Scalp || field.at(place).distance > -DEEPEST_ROOT * field.cell
}

/// How far hair has come into its own at a root: 0 where it begins, 1 where the map is dense.
fn grown(skin: &Mesh, density: &DensityMap, root: &Root) -> f32 {
    let uv = |i: usize| skin.uvs.get(root.corners[i] as usize).copied().unwrap_or(Vec2::ZERO);
    match root.region {
        Region::Scalp => {
            let thick = density.at((0..3).map(|i| uv(i) * root.barycentric[i]).sum());
            let begun = ((thick - HAIRLINE[0]) / (HAIRLINE[1] - HAIRLINE[0])).clamp(0.0, 1.0);
            begun * begun
        }
        _ => 1.0,
    }
}

fn position(skin: &Mesh, root: &Root) -> Vec3 {
    let corner = |i: usize| skin.positions.get(root.corners[i] as usize).copied().unwrap_or(Vec3::ZERO);
    (0..3).map(|i| corner(i) * root.barycentric[i]).sum()
}

/// What says where strands are combed.
struct Comber<'a> {
    skin: &'a Mesh,
    eyes: &'a [Bounds],
    style: &'a Style,
    /// Where the parting ends.
    parting: Vec3,
    middle: f32,
    depth: f32,
}

impl Comber<'_> {
    /// Where a strand is combed, in the frame of its triangle; `grown` says how far it is from the hairline.
    fn comb(&self, root: &Root, grown: f32) -> Vec3 {
        let region = self.style.region(root.region);
        let place = position(self.skin, root);
        let off = place - self.parting;
        let along = |[away, up, forward]: [f32; 3], aside: Vec3| aside * away + Vec3::new(0.0, up, forward);
        let mut bind = if root.region == Region::Scalp {
            // Before the crown away from the parting on both sides, behind it all around. A jump at the
            // parting is what makes it one.
            let aside = Vec3::new(off.x, 0.0, off.z.min(0.0)).normalize_or(Vec3::X);
            // What grows above the forehead would fall over the eyes.
            let square = (off.z / ((1.0 - CROWN) * self.depth)).clamp(0.0, 1.0).powi(2);
            let edge = ((1.0 - grown) * (off.z / (TEMPLE * self.depth)).clamp(0.0, 1.0)).max(square * square);
            along(region.comb, aside).lerp(along(region.edge, aside), edge)
        } else {
            along(region.comb, Vec3::X * if place.x < self.middle { -1.0 } else { 1.0 })
        };
        // Lashes of lower lids are the mirror of those above the eye.
        let nearer = |a: &Vec3, b: &Vec3| a.distance(place).total_cmp(&b.distance(place));
        let eye = self.eyes.iter().map(|eye| eye.center()).min_by(nearer);
        let is_lower = root.region == Region::Lashes && eye.is_some_and(|eye| place.y < eye.y);
        if is_lower {
            bind.y = -bind.y;
        }
        let corner =
            |i: usize| self.skin.positions.get(root.corners[i] as usize).copied().unwrap_or(Vec3::ZERO);
        let [x, y, z] = axes([corner(0), corner(1), corner(2)]);
        Vec3::new(bind.dot(x), bind.dot(y), bind.dot(z))
    }
}
