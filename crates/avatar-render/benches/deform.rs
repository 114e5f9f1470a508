//! How close the deform pass comes to a plain kernel that reads and writes as many bytes, in the same run:
//! the built-in skin without an active shape, with its own shapes, and with twenty that move one vertex in
//! twenty. Bytes are counted as memory moves them, with what lies between: of the 96 of a vertex the pass
//! uses 80.
//!
//! `cargo bench -p avatar-render --bench deform [-- ROUNDS]`
#![allow(clippy::expect_used, reason = "a benchmark stops at the first surprise")]
#![allow(clippy::disallowed_methods, clippy::disallowed_types, reason = "it reads the avatar and the clock")]

mod kernels;

use avatar_mesh::{Mesh, Shape};
use avatar_pack::{FaceState, Pack, Source, SourceError};
use avatar_render::headless::{GpuOptions, open_blocking};
use avatar_render::{AvatarModel, AvatarState, Deformer, PartBones, PartDesc, PartTextures};
use kernels::pass_and_copy;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// A vertex as it lies in memory: position, normal, and texture coordinates, which the pass skips.
const VERTEX_BYTES: usize = 32;
/// Its bones and their weights.
const BONE_BYTES: usize = 32;
/// What a shape adds to it: position and normal.
const OFFSET_BYTES: usize = 24;
/// A deformed vertex as it lies in memory: position and normal, each with four bytes behind it.
const DEFORMED_BYTES: usize = 32;
/// Vertices of which offsets are stored together: a shape takes whole blocks.
const BLOCK: usize = 64;

struct Folder(PathBuf);

impl Source for Folder {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        Ok(std::fs::read(self.0.join(name)).ok().map(Cow::Owned))
    }
}

fn main() {
    let rounds = std::env::args().find_map(|arg| arg.parse().ok()).unwrap_or(25);
    let gpu = open_blocking(GpuOptions::default()).expect("an adapter");
    println!("{} ({:?}, {})\n", gpu.info.name, gpu.info.backend, gpu.info.driver_info);
    let folder = Folder(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne"));
    let pack = Pack::load(&folder).expect("the built-in avatar");
    let mut face = FaceState::new(&pack);
    let values: Vec<f32> = pack.controls().controls().iter().map(|control| control.max * 0.5).collect();
    face.pose(&pack, &values).expect("a pose");
    let skin = &pack.parts()[0];
    let deformer = Deformer::new(&gpu.device);
    let many = Mesh { shapes: local_shapes(&skin.mesh, 20), ..skin.mesh.clone() };
    for (mesh, active) in [(&skin.mesh, 0), (&skin.mesh, 1), (&skin.mesh, 2), (&many, 20)] {
        let part = PartDesc {
            label: "skin",
            mesh,
            first_weight: 0,
            kind: skin.kind,
            bones: PartBones::PerVertex,
            textures: PartTextures::default(),
        };
        let bones = face.bones();
        let model = AvatarModel::new(&gpu.device, &gpu.queue, &[part], bones.len()).expect("a model");
        let mut state = AvatarState::new(&gpu.device, &model);
        let weights: Vec<f32> = (0..mesh.shapes.len()).map(|k| if k < active { 0.5 } else { 0.0 }).collect();
        state.set(&gpu.queue, bones, &weights).expect("a pose");
        let vertices = mesh.positions.len();
        let offsets: usize = mesh.shapes.iter().take(active).map(moved_blocks).sum::<usize>() * BLOCK;
        let bytes = vertices * (VERTEX_BYTES + BONE_BYTES + DEFORMED_BYTES) + offsets * OFFSET_BYTES;
        let (deforming, copying) =
            pass_and_copy(&gpu, bytes, rounds, |encoder| deformer.deform(encoder, &model, &state));
        assert_eq!(gpu.errors.take(), None);
        println!(
            "{vertices} vertices, {active} active shapes: {:.3} ms, {:.1} ns a vertex, {:.2} GB/s; copying {:.2} \
             GB/s: {:.3} of it",
            deforming * 1e3,
            deforming * 1e9 / vertices as f64,
            bytes as f64 / deforming * 1e-9,
            bytes as f64 / copying * 1e-9,
            copying / deforming
        );
    }
}

/// Shapes that each push out the twentieth of the vertices that is nearest to one of them.
fn local_shapes(mesh: &Mesh, count: usize) -> Vec<Shape> {
    let vertices = mesh.positions.len();
    let shape = |number: usize| {
        let center = mesh.positions[number * vertices / count];
        let mut nearest: Vec<usize> = (0..vertices).collect();
        let distance = |vertex: &usize| mesh.positions[*vertex].distance_squared(center);
        nearest.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        let moved = nearest.iter().take(vertices / 20);
        let pairs = moved.map(|vertex| (*vertex as u32, mesh.normals[*vertex] * 0.01));
        Shape::from_pairs(format!("shape {number}"), vertices, pairs).expect("each vertex once")
    };
    (0..count).map(shape).collect()
}

/// Blocks of vertices in which a shape moves anything.
fn moved_blocks(shape: &Shape) -> usize {
    let normals = shape.normals.iter().flat_map(|normals| normals.iter());
    let mut blocks: Vec<usize> = shape.positions.iter().chain(normals).map(|(at, _)| at / BLOCK).collect();
    blocks.sort_unstable();
    blocks.dedup();
    blocks.len()
}
