//! Opaque, masked and blended surfaces: glTF 2.0, section 3.9.4, in all styles, in shadows and in the passes
//! before the picture.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::stage::{Picture, bare_light, key_light, light_of, lit_scene, pixel_of};
use crate::common::{gpu, model, part, plain, scene, shadings, square};
use avatar_mesh::{Mesh, PartKind};
use avatar_render::headless::Canvas;
use avatar_render::{
    Alpha, AvatarModel, AvatarState, Camera, Environment, Image, Lighting, Material, PartTextures, Scene,
    Shading, Standard, Terms,
};
use glam::{Affine3A, Quat, Vec2, Vec3};

const SIZE: u32 = 64;
const RED: [f32; 4] = [0.8, 0.1, 0.05, 1.0];
const BLUE: [f32; 4] = [0.05, 0.1, 0.8, 1.0];

fn of(standard: Standard) -> Material {
    Material { standard: Some(standard), ..Material::of(PartKind::Surface) }
}

/// A surface whose colour is seen as it is.
fn unlit(base_color: [f32; 4], alpha: Alpha) -> Material {
    of(Standard { base_color, alpha, lighting: Lighting::Unlit, ..Standard::default() })
}

/// Parts with textures and materials.
fn avatar(parts: &[(&Mesh, Option<&Image>, Material)]) -> (AvatarModel, AvatarState) {
    let gpu = gpu().expect("asked before");
    let descs: Vec<_> = parts
        .iter()
        .map(|(mesh, color, _)| {
            part(mesh, PartKind::Surface, PartTextures { color: *color, ..PartTextures::default() })
        })
        .collect();
    let avatar = model(gpu, &descs);
    for (place, (.., material)) in parts.iter().enumerate() {
        avatar.0.set_material(&gpu.queue, place, material).expect("a part");
    }
    avatar
}

fn rgb([r, g, b, _]: [f32; 4]) -> Vec3 {
    Vec3::new(r, g, b)
}

fn close(found: Vec3, expected: Vec3, what: &str) {
    assert!((found - expected).abs().max_element() < 2e-3, "{what}: {found} for {expected}");
}

/// White strips with these opacities, from left to right, wide enough that filtering leaves their middles.
fn strips(opacities: &[u8]) -> Image {
    let texels = opacities.iter().flat_map(|alpha| [[255, 255, 255, *alpha]; 8]);
    Image { width: 8 * opacities.len() as u32, height: 1, rgba: texels.flatten().collect() }
}

#[test]
fn opaque_ignores_alpha_mask_cuts_at_the_cutoff_and_blend_weights_by_it() {
    let Some(_) = gpu() else { return };
    let opacities = [255, 170, 128, 64, 0];
    let texture = strips(&opacities);
    let (front, behind) = (square(Vec3::ZERO, 1.0), square(Vec3::new(0.0, 0.0, -0.5), 3.0));
    let scene = lit_scene(scene(4.0).camera, bare_light(Environment::uniform([1.0; 3])));
    for (name, shading) in shadings() {
        for alpha in [Alpha::Opaque, Alpha::Mask(0.5), Alpha::Blend] {
            let parts =
                [(&behind, None, unlit(BLUE, Alpha::Opaque)), (&front, Some(&texture), unlit(RED, alpha))];
            let picture = light_of(shading, SIZE, &scene, &avatar(&parts));
            for (strip, opacity) in opacities.iter().enumerate() {
                let middle = Vec3::new((strip as f32 + 0.5) / 2.5 - 1.0, 0.0, 0.0);
                let share = match alpha {
                    Alpha::Opaque => 1.0,
                    Alpha::Mask(cutoff) if f32::from(*opacity) / 255.0 >= cutoff => 1.0,
                    Alpha::Mask(_) => 0.0,
                    Alpha::Blend => f32::from(*opacity) / 255.0,
                };
                let expected = rgb(RED) * share + rgb(BLUE) * (1.0 - share);
                let at = picture.at(&scene.camera, middle);
                close(at, expected, &format!("{name}, {alpha:?}, {opacity}"));
            }
        }
    }
}

#[test]
fn a_factor_and_a_vertex_count_as_opacity_too() {
    let Some(_) = gpu() else { return };
    let mut front = square(Vec3::ZERO, 1.0);
    front.colors = vec![glam::Vec4::new(1.0, 1.0, 1.0, 0.5); 4];
    let behind = square(Vec3::new(0.0, 0.0, -0.5), 3.0);
    let texture = plain([255, 255, 255, 204]);
    let scene = lit_scene(scene(4.0).camera, bare_light(Environment::uniform([1.0; 3])));
    let [r, g, b, _] = RED;
    for (name, shading) in shadings() {
        let draw = |alpha| {
            let parts = [
                (&behind, None, unlit(BLUE, Alpha::Opaque)),
                (&front, Some(&texture), unlit([r, g, b, 0.75], alpha)),
            ];
            light_of(shading, 32, &scene, &avatar(&parts)).middle()
        };
        let opacity = 0.8 * 0.75 * 0.5;
        close(draw(Alpha::Blend), rgb(RED) * opacity + rgb(BLUE) * (1.0 - opacity), name);
        close(draw(Alpha::Mask(0.29)), rgb(RED), name);
        close(draw(Alpha::Mask(0.31)), rgb(BLUE), name);
    }
}

#[test]
fn the_edge_of_a_mask_covers_some_of_four_samples() {
    let Some(gpu) = gpu() else { return };
    // Opacity grows from left to right: the edge stands where it passes a half.
    let ramp = Image { width: 2, height: 1, rgba: [[255, 255, 255, 0], [255; 4]].concat() };
    let mut mesh = square(Vec3::ZERO, 1.0);
    // Of the texture only what lies between the middles of its two texels.
    mesh.uvs.iter_mut().for_each(|uv| *uv = Vec2::new(0.25 + 0.5 * uv.x, uv.y));
    let turn = Affine3A::from_quat(Quat::from_rotation_z(0.3));
    let (model, mut state) = avatar(&[(&mesh, Some(&ramp), unlit([1.0; 4], Alpha::Mask(0.5)))]);
    state.set(&gpu.queue, &[turn], &[]).expect("lengths fit");
    let draw = |samples| {
        let canvas = Canvas::new(gpu, SIZE, SIZE, samples, Shading::Plain).expect("a canvas");
        canvas.render(gpu, &scene(4.0), &[(&model, &state)]).expect("a picture")
    };
    let shades = |samples| {
        let picture = draw(samples);
        let mut shades: Vec<u8> = picture.rgba.chunks_exact(4).map(|pixel| pixel[0]).collect();
        shades.sort_unstable();
        shades.dedup();
        shades
    };
    assert_eq!(shades(1), [0, 255], "all or nothing where a pixel has one sample");
    // Shares of a quarter, a half and three quarters of white, encoded as sRGB (IEC 61966-2-1).
    let encoded = [0u8, 137, 188, 225, 255];
    let found = shades(4);
    let is_one = |shade: &u8| encoded.iter().position(|share| share.abs_diff(*shade) <= 1);
    let quarters: Vec<Option<usize>> = found.iter().map(is_one).collect();
    assert_eq!(quarters, [0, 1, 2, 3, 4].map(Some), "{found:?}");
    // The edge halves the square.
    let light = |shade: u8| is_one(&shade).map_or(f32::NAN, |quarters| quarters as f32 / 4.0);
    let covered: f32 = draw(4).rgba.chunks_exact(4).map(|pixel| light(pixel[0])).sum();
    let side = pixel_of(&scene(4.0).camera, SIZE, Vec3::X).x - SIZE as f32 * 0.5;
    let half = 2.0 * side * side;
    assert!((covered - half).abs() < 0.01 * half, "{covered} of {half}");
}

#[test]
fn blended_parts_lie_over_each_other_from_far_to_near_whatever_their_order() {
    let Some(_) = gpu() else { return };
    let colors = [[0.9, 0.1, 0.1, 0.6], [0.1, 0.9, 0.1, 0.3], [0.1, 0.1, 0.9, 0.8]];
    let meshes = [-0.5f32, 0.0, 0.5].map(|z| square(Vec3::new(0.0, 0.0, z), 1.0));
    let glass = |color| {
        let Material { standard, .. } = unlit(color, Alpha::Blend);
        of(Standard { is_double_sided: true, ..standard.expect("just made") })
    };
    // From the front the last lies in front, from behind the first.
    let over = |below: Vec3, color: [f32; 4]| below * (1.0 - color[3]) + rgb(color) * color[3];
    let from_front = colors.iter().fold(Vec3::ZERO, |below, color| over(below, *color));
    let from_back = colors.iter().rev().fold(Vec3::ZERO, |below, color| over(below, *color));
    for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
        let parts = order.map(|place: usize| (&meshes[place], None, glass(colors[place])));
        let avatar = avatar(&parts);
        for (name, shading) in shadings() {
            for (yaw, expected) in [(0.0, from_front), (std::f32::consts::PI, from_back)] {
                let camera = Camera::orbit(Vec3::ZERO, 4.0, yaw, 0.0, 0.6, 1.0);
                let scene = lit_scene(camera, bare_light(Environment::uniform([0.0; 3])));
                let middle = light_of(shading, 32, &scene, &avatar).middle();
                close(middle, expected, &format!("{name}, {order:?}, {yaw}"));
            }
        }
    }
}

#[test]
fn what_is_opaque_of_a_blended_part_hides_what_lies_behind_it_in_the_same_part() {
    let Some(_) = gpu() else { return };
    // Two sheets in one mesh, the front one first: without depth the other would be drawn over it.
    let (front, back) = (square(Vec3::new(0.0, 0.0, 0.5), 1.0), square(Vec3::ZERO, 1.0));
    let mut both = front.clone();
    both.positions.extend(&back.positions);
    both.normals.extend(&back.normals);
    both.uvs.extend(&back.uvs);
    both.triangles.extend(back.triangles.iter().map(|corners| corners.map(|corner| corner + 4)));
    both.colors =
        [[glam::Vec4::new(1.0, 0.0, 0.0, 1.0); 4], [glam::Vec4::new(0.0, 1.0, 0.0, 0.5); 4]].concat();
    let scene = lit_scene(scene(4.0).camera, bare_light(Environment::uniform([0.0; 3])));
    for (name, shading) in shadings() {
        let avatar = avatar(&[(&both, None, unlit([1.0; 4], Alpha::Blend))]);
        close(light_of(shading, 32, &scene, &avatar).middle(), Vec3::X, name);
    }
}

#[test]
fn what_is_cut_away_or_wholly_clear_is_not_there_in_any_pass() {
    let Some(_) = gpu() else { return };
    let (near, behind) = (square(Vec3::new(0.0, 0.0, 0.4), 0.6), square(Vec3::ZERO, 1.2));
    let white = of(Standard { is_double_sided: true, ..Standard::default() });
    let scene = lit_scene(scene(5.0).camera, key_light(Vec3::new(0.3, 0.2, 1.0)));
    for (name, shading) in shadings() {
        let alone = light_of(shading, SIZE, &scene, &avatar(&[(&behind, None, white)]));
        let draw = |base_color, alpha| {
            let look = of(Standard { base_color, alpha, ..Standard::default() });
            light_of(shading, SIZE, &scene, &avatar(&[(&behind, None, white), (&near, None, look)]))
        };
        // The box of what is there is that of both: their shadow map is another one, hence not to the bit.
        let differs = |picture: &Picture| picture.difference_share(&alone, 0.02);
        assert!(differs(&draw([1.0, 1.0, 1.0, 0.4], Alpha::Mask(0.5))) < 1e-3, "{name}: cut");
        assert!(differs(&draw([1.0, 1.0, 1.0, 0.0], Alpha::Blend)) < 1e-3, "{name}: clear");
        assert!(differs(&draw([0.1, 0.1, 0.1, 0.6], Alpha::Mask(0.5))) > 0.05, "{name}: there");
    }
}

#[test]
fn a_mask_casts_the_shadow_of_what_it_leaves_and_blending_that_of_what_hides_more_than_half() {
    let Some(_) = gpu() else { return };
    let (plate, above) = (square(Vec3::ZERO, 1.5), square(Vec3::new(0.0, 0.0, 0.8), 0.5));
    let strips = strips(&[255, 0]);
    let white = of(Standard::default());
    let toward_lamp = Vec3::new(1.0, 0.0, 1.0);
    // From the side, where the part above hides nothing of its own shadow.
    let camera = Camera::orbit(Vec3::ZERO, 8.0, -0.5, 0.0, 0.5, 1.0);
    let scene = lit_scene(camera, key_light(toward_lamp));
    let shading = Shading::Natural(Terms { occlusion: false, ..Terms::MEDIUM });
    // What a point of the plate has, by the point of the part above that lies between it and the lamp.
    let below = |picture: &Picture, x: f32| picture.at(&scene.camera, Vec3::new(x - 0.8, 0.0, 0.0)).x;
    let draw = |texture, base_color, alpha| {
        let look = of(Standard { base_color, alpha, is_double_sided: true, ..Standard::default() });
        light_of(shading, 128, &scene, &avatar(&[(&plate, None, white), (&above, texture, look)]))
    };
    let masked = draw(Some(&strips), [1.0; 4], Alpha::Mask(0.5));
    // Beside all shadows.
    let lit = masked.at(&scene.camera, Vec3::new(-0.8, 1.2, 0.0)).x;
    assert!(lit > 0.5, "{lit}");
    assert!(below(&masked, -0.25) < 0.05 * lit, "the shadow of what is left");
    assert!((below(&masked, 0.25) - lit).abs() < 0.1 * lit, "no shadow of what is cut");
    let [clear, dense] = [0.4, 0.6].map(|alpha| draw(None, [1.0, 1.0, 1.0, alpha], Alpha::Blend));
    assert!((below(&clear, 0.0) - lit).abs() < 0.1 * lit, "{}", below(&clear, 0.0));
    assert!(below(&dense, 0.0) < 0.05 * lit, "{}", below(&dense, 0.0));
}

#[test]
fn parts_of_faces_are_tinted_by_the_factor_and_ignore_alpha() {
    let Some(gpu) = gpu() else { return };
    let mesh = square(Vec3::ZERO, 1.0);
    let (solid, clear) = (plain([200, 150, 90, 255]), plain([200, 150, 90, 40]));
    let scene: Scene = lit_scene(scene(4.0).camera, bare_light(Environment::uniform([0.5; 3])));
    for (name, shading) in shadings() {
        let draw = |color: &Image, base_color| {
            let textures = PartTextures { color: Some(color), ..PartTextures::default() };
            let avatar = model(gpu, &[part(&mesh, PartKind::Skin, textures)]);
            let standard = Some(Standard { base_color, ..Standard::default() });
            let skin = Material { standard, reflectance: 0.0, ..Material::of(PartKind::Skin) };
            avatar.0.set_material(&gpu.queue, 0, &skin).expect("a part");
            light_of(shading, 32, &scene, &avatar).middle()
        };
        let white = draw(&solid, [1.0; 4]);
        assert_eq!(draw(&clear, [1.0; 4]), white, "{name}");
        assert!(draw(&solid, [0.5, 1.0, 1.0, 1.0]).x < 0.8 * white.x, "{name}");
    }
}
