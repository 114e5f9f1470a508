use crate::{Mesh, Offsets, Shape, Skinning};
use bytemuck::NoUninit;
use glam::{DVec3, Vec3};
use std::collections::HashMap;
use std::hash::{BuildHasher, BuildHasherDefault, Hash, Hasher, RandomState};

/// A mesh without repeated vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Welded {
    /// The mesh; triangles keep their order.
    pub mesh: Mesh,
    /// For each vertex of the original its vertex in [`Welded::mesh`].
    pub welded_from_original: Vec<u32>,
}

/// Merges vertices that are alike, to the bit, in every attribute that deformation and drawing use: the
/// welded mesh deforms and draws exactly as the original does. Of [`Skinning::blend_index`], which nothing
/// uses, each merged vertex keeps the first. Vertices keep the order of their first appearance.
pub fn weld(mesh: &Mesh) -> Welded {
    merged(mesh).of(mesh)
}

/// As [`weld`]; `None` where no two vertices are alike, which costs no copy of the mesh.
pub fn weld_repeated(mesh: &Mesh) -> Option<Welded> {
    let merged = merged(mesh);
    (merged.originals.len() < mesh.positions.len()).then(|| merged.of(mesh))
}

/// The first of all vertices that are alike, in order, and for each vertex which of these it becomes.
struct Merged {
    originals: Vec<usize>,
    welded_from_original: Vec<u32>,
}

impl Merged {
    fn of(self, mesh: &Mesh) -> Welded {
        let Self { originals, welded_from_original } = self;
        let triangles = mesh.triangles.iter().map(|t| t.map(|i| renamed(&welded_from_original, i))).collect();
        Welded { mesh: picked(mesh, &originals, triangles), welded_from_original }
    }
}

fn merged(mesh: &Mesh) -> Merged {
    let alike = Alike::new(mesh);
    let hashes = alike.hashes(mesh.positions.len());
    let mut first_of: HashMap<Vertex<'_>, u32, BuildHasherDefault<Known>> =
        HashMap::with_capacity_and_hasher(mesh.positions.len(), BuildHasherDefault::default());
    let mut originals = Vec::new();
    let mut welded_from_original = Vec::with_capacity(mesh.positions.len());
    for (vertex, hash) in hashes.into_iter().enumerate() {
        let next = originals.len() as u32;
        let welded = *first_of.entry(Vertex { alike: &alike, vertex, hash }).or_insert(next);
        if welded == next {
            originals.push(vertex);
        }
        welded_from_original.push(welded);
    }
    Merged { originals, welded_from_original }
}

/// The mesh of these vertices, which ascend, with all that they carry, and with other triangles.
pub(crate) fn picked(mesh: &Mesh, originals: &[usize], triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh {
        positions: pick(&mesh.positions, originals),
        uvs: pick(&mesh.uvs, originals),
        uvs_1: pick(&mesh.uvs_1, originals),
        colors: pick(&mesh.colors, originals),
        normals: pick(&mesh.normals, originals),
        tangents: pick(&mesh.tangents, originals),
        triangles,
        skinning: mesh.skinning.as_ref().map(|skinning| Skinning {
            bones: pick(&skinning.bones, originals),
            weights: pick(&skinning.weights, originals),
            more_bones: pick(&skinning.more_bones, originals),
            more_weights: pick(&skinning.more_weights, originals),
            blend_index: pick(&skinning.blend_index, originals),
        }),
        shapes: (mesh.shapes.iter())
            .map(|shape| Shape {
                name: shape.name.clone(),
                positions: pick_offsets(&shape.positions, originals),
                normals: shape.normals.as_ref().map(|offsets| pick_offsets(offsets, originals)),
                tangents: shape.tangents.as_ref().map(|offsets| pick_offsets(offsets, originals)),
            })
            .collect(),
    }
}

fn renamed(welded_from_original: &[u32], vertex: u32) -> u32 {
    welded_from_original.get(vertex as usize).copied().unwrap_or(vertex)
}

fn pick<T: Copy>(values: &[T], originals: &[usize]) -> Vec<T> {
    if let Some(last) = originals.last()
        && *last < values.len()
    {
        // They ascend: all are there.
        return originals.iter().map(|&original| values[original]).collect();
    }
    originals.iter().filter_map(|&original| values.get(original).copied()).collect()
}

fn pick_offsets(offsets: &Offsets, originals: &[usize]) -> Offsets {
    if !offsets.is_sparse() {
        return pick(offsets.stored(), originals).into();
    }
    originals.iter().filter_map(|&original| offsets.get(original)).collect()
}

/// What vertices must have in common to become one.
struct Alike<'a> {
    /// Of each array its bytes, and how many each vertex has.
    columns: Vec<(&'a [u8], usize)>,
    /// Offsets that are stored for some vertices only.
    sparse: Vec<&'a Offsets>,
}

impl<'a> Alike<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        fn column<T: NoUninit>(values: &[T]) -> (&[u8], usize) {
            (bytemuck::cast_slice(values), size_of::<T>())
        }
        let mut columns = vec![
            column(&mesh.positions),
            column(&mesh.normals),
            column(&mesh.uvs),
            column(&mesh.uvs_1),
            column(&mesh.colors),
            column(&mesh.tangents),
        ];
        if let Some(skinning) = &mesh.skinning {
            columns.extend([column(&skinning.bones), column(&skinning.weights)]);
            columns.extend([column(&skinning.more_bones), column(&skinning.more_weights)]);
        }
        let offsets = mesh.shapes.iter().flat_map(Shape::arrays).map(|(_, offsets)| offsets);
        let (sparse, dense): (Vec<&Offsets>, Vec<&Offsets>) = offsets.partition(|one| one.is_sparse());
        columns.extend(dense.into_iter().map(|offsets| column(offsets.stored())));
        Self { columns, sparse }
    }

    /// Equal for vertices that are alike, and with keys that nobody who writes a file can know.
    fn hashes(&self, vertices: usize) -> Vec<u64> {
        let random = RandomState::new();
        let (start, key) = (random.hash_one(0), random.hash_one(1) | 1);
        let mix = |hash: u64, word: u64| {
            let product = u128::from(hash ^ word) * u128::from(key);
            (product as u64) ^ (product >> 64) as u64 ^ hash.rotate_left(23)
        };
        let mut hashes = vec![start; vertices];
        for (bytes, each) in &self.columns {
            for (hash, bytes) in hashes.iter_mut().zip(bytes.chunks_exact(*each)) {
                let (words, rest) = bytes.as_chunks::<8>();
                *hash = words.iter().fold(*hash, |hash, word| mix(hash, u64::from_le_bytes(*word)));
                if let Some(half) = rest.first_chunk::<4>() {
                    *hash = mix(*hash, u64::from(u32::from_le_bytes(*half)));
                }
            }
        }
        for (number, offsets) in (1..).zip(&self.sparse) {
            for (vertex, offset) in offsets.iter() {
                if let Some(hash) = hashes.get_mut(vertex) {
                    let bits = offset.to_array().map(f32::to_bits);
                    *hash = bits.into_iter().fold(mix(*hash, number), |hash, x| mix(hash, x.into()));
                }
            }
        }
        hashes
    }

    fn are(&self, a: usize, b: usize) -> bool {
        let same_bytes = |(bytes, each): &(&[u8], usize)| {
            let of = |vertex: usize| bytes.get(vertex * each..(vertex + 1) * each);
            of(a) == of(b)
        };
        let bits = |offsets: &Offsets, vertex| offsets.get(vertex).map(|d| d.to_array().map(f32::to_bits));
        self.columns.iter().all(same_bytes)
            && self.sparse.iter().all(|offsets| bits(offsets, a) == bits(offsets, b))
    }
}

/// A key of vertices that are alike.
struct Vertex<'a> {
    alike: &'a Alike<'a>,
    vertex: usize,
    hash: u64,
}

impl PartialEq for Vertex<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.hash == other.hash && self.alike.are(self.vertex, other.vertex)
    }
}

impl Eq for Vertex<'_> {}

impl Hash for Vertex<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u64(self.hash);
    }
}

/// Takes the hash that a [`Vertex`] knows.
#[derive(Default)]
struct Known(u64);

impl Hasher for Known {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write_u64(&mut self, hash: u64) {
        self.0 = hash;
    }

    fn write(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |hash, byte| hash.rotate_left(8) ^ u64::from(*byte));
    }
}

/// Gives points that are within `tolerance` of each other (along chains, too) one number, counted from 0 in
/// the order of first appearance: the topology under vertices that were split for uvs or normals.
pub fn weld_positions(positions: &[Vec3], tolerance: f32) -> Vec<u32> {
    if tolerance == 0.0 {
        return weld_equal(positions);
    }
    // Not much finer than the coordinates: their cell numbers would leave i64 and fall into one cell.
    let extent = positions.iter().map(|p| p.abs().max_element()).fold(0.0f32, f32::max);
    let finest = f64::from(extent.min(f32::MAX)) / (1u64 << 40) as f64;
    let cell_size = (f64::from(tolerance) * 2.5).max(finest).max(f64::MIN_POSITIVE);
    let cell_of = |p: DVec3| (p / cell_size).floor().to_array().map(|x| x as i64);
    // A little more than the tolerance, for the rounding of the division. Cells are wider than twice that, so
    // that what a point can reach lies in two of them along each axis, often in one.
    let reach = DVec3::splat(f64::from(tolerance).max(0.0) + cell_size * 1e-3);
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut roots: Vec<u32> = (0..positions.len() as u32).collect();
    for (vertex, &position) in positions.iter().enumerate() {
        let position = position.as_dvec3();
        let ([x0, y0, z0], [x1, y1, z1]) = (cell_of(position - reach), cell_of(position + reach));
        let rows = (x0..=x1).flat_map(|x| (y0..=y1).map(move |y| (x, y)));
        for key in rows.flat_map(|(x, y)| (z0..=z1).map(move |z| [x, y, z])) {
            for &other in cells.get(&key).map_or(&[][..], Vec::as_slice) {
                // In f64, where squares of small differences do not vanish.
                if positions[other as usize].as_dvec3().distance(position) <= f64::from(tolerance) {
                    let (a, b) = (root(&mut roots, other), root(&mut roots, vertex as u32));
                    roots[a.max(b) as usize] = a.min(b);
                }
            }
        }
        cells.entry(cell_of(position)).or_default().push(vertex as u32);
    }
    let mut numbers = HashMap::new();
    (0..positions.len() as u32)
        .map(|vertex| {
            let next = numbers.len() as u32;
            *numbers.entry(root(&mut roots, vertex)).or_insert(next)
        })
        .collect()
}

/// The same for equal points, in linear time however many of them there are at one place, as files may have
/// it.
fn weld_equal(positions: &[Vec3]) -> Vec<u32> {
    let mut numbers: HashMap<[u32; 3], u32> = HashMap::with_capacity(positions.len());
    let mut next = 0;
    let number = |position: &Vec3| {
        // Adding 0 turns -0 into 0, so that both are equal. NaN equals nothing.
        let bits = position.to_array().map(|x| (x + 0.0).to_bits());
        let number = if position.is_finite() { *numbers.entry(bits).or_insert(next) } else { next };
        next = next.max(number + 1);
        number
    };
    positions.iter().map(number).collect()
}

fn root(roots: &mut [u32], mut vertex: u32) -> u32 {
    while roots[vertex as usize] != vertex {
        roots[vertex as usize] = roots[roots[vertex as usize] as usize];
        vertex = roots[vertex as usize];
    }
    vertex
}
