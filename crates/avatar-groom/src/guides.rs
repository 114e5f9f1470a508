use crate::{Region, Root};
use glam::Vec3;

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

/// The number of a cube along each axis.
type Cube = [i64; 3];

/// Places by the cube that they are in.
struct Cells {
    size: f32,
    rings: i32,
    /// The lowest cube, and how many there are along each axis.
    lowest: Cube,
    counts: Cube,
    /// Where the members of each cube end; they begin where those of the one before it end.
    ends: Vec<u32>,
    members: Vec<u32>,
}

/// The most cubes for a place; where there would be more, cubes are larger.
const MOST_CUBES: i64 = 128;

/// The cube of this size that a place is in.
fn cube(place: Vec3, size: f32) -> Cube {
    // Numbers that are too large for 32 bits end there.
    (place / size).floor().to_array().map(|v| i64::from(v as i32))
}

impl Cells {
    fn new(places: &[Vec3], extent: f32) -> Self {
        // On a surface, a few of N places in each cube that it crosses.
        let mut size = (3.0 * extent / (places.len().max(1) as f32).sqrt()).max(1e-9);
        let (lowest, counts) = loop {
            let cubes = || places.iter().map(|place| cube(*place, size));
            let both = |one: fn(i64, i64) -> i64| {
                let along = move |a: Cube, b: Cube| [0, 1, 2].map(|axis| one(a[axis], b[axis]));
                cubes().reduce(along).unwrap_or([0; 3])
            };
            let (lowest, highest) = (both(i64::min), both(i64::max));
            let counts = [0, 1, 2].map(|axis| highest[axis] - lowest[axis] + 1);
            let product = counts.iter().fold(1i64, |product, count| product.saturating_mul(*count));
            // Cubes without end hold everything.
            if product <= MOST_CUBES * (places.len() as i64 + 1) {
                break (lowest, counts);
            }
            size *= 2.0;
        };
        let rings = (64.0 * extent / size) as i32;
        let mut cells = Self { size, rings, lowest, counts, ends: Vec::new(), members: Vec::new() };
        let mut all: Vec<(usize, u32)> = (0u32..)
            .zip(places)
            .filter_map(|(number, place)| Some((cells.index(cube(*place, size))?, number)))
            .collect();
        all.sort_unstable();
        cells.ends = vec![0; counts.iter().product::<i64>() as usize];
        all.iter().for_each(|(cube, _)| cells.ends[*cube] += 1);
        let mut end = 0;
        cells.ends.iter_mut().for_each(|count| {
            end += *count;
            *count = end;
        });
        cells.members = all.into_iter().map(|(_, number)| number).collect();
        cells
    }

    /// Where a cube stands in the list, if there may be places in it.
    fn index(&self, cube: Cube) -> Option<usize> {
        let at = [0, 1, 2].map(|axis| cube[axis] - self.lowest[axis]);
        let is_inside = (0..3).all(|axis| (0..self.counts[axis]).contains(&at[axis]));
        is_inside.then(|| ((at[2] * self.counts[1] + at[1]) * self.counts[0] + at[0]) as usize)
    }

    fn members(&self, cube: Cube) -> &[u32] {
        let Some(index) = self.index(cube) else { return &[] };
        let begin = index.checked_sub(1).map_or(0, |before| self.ends[before]);
        self.members.get(begin as usize..self.ends[index] as usize).unwrap_or_default()
    }

    fn nearest(&self, places: &[Vec3], place: Vec3) -> Option<u32> {
        let middle = cube(place, self.size);
        let low = Vec3::from_array(middle.map(|v| v as f32)) * self.size;
        // How far it is to the cubes below and above, along each axis, less what rounding may add.
        let slack = 1e-3 * self.size + 1e-5 * place.abs().max_element();
        let (below, above) = (place - low - slack, low + self.size - place - slack);
        let mut best = (f32::INFINITY, None);
        for ring in 0..=self.rings {
            // Everything in a further ring is further away than this.
            if best.0 <= (ring - 1).max(0) as f32 * self.size {
                break;
            }
            for offset in shell(ring) {
                let apart = |axis: usize| match offset[axis] {
                    0 => 0.0,
                    steps @ ..0 => (below[axis] - (steps + 1) as f32 * self.size).max(0.0),
                    steps => (above[axis] + (steps - 1) as f32 * self.size).max(0.0),
                };
                let apart = Vec3::new(apart(0), apart(1), apart(2));
                if apart.length_squared() > best.0 * best.0 {
                    continue;
                }
                let beside = [0, 1, 2].map(|axis| middle[axis] + i64::from(offset[axis]));
                for &number in self.members(beside) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::unit;

    #[test]
    fn the_nearest_of_all_is_found_and_of_equals_the_first() {
        for round in 0..20u64 {
            // Places on a coarse grid: many lie at one place, or at the same distance.
            let step = [0.05, 0.25, 1.0][round as usize % 3];
            let vector = |number: u64| Vec3::from([0, 1, 2].map(|axis| unit(round, 3 * number + axis) - 0.5));
            let place = |number: u64| (vector(number) * 4.0 / step).round() * step;
            let places: Vec<Vec3> = (0..400).map(place).collect();
            let cells = Cells::new(&places, 2.0);
            for number in 1000..1300 {
                // Some of them on the grid as well, some beside it, some far away.
                let at = [place(number), 4.0 * vector(number), 8.0 * vector(number)][number as usize % 3];
                let mut all: Vec<(f32, u32)> = (0..).zip(&places).map(|(i, p)| (p.distance(at), i)).collect();
                all.sort_by(|a, b| a.partial_cmp(b).unwrap());
                assert_eq!(cells.nearest(&places, at), Some(all[0].1), "{at} {step}");
            }
        }
    }
}
