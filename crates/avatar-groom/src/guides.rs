use crate::{Region, Root};
use glam::Vec3;
use std::collections::BTreeMap;

/// Most guides that a head has.
const MOST: usize = 1024;
/// A guide leads at least so many strands.
const STRANDS_PER_GUIDE: usize = 12;

/// Which strands lead others. Roots come in random order: the first ones of the scalp are a fair sample of
/// it.
pub(crate) fn choose(roots: &[Root]) -> Vec<u32> {
    let on_scalp = (0u32..).zip(roots).filter(|(_, root)| root.region == Region::Scalp);
    let strands = on_scalp.clone().count();
    on_scalp.map(|(strand, _)| strand).take((strands / STRANDS_PER_GUIDE).min(MOST)).collect()
}

/// For each strand of the scalp the number of the nearest guide. Strands on one side of the parting follow no
/// guide on the other one. `side` says which side a place is on: −1 or 1, and 0 behind the parting's end.
pub(crate) fn assign(
    roots: &[Root],
    positions: &[Vec3],
    guides: &[u32],
    side: impl Fn(Vec3) -> f32,
) -> Vec<Option<u32>> {
    // Places on the other side are moved far away, so that none of them is the nearest.
    let extent = positions.iter().fold(0.0f32, |most, p| most.max(p.abs().max_element()));
    let apart = |p: Vec3| p + Vec3::X * (8.0 * extent * side(p));
    let places: Vec<Vec3> =
        guides.iter().filter_map(|guide| positions.get(*guide as usize)).map(|p| apart(*p)).collect();
    let cells = Cells::new(&places, extent);
    let nearest = |(root, position): (&Root, &Vec3)| match root.region {
        Region::Scalp => cells.nearest(&places, apart(*position)),
        _ => None,
    };
    roots.iter().zip(positions).map(nearest).collect()
}

/// Places by the cube that they are in.
struct Cells {
    size: f32,
    rings: i32,
    members: BTreeMap<[i32; 3], Vec<u32>>,
}

impl Cells {
    fn new(places: &[Vec3], extent: f32) -> Self {
        // On a surface, a few of N places in each cube that it crosses.
        let size = (3.0 * extent / (places.len().max(1) as f32).sqrt()).max(1e-9);
        let mut cells = Self { size, rings: (64.0 * extent / size) as i32, members: BTreeMap::new() };
        for (number, place) in (0u32..).zip(places) {
            cells.members.entry(cells.cell(*place)).or_default().push(number);
        }
        cells
    }

    fn cell(&self, place: Vec3) -> [i32; 3] {
        (place / self.size).floor().to_array().map(|v| v as i32)
    }

    fn nearest(&self, places: &[Vec3], place: Vec3) -> Option<u32> {
        let [x, y, z] = self.cell(place);
        let mut best = (f32::INFINITY, None);
        for ring in 0..=self.rings {
            // Everything in a further ring is further away than this.
            if best.0 <= (ring - 1).max(0) as f32 * self.size {
                break;
            }
            for [dx, dy, dz] in shell(ring) {
                for &number in self.members.get(&[x + dx, y + dy, z + dz]).into_iter().flatten() {
                    let distance = places[number as usize].distance(place);
                    // Of two at the same distance the one with the smaller number.
                    let is_nearer = match best {
                        (least, Some(other)) => (distance, number) < (least, other),
                        (least, None) => distance <= least,
                    };
                    if is_nearer {
                        best = (distance, Some(number));
                    }
                }
            }
        }
        best.1
    }
}

/// The cubes around the middle one at a distance.
fn shell(ring: i32) -> impl Iterator<Item = [i32; 3]> {
    let all = move || -ring..=ring;
    all().flat_map(move |z| all().map(move |y| (y, z))).flat_map(move |(y, z)| {
        // Inside of the shell only its two walls.
        let wall = y.abs() == ring || z.abs() == ring;
        let step = if wall || ring == 0 { 1 } else { 2 * ring };
        (-ring..=ring).step_by(step as usize).map(move |x| [x, y, z])
    })
}
