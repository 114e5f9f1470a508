//! A mesh whose triangles all have corners of their own is drawn as the mesh that shares them.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::gpu;
use crate::common::head::{Head, canvas};
use avatar_groom::Style;
use avatar_mesh::{Mesh, Offsets, Shape, Skinning};
use avatar_render::{Deformer, Grower};
use glam::{Affine3A, Vec3};

/// Every triangle with three vertices of its own, as files store it that know no indices.
fn shattered(mesh: &Mesh) -> Mesh {
    let corners: Vec<usize> = mesh.triangles.iter().flatten().map(|corner| *corner as usize).collect();
    fn at<T: Copy>(values: &[T], corners: &[usize]) -> Vec<T> {
        corners.iter().filter_map(|corner| values.get(*corner).copied()).collect()
    }
    let offsets = |all: &Offsets| corners.iter().filter_map(|corner| all.get(*corner)).collect::<Vec<Vec3>>();
    let shape = |shape: &Shape| {
        let whole = Shape::new(shape.name.clone(), offsets(&shape.positions));
        match &shape.normals {
            Some(normals) => whole.with_normals(offsets(normals)),
            None => whole,
        }
    };
    Mesh {
        positions: at(&mesh.positions, &corners),
        normals: at(&mesh.normals, &corners),
        uvs: at(&mesh.uvs, &corners),
        triangles: (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        skinning: mesh.skinning.as_ref().map(|skinning| Skinning {
            bones: at(&skinning.bones, &corners),
            weights: at(&skinning.weights, &corners),
            ..Skinning::default()
        }),
        shapes: mesh.shapes.iter().map(shape).collect(),
        ..Mesh::default()
    }
}

#[test]
fn corners_of_their_own_change_neither_vertices_nor_strands_nor_pictures() {
    let Some(gpu) = gpu() else { return };
    let head = Head::new();
    let whole = head.skin();
    let shattered = shattered(whole);
    assert!(shattered.positions.len() > 4 * whole.positions.len());
    let shown = [whole, &shattered].map(|mesh| {
        let (model, mut state) = head.planted(gpu, mesh, Style::BOB, 3000.0);
        let turn = |bone: usize| Affine3A::from_rotation_y(0.05 * bone as f32);
        let palette: Vec<Affine3A> = (0..model.palette_len()).map(turn).collect();
        let weights: Vec<f32> = (0..model.shape_count()).map(|shape| 0.7 - 0.4 * shape as f32).collect();
        state.set(&gpu.queue, &palette, &weights).expect("lengths fit");
        let deformer = Deformer::new(&gpu.device);
        let posed = deformer.run(&gpu.device, &gpu.queue, &model, &state, 0).expect("a skin");
        let grower = Grower::new(&gpu.device);
        let strands = grower.run(&gpu.device, &gpu.queue, &deformer, &model, &state).expect("strands");
        let scene = head.scene(0.4, 0.8);
        let picture = canvas(gpu, 256, 4).render(gpu, &scene, &[(&model, &state)]).expect("a picture");
        (posed, strands, picture)
    });
    let [(posed, strands, picture), (posed_apart, strands_apart, picture_apart)] = shown;
    // In the order of each mesh, to the bit.
    let corners = || whole.triangles.iter().flatten().map(|corner| *corner as usize);
    assert_eq!(posed_apart.positions, corners().map(|i| posed.positions[i]).collect::<Vec<_>>());
    assert_eq!(posed_apart.normals, corners().map(|i| posed.normals[i]).collect::<Vec<_>>());
    assert!(strands.len() > 100, "{} strands", strands.len());
    assert_eq!(strands_apart, strands);
    assert!(picture.rgba.chunks_exact(4).filter(|pixel| pixel[3] > 0).count() > 10_000);
    assert!(picture_apart == picture, "the pictures differ");
}
