//! Deformation per vertex, reading against copying, welding; at the size of the original skin. Divan prints
//! items (vertices) or bytes per second beside the time of one run.
#![allow(clippy::unwrap_used, reason = "a bench may panic")]

use avatar_mesh::{
    DeformBounds, Mesh, Shape, ShapeNormals, Skinning, SmoothNormals, deform, deform_with, raw, weld,
    weld_positions,
};
use divan::Bencher;
use divan::counter::{BytesCount, ItemsCount};
use glam::{Affine3A, Quat, Vec2, Vec3};

/// Vertices and triangles of the original skin.
const VERTICES: usize = 63_488;
const TRIANGLES: usize = 30_644;

fn main() {
    divan::main();
}

/// A grid, each vertex stored twice, as the original is far from welded.
fn skin() -> Mesh {
    let mut mesh = Mesh::default();
    let mut skinning = Skinning::default();
    let mut offsets = [(); 2].map(|()| (Vec::new(), Vec::new()));
    for i in 0..VERTICES {
        let (x, y) = ((i / 2 % 176) as f32, (i / 2 / 176) as f32);
        mesh.positions.push(Vec3::new(x * 0.1, y * 0.1, (x * 0.05).sin()));
        mesh.uvs.push(Vec2::new(x / 176.0, y / 181.0));
        mesh.normals.push(Vec3::Z);
        skinning.bones.push(std::array::from_fn(|slot| ((i / 2 + slot) % 9) as u16));
        skinning.weights.push([0.5, 0.25, 0.125, 0.125]);
        skinning.blend_index.push(Vec3::Y);
        for (positions, normals) in &mut offsets {
            positions.push(Vec3::new(0.1, x * 0.01, 0.0));
            normals.push(Vec3::new(0.0, 0.1, 0.1));
        }
    }
    mesh.triangles = (0..TRIANGLES as u32).map(|i| [2 * i, 2 * i + 1, 2 * i + 2]).collect();
    mesh.skinning = Some(skinning);
    let named = ["SSmile", "Frown"].into_iter().zip(offsets);
    mesh.shapes = named.map(|(name, (p, n))| Shape::new(name, p).with_normals(n)).collect();
    mesh.validate(9).unwrap();
    mesh
}

#[divan::bench(args = [0, 1, 2])]
fn deform_with_shapes(bencher: Bencher<'_, '_>, shapes: usize) {
    let mesh = skin();
    let bone = |i: usize| Affine3A::from_quat(Quat::from_rotation_y(i as f32 * 0.1));
    let bones: Vec<Affine3A> = (0..9).map(bone).collect();
    let weights: Vec<f32> = (0..2).map(|k| if k < shapes { 0.5 } else { 0.0 }).collect();
    let mut out = mesh.deformed();
    bencher.counter(ItemsCount::new(VERTICES)).bench_local(|| {
        deform(&mesh, divan::black_box(&bones), divan::black_box(&weights), &mut out).unwrap();
        divan::black_box(&out);
    });
}

/// Of a face with many shapes, each moves a few vertices: one in twenty here, or all. Every second shape is
/// active.
#[divan::bench(args = [("sparse", 20), ("dense", 1)])]
fn deform_with_fifty_shapes(bencher: Bencher<'_, '_>, (_, one_in): (&str, usize)) {
    let mut mesh = skin();
    mesh.shapes = (0..50)
        .map(|k| {
            let moved = |v: usize| (v / 64).is_multiple_of(one_in) || one_in == 1;
            let offset = |v: usize| if moved(v + 64 * k) { Vec3::new(0.01, 0.02, 0.03) } else { Vec3::ZERO };
            let offsets: Vec<Vec3> = (0..VERTICES).map(offset).collect();
            Shape::new(k.to_string(), offsets.clone()).with_normals(offsets)
        })
        .collect();
    let bones = [Affine3A::IDENTITY; 9];
    let weights: Vec<f32> = (0..50).map(|k| (k % 2) as f32 * 0.1).collect();
    let mut out = mesh.deformed();
    bencher.counter(ItemsCount::new(VERTICES)).bench_local(|| {
        deform(&mesh, divan::black_box(&bones), divan::black_box(&weights), &mut out).unwrap();
        divan::black_box(&out);
    });
}

#[divan::bench]
fn deform_with_recomputed_normals(bencher: Bencher<'_, '_>) {
    let mesh = skin();
    let mut smooth = SmoothNormals::new(&mesh);
    let bones = [Affine3A::IDENTITY; 9];
    let mut out = mesh.deformed();
    bencher.counter(ItemsCount::new(VERTICES)).bench_local(|| {
        let normals = ShapeNormals::Recomputed(&mut smooth);
        deform_with(&mesh, divan::black_box(&bones), divan::black_box(&[0.5, 0.5]), normals, &mut out)
            .unwrap();
        divan::black_box(&out);
    });
}

#[divan::bench]
fn box_around_a_pose(bencher: Bencher<'_, '_>) {
    let mesh = skin();
    let bounds = DeformBounds::new(&mesh);
    let bones = [Affine3A::IDENTITY; 9];
    bencher.bench_local(|| bounds.around(divan::black_box(&bones), divan::black_box(&[0.5, 0.5])));
}

fn buffers() -> (Vec<u8>, Vec<u8>) {
    let mesh = skin();
    (raw::write_vertices(&mesh), raw::write_triangles(&mesh))
}

#[divan::bench]
fn copy_the_bytes(bencher: Bencher<'_, '_>) {
    let (vertices, indices) = buffers();
    let bytes = BytesCount::new(vertices.len() + indices.len());
    bencher
        .counter(bytes)
        .bench_local(|| (divan::black_box(&vertices).clone(), divan::black_box(&indices).clone()));
}

#[divan::bench]
fn read_the_bytes(bencher: Bencher<'_, '_>) {
    let (vertices, indices) = buffers();
    let bytes = BytesCount::new(vertices.len() + indices.len());
    bencher
        .counter(bytes)
        .bench_local(|| raw::read_skin(divan::black_box(&vertices), divan::black_box(&indices)).unwrap());
}

#[divan::bench]
fn read_and_validate_the_bytes(bencher: Bencher<'_, '_>) {
    let (vertices, indices) = buffers();
    let bytes = BytesCount::new(vertices.len() + indices.len());
    bencher.counter(bytes).bench_local(|| {
        let mut mesh = raw::read_skin(divan::black_box(&vertices), divan::black_box(&indices)).unwrap();
        mesh.validate(9).unwrap();
        mesh
    });
}

#[divan::bench]
fn weld_to_the_bit(bencher: Bencher<'_, '_>) {
    let mesh = skin();
    bencher.counter(ItemsCount::new(VERTICES)).bench_local(|| weld(divan::black_box(&mesh)));
}

#[divan::bench]
fn weld_near_points(bencher: Bencher<'_, '_>) {
    let mesh = skin();
    bencher
        .counter(ItemsCount::new(VERTICES))
        .bench_local(|| weld_positions(divan::black_box(&mesh.positions), 1e-4));
}
