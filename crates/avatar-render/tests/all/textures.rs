//! What textures show beyond their edges (glTF 2.0, section 5.26).
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::{bare_light, light_of, lit_scene};
use crate::common::{gpu, model, part, scene, shadings, square};
use avatar_mesh::{Mesh, PartKind};
use avatar_render::{
    Alpha, Environment, Image, Lighting, Material, PartTextures, Shading, Standard, Wrap, Wraps,
};
use glam::{Vec2, Vec3};

fn unlit() -> Standard {
    Standard { lighting: Lighting::Unlit, ..Standard::default() }
}

/// The light in the middle of a picture of a surface, and the mean of all of it.
fn drawn(
    shading: Shading,
    distance: f32,
    mesh: &Mesh,
    kind: PartKind,
    textures: PartTextures<'_>,
    look: Standard,
) -> (Vec3, Vec3) {
    let gpu = gpu().expect("asked before");
    let avatar = model(gpu, &[part(mesh, kind, textures)]);
    let material = Material { standard: Some(look), ..Material::of(kind) };
    avatar.0.set_material(&gpu.queue, 0, &material).expect("a part");
    let scene = lit_scene(scene(distance).camera, bare_light(Environment::uniform([1.0; 3])));
    let picture = light_of(shading, 64, &scene, &avatar);
    let sum: Vec3 = picture.pixels().map(|(_, light)| light).sum();
    (picture.middle(), sum / (64.0 * 64.0))
}

#[test]
fn beyond_its_edges_a_texture_repeats_or_keeps_its_edge_or_is_mirrored() {
    let Some(_) = gpu() else { return };
    const RED: Vec3 = Vec3::X;
    const GREEN: Vec3 = Vec3::Y;
    // Red on the left, green on the right; and red above, green below.
    let across = Image { width: 2, height: 1, rgba: [[255, 0, 0, 255], [0, 255, 0, 255]].concat() };
    let down = Image { width: 1, height: 2, ..across.clone() };
    let expected = |wrap, at: f32| match (wrap, at) {
        (Wrap::Repeat, -0.25 | 0.75 | 1.75) => GREEN,
        (Wrap::Clamp, -0.25) => RED,
        (Wrap::Mirror, -0.25 | 1.75) => RED,
        (Wrap::Clamp | Wrap::Mirror, 0.75 | 1.25) | (Wrap::Clamp, 1.75) => GREEN,
        _ => RED,
    };
    for (name, shading) in shadings() {
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for at in [-0.25f32, 0.25, 0.75, 1.25, 1.75] {
                for is_down in [false, true] {
                    let (uv, picture, wrap_of_both) = match is_down {
                        false => (Vec2::new(at, 0.5), &across, [wrap, Wrap::Repeat]),
                        true => (Vec2::new(0.5, at), &down, [Wrap::Repeat, wrap]),
                    };
                    let mesh = Mesh { uvs: vec![uv; 4], ..square(Vec3::ZERO, 1.0) };
                    let what = format!("{name}, {wrap:?}, {at}, down: {is_down}");
                    let draw = |color, emissive, wraps, look| {
                        let textures = PartTextures { color, emissive, wraps, ..PartTextures::default() };
                        drawn(shading, 4.0, &mesh, PartKind::Surface, textures, look).0
                    };
                    let wraps = Wraps { color: wrap_of_both, ..Wraps::default() };
                    let found = draw(Some(picture), None, wraps, unlit());
                    assert!(found.distance(expected(wrap, at)) < 2e-3, "{what}: {found}");
                    // Each texture has its own.
                    let black = [0.0, 0.0, 0.0, 1.0];
                    let look = Standard { base_color: black, emissive: [1.0; 3], roughness: 1.0, ..unlit() };
                    let look = Standard { lighting: Lighting::Lit, ..look };
                    let wraps = Wraps { emissive: wrap_of_both, ..Wraps::default() };
                    let found = draw(None, Some(picture), wraps, look);
                    let is_red = expected(wrap, at) == RED;
                    assert_eq!(found.x > found.y + 0.3, is_red, "{what}: it shines {found}");
                }
            }
        }
    }
}

#[test]
fn what_lies_beyond_the_edge_of_a_mask_is_cut_as_well() {
    let Some(_) = gpu() else { return };
    // Beyond the right edge, a clamped mask is open where a repeated one is closed.
    let mask = Image { width: 2, height: 1, rgba: [[255; 4], [255, 255, 255, 0]].concat() };
    let mesh = Mesh { uvs: vec![Vec2::new(1.25, 0.5); 4], ..square(Vec3::ZERO, 1.0) };
    let look = Standard { alpha: Alpha::Mask(0.5), ..unlit() };
    for (name, shading) in shadings() {
        for (wrap, expected) in [(Wrap::Repeat, Vec3::ONE), (Wrap::Clamp, Vec3::ZERO)] {
            let wraps = Wraps { color: [wrap; 2], ..Wraps::default() };
            let textures = PartTextures { color: Some(&mask), wraps, ..PartTextures::default() };
            let (found, _) = drawn(shading, 4.0, &mesh, PartKind::Surface, textures, look);
            assert!(found.distance(expected) < 2e-3, "{name}, {wrap:?}: {found}");
        }
    }
}
