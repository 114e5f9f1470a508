//! Many avatars in one frame: each looks as it does alone.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::Stage;
use crate::common::{ball, gpu, scene, shadings};
use avatar_mesh::{PartKind, Shape};
use avatar_render::{AvatarModel, AvatarState, Camera, PartBones, PartDesc, PartTextures, Scene};
use glam::{Affine3A, Quat, Vec3};

/// So many avatars in a row of the square.
const ROW: usize = 8;
/// The width of the picture, and of an avatar's own square in it, in pixels.
const SIZE: usize = 256;
const CELL: usize = SIZE / ROW;
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// The bytes of one avatar's square, row by row.
fn cell(picture: &[u8], avatar: usize) -> Vec<u8> {
    let (column, row) = (avatar % ROW, avatar / ROW);
    let rows = picture.chunks_exact(4 * SIZE).skip(row * CELL).take(CELL);
    rows.flat_map(|pixels| &pixels[4 * column * CELL..4 * (column + 1) * CELL]).copied().collect()
}

#[test]
fn sixty_four_of_one_model_in_different_poses_look_as_each_does_alone() {
    let Some(gpu) = gpu() else { return };
    let mut head = ball(Vec3::ZERO, 0.5, 10);
    let offsets = |along: Vec3| head.positions.iter().map(|p| along * p.y.abs()).collect::<Vec<_>>();
    let shapes = vec![Shape::new("tall", offsets(Vec3::Y)), Shape::new("crooked", offsets(Vec3::X))];
    head.shapes = shapes;
    // A nose, so that it is seen where a head looks.
    let nose = ball(Vec3::new(0.0, 0.0, 0.5), 0.2, 6);
    let part = |label, mesh, kind, bone| {
        let bones = PartBones::Rigid(bone);
        PartDesc { label, mesh, first_weight: 0, kind, bones, textures: PartTextures::default() }
    };
    let parts = [part("head", &head, PartKind::Skin, 0), part("nose", &nose, PartKind::Eyeball, 1)];
    let model = AvatarModel::new(&gpu.device, &gpu.queue, &parts, 2).expect("a valid model");
    let states: Vec<_> = (0..ROW * ROW)
        .map(|avatar| {
            let (column, row) = ((avatar % ROW) as f32, (avatar / ROW) as f32);
            // From the camera's side, each in the middle of its square: 16 units for the picture's width.
            let place = 2.0 * Vec3::new(column - 3.5, 3.5 - row, 0.0);
            let turned =
                Quat::from_rotation_y(0.2 * (column - 3.5)) * Quat::from_rotation_x(0.15 * (row - 3.5));
            let head = Affine3A::from_rotation_translation(turned, place);
            let nose = head * Affine3A::from_translation(Vec3::X * (0.02 * avatar as f32 - 0.6));
            let mut state = AvatarState::new(&gpu.device, &model);
            let weights = [avatar as f32 / 63.0, (avatar * 5 % 64) as f32 / 63.0 - 0.5];
            state.set(&gpu.queue, &[head, nose], &weights).expect("two bones, two weights");
            state
        })
        .collect();
    // Far away with a narrow view: neighbours do not reach into each other's squares.
    let distance = 400.0;
    let camera = Camera::orbit(Vec3::ZERO, distance, 0.0, 0.0, 2.0 * (8.0f32 / distance).atan(), 1.0);
    let scene = Scene { camera, ..scene(4.0) };
    // Without shadows, which fall from one avatar onto others and are as coarse as all that casts them is
    // large.
    let (_, plain) = shadings()[0];
    let stage = Stage::new(gpu, plain, SIZE as u32, FORMAT);
    let all: Vec<_> = states.iter().map(|state| (&model, state)).collect();
    let together = stage.bytes(gpu, &scene, &all);
    let background = [0, 0, 0, 255];
    for (avatar, one) in all.iter().enumerate() {
        let alone = stage.bytes(gpu, &scene, &[*one]);
        let own = cell(&alone, avatar);
        let drawn = |bytes: &[u8]| bytes.chunks_exact(4).filter(|pixel| *pixel != background).count();
        assert!(drawn(&own) > 100, "avatar {avatar} is seen: {} pixels", drawn(&own));
        assert_eq!(drawn(&own), drawn(&alone), "avatar {avatar} stays in its square");
        assert!(own == cell(&together, avatar), "avatar {avatar} of a crowd looks as it does alone");
        assert!(avatar == 0 || own != cell(&together, avatar - 1), "avatar {avatar} has a pose of its own");
    }
}
