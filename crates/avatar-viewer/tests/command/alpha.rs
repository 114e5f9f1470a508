//! The alpha modes of glTF 2.0, section 3.9.4, through the whole program.
#![allow(clippy::expect_used, reason = "a test may panic")]

use crate::common::{finish, has_adapter, viewer};
use avatar_exchange::glb::write_raw;
use avatar_exchange::{AlphaMode, Material, Node, RawScene, SceneImage, ScenePart};
use avatar_mesh::Mesh;
use glam::{Vec2, Vec3};
use image::{Rgba, RgbaImage};
use std::fs;
use std::io::Cursor;

const OPACITIES: [u8; 5] = [255, 170, 128, 64, 0];
const RED: [u8; 3] = [220, 40, 30];
const BLUE: [u8; 3] = [20, 60, 200];

fn board(z: f32, half: f32) -> Mesh {
    let corner = |x: f32, y: f32| Vec3::new(x * half, y * half, z);
    Mesh {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        uvs: vec![Vec2::new(0.0, 1.0), Vec2::ONE, Vec2::new(1.0, 0.0), Vec2::ZERO],
        normals: vec![Vec3::Z; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// Five strips of one red with these opacities before a blue board, both seen as they are.
fn strips(alpha_mode: AlphaMode) -> Vec<u8> {
    let [r, g, b] = RED;
    let painted = RgbaImage::from_fn(80, 16, |x, _| Rgba([r, g, b, OPACITIES[x as usize / 16]]));
    let mut png = Cursor::new(Vec::new());
    painted.write_to(&mut png, image::ImageFormat::Png).expect("a PNG");
    let linear = |byte: u8| ((f32::from(byte) / 255.0 + 0.055) / 1.055).powf(2.4);
    let [r, g, b] = BLUE.map(linear);
    let plain = Material { is_unlit: true, metallic: 0.0, ..Material::default() };
    let scene = RawScene {
        nodes: vec![Node::default(), Node::default()],
        parts: vec![
            ScenePart { material: Some(0), ..ScenePart::rigid("strips", 0, board(0.0, 1.0)) },
            ScenePart { material: Some(1), ..ScenePart::rigid("board", 1, board(-0.2, 1.1)) },
        ],
        materials: vec![
            Material { alpha_mode, base_color_texture: Some(0.into()), ..plain.clone() },
            Material { base_color: [r, g, b, 1.0], ..plain },
        ],
        images: vec![SceneImage {
            name: "strips".to_owned(),
            mime: "image/png".to_owned(),
            bytes: png.into_inner(),
        }],
        ..RawScene::default()
    };
    write_raw(&scene).expect("a GLB")
}

#[test]
fn strips_of_opacities_are_opaque_cut_or_blended_as_their_material_says() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    for mode in [AlphaMode::Opaque, AlphaMode::Mask, AlphaMode::Blend] {
        let (file, out) = (folder.path().join("strips.glb"), folder.path().join("strips.png"));
        fs::write(&file, strips(mode)).expect("written");
        finish(viewer().arg("render").arg(&file).args(["--size", "120x120"]).arg("--out").arg(&out)).ok();
        let picture = image::open(&out).expect("a picture").into_rgba8();
        // From the left edge of the board to its right one.
        let is_board = |x: &u32| picture.get_pixel(*x, 60).0[0] > 100 || picture.get_pixel(*x, 60).0[2] > 100;
        let columns: Vec<u32> = (0..120).filter(is_board).collect();
        let (first, last) = (columns[0] as f32, columns[columns.len() - 1] as f32 + 1.0);
        // Seen from some distance, strips take about 1 / 1.1 of the board's width.
        let middle = |strip: usize| {
            let share = 0.5 + (strip as f32 - 2.0) / 5.0 / 1.08;
            (first + share * (last - first)) as u32
        };
        for (strip, opacity) in OPACITIES.iter().enumerate() {
            let share = match mode {
                AlphaMode::Opaque => 1.0,
                AlphaMode::Mask => f32::from(u8::from(*opacity >= 128)),
                AlphaMode::Blend => f32::from(*opacity) / 255.0,
            };
            let found = picture.get_pixel(middle(strip), 60).0;
            // Blended in linear light.
            let linear = |byte: u8| ((f32::from(byte) / 255.0 + 0.055) / 1.055).powf(2.4);
            let expected = [0, 1, 2].map(|channel| {
                let light = linear(RED[channel]) * share + linear(BLUE[channel]) * (1.0 - share);
                (1.055 * light.powf(1.0 / 2.4) - 0.055) * 255.0
            });
            let off = (0..3).map(|channel| (f32::from(found[channel]) - expected[channel]).abs());
            assert!(off.fold(0.0, f32::max) <= 3.0, "{mode:?}, strip {strip}: {found:?} for {expected:?}");
        }
    }
}
