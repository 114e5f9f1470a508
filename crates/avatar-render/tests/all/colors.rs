//! Skin and irises in other colours than their textures are painted in.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::{bare_light, light_of, lit_scene};
use crate::common::{ball, gpu, model, part, shadings};
use avatar_mesh::PartKind;
use avatar_render::{
    AvatarModel, AvatarState, Camera, Environment, Image, Material, PartTextures, Shading, Terms, Tone,
};
use glam::Vec3;

const SIZE: u32 = 64;
const SHADINGS: [Shading; 3] = [Shading::Plain, Shading::Natural(Terms::NONE), Shading::Toon];

fn camera() -> Camera {
    Camera::orbit(Vec3::ZERO, 12.0, 0.0, 0.0, 0.2, 1.0)
}

fn scene() -> avatar_render::Scene {
    lit_scene(camera(), bare_light(Environment::uniform([1.0; 3])))
}

fn skin(image: Option<&Image>, material: Material) -> (AvatarModel, AvatarState) {
    let gpu = gpu().expect("asked before");
    let mesh = ball(Vec3::ZERO, 1.0, 12);
    let avatar =
        model(gpu, &[part(&mesh, PartKind::Skin, PartTextures { color: image, ..PartTextures::default() })]);
    let dull = Material { reflectance: 0.0, pore_strength: 0.0, transmission: 0.0, ..material };
    avatar.0.set_material(&gpu.queue, 0, &dull).expect("a part");
    avatar
}

/// One colour all over, sRGB.
fn plain_image(color: [u8; 3]) -> Image {
    let [r, g, b] = color;
    Image { width: 4, height: 4, rgba: [r, g, b, 255].repeat(16) }
}

const PAINTED: [f32; 3] = [0.6, 0.36, 0.26];
const DARK: [f32; 3] = [0.14, 0.06, 0.035];

/// Bare skin that is painted in one tone and shown in another is skin of that other tone.
#[test]
fn bare_skin_takes_the_tone_that_it_is_to_have() {
    let Some(_) = gpu() else { return };
    let of = Material::of(PartKind::Skin);
    for color in [DARK, [0.72, 0.5, 0.4]] {
        let toned = skin(None, Material { color: PAINTED, tone: Tone { color, painted: PAINTED }, ..of });
        let painted = skin(None, Material { color, ..of });
        for shading in SHADINGS {
            let [a, b] = [&toned, &painted].map(|avatar| light_of(shading, SIZE, &scene(), avatar));
            let error = a.light.iter().zip(&b.light).map(|(a, b)| (*a - *b).abs().max_element());
            assert!(error.fold(0.0, f32::max) < 2.0 / 255.0, "{shading:?}");
        }
    }
}

#[test]
fn cloth_keeps_its_color_and_lips_follow_less_than_skin() {
    let Some(_) = gpu() else { return };
    let shown = |painted: [u8; 3], tone: [f32; 3]| {
        let image = plain_image(painted);
        let tone = Tone { color: tone, painted: PAINTED };
        let avatar = skin(Some(&image), Material { tone, ..Material::of(PartKind::Skin) });
        light_of(Shading::Natural(Terms::NONE), SIZE, &scene(), &avatar).at(&camera(), Vec3::Z)
    };
    for cloth in [[40, 60, 90], [120, 120, 120], [10, 90, 40]] {
        assert_eq!(shown(cloth, DARK), shown(cloth, PAINTED), "{cloth:?}");
    }
    let left = |painted: [u8; 3]| (shown(painted, DARK) / shown(painted, PAINTED)).x;
    let [skin, lips, mouth] = [[203, 162, 139], [182, 95, 88], [96, 36, 40]].map(left);
    assert!(skin < 0.3 && skin < 0.8 * lips && lips < 0.8 * mouth && mouth < 1.0, "{skin} {lips} {mouth}");
}

/// What keeps its colour is drawn alike, to the bit, by the programs for other tones and by those without.
#[test]
fn what_keeps_its_color_is_the_same_in_another_tone() {
    let Some(_) = gpu() else { return };
    let cloth = plain_image([40, 60, 90]);
    let of = Material::of(PartKind::Skin);
    let [own, other] = [PAINTED, DARK].map(|color| {
        let tone = Tone { color, painted: PAINTED };
        skin(Some(&cloth), Material { tone, ..of })
    });
    for (name, shading) in shadings() {
        let [own, other] = [&own, &other].map(|avatar| light_of(shading, SIZE, &scene(), avatar));
        assert!(own.middle().min_element() > 0.0 && own.light == other.light, "{name}");
    }
}
