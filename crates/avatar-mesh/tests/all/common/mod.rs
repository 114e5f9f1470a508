//! Helpers of the tests. Every test program compiles this file and uses a part of it.
#![allow(dead_code, reason = "each test program uses a part")]
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use avatar_mesh::{Mesh, Offsets, Shape, Skinning};
use glam::{Affine3A, Quat, Vec2, Vec3};

/// The folder of real data beside the repository, or `None` with a printed reason; under
/// `MIMIK_REQUIRE_DATA=1` its absence is a failure.
#[allow(clippy::disallowed_methods, reason = "a test asks what it must not skip")]
pub(crate) fn shared_data() -> Option<std::path::PathBuf> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if folder.is_dir() {
        return Some(folder);
    }
    let required = std::env::var_os("MIMIK_REQUIRE_DATA").is_some_and(|value| value == "1");
    assert!(!required, "expected data in {} (MIMIK_REQUIRE_DATA=1), found no folder", folder.display());
    // Past the harness, which keeps the output of tests that pass to itself.
    let skipped = format_args!("SKIPPED: {} is not there\n", folder.display());
    let _ = std::io::Write::write_fmt(&mut std::io::stderr(), skipped);
    None
}

pub(crate) fn bytes(floats: &[f32]) -> Vec<u8> {
    floats.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// Changes the offset of one vertex.
pub(crate) fn edit_offset(offsets: &mut Offsets, vertex: usize, edit: impl FnOnce(&mut Vec3)) {
    let mut all: Vec<Vec3> = offsets.per_vertex().collect();
    edit(&mut all[vertex]);
    *offsets = all.into();
}

/// SplitMix64: a seed gives the same numbers on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// From -1 to 1.
    pub(crate) fn signed(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u32 << 23) as f32 - 1.0
    }

    pub(crate) fn vec3(&mut self, scale: f32) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed()) * scale
    }

    pub(crate) fn unit(&mut self) -> Vec3 {
        loop {
            let v = self.vec3(1.0);
            if (0.1..1.0).contains(&v.length()) {
                return v / v.length();
            }
        }
    }

    pub(crate) fn rigid(&mut self) -> Affine3A {
        let rotation = Quat::from_axis_angle(self.unit(), self.signed() * 3.0);
        Affine3A::from_rotation_translation(rotation, self.vec3(10.0))
    }

    /// A skinned mesh of the given sizes, valid, with weights that sum to 1.
    pub(crate) fn mesh(&mut self, vertices: usize, shapes: usize, bones: usize) -> Mesh {
        let mut mesh = Mesh::default();
        let mut skinning = Skinning::default();
        for _ in 0..vertices {
            mesh.positions.push(self.vec3(15.0));
            mesh.uvs.push(Vec2::new(self.signed(), self.signed()));
            mesh.normals.push(self.unit());
            skinning.bones.push(std::array::from_fn(|_| self.below(bones) as u16));
            // Eighths are exact, so that the sum is 1 exactly.
            let cuts = [self.below(9), self.below(9), self.below(9)];
            let mut sorted = cuts;
            sorted.sort_unstable();
            let [a, b, c] = sorted;
            skinning.weights.push([a, b - a, c - b, 8 - c].map(|eighths| eighths as f32 / 8.0));
            skinning.blend_index.push(self.vec3(1.0));
        }
        for k in 0..shapes {
            let positions: Vec<Vec3> = (0..vertices).map(|_| self.vec3(2.0)).collect();
            let normals: Vec<Vec3> = (0..vertices).map(|_| self.vec3(0.3)).collect();
            mesh.shapes.push(Shape::new(format!("shape {k}"), positions).with_normals(normals));
        }
        mesh.triangles =
            (0..vertices).map(|_| std::array::from_fn(|_| self.below(vertices) as u32)).collect();
        mesh.skinning = Some(skinning);
        mesh
    }

    /// Gives the vertices of a mesh further bones, which take half of the weight; a third has none.
    pub(crate) fn add_further_bones(&mut self, mesh: &mut Mesh, bones: usize) {
        let Some(skinning) = &mut mesh.skinning else { return };
        for weights in &mut skinning.weights {
            skinning.more_bones.push(std::array::from_fn(|_| self.below(bones) as u16));
            if self.below(3) == 0 {
                skinning.more_weights.push([0.0; 4]);
                continue;
            }
            *weights = weights.map(|weight| weight / 2.0);
            skinning.more_weights.push([0.125, 0.25, 0.0625, 0.0625]);
        }
    }

    /// A bone that scales each direction by its own factor, which may be negative, and shears.
    pub(crate) fn uneven(&mut self) -> Affine3A {
        let scale = Vec3::from_array([(); 3].map(|()| {
            let size = 0.4 + 1.6 * self.signed().abs();
            if self.below(3) == 0 { -size } else { size }
        }));
        let turn = |random: &mut Self| Quat::from_axis_angle(random.unit(), random.signed() * 3.0);
        let (first, second) = (turn(self), turn(self));
        let shift = self.vec3(10.0);
        Affine3A::from_scale_rotation_translation(scale, second, shift) * Affine3A::from_quat(first)
    }
}
