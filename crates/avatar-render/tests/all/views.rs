//! What faces the camera is seen and what does not is culled, from all sides, in every shading, whichever way
//! a mesh winds.

use crate::common::stage::{bare_light, key_light, light_of, lit_scene};
use crate::common::{ball, gpu, mirrored, model, part, plain, shadings, square};
use avatar_mesh::{Mesh, PartKind};
use avatar_render::{Camera, Environment, Lamp, Light, Material, PartTextures, Shading, Standard};
use glam::{Affine3A, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

const SIZE: u32 = 64;

/// The same triangles, wound the other way.
fn inside_out(mesh: &Mesh) -> Mesh {
    Mesh { triangles: mesh.triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect(), ..mesh.clone() }
}

fn both_windings(mesh: Mesh) -> [(&'static str, Mesh); 2] {
    let turned = inside_out(&mesh);
    [("wound outward", mesh), ("wound inward", turned)]
}

#[test]
fn every_view_shows_the_side_that_faces_it() {
    let Some(gpu) = gpu() else { return };
    // Three plates around the origin; each colour belongs to a direction.
    let colors = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]].map(plain);
    let front = square(Vec3::new(0.0, 0.0, 1.0), 1.0);
    let turned = |turn: Affine3A| Mesh {
        positions: front.positions.iter().map(|p| turn.transform_point3(*p)).collect(),
        normals: front.normals.iter().map(|n| turn.transform_vector3(*n)).collect(),
        ..front.clone()
    };
    let left = turned(Affine3A::from_rotation_y(FRAC_PI_2));
    let top = turned(Affine3A::from_rotation_x(-FRAC_PI_2));
    let plates = [front.clone(), left, top];
    let views = [
        (0.0, 0.0, Some(0)),
        (FRAC_PI_2, 0.0, Some(1)),
        (0.0, FRAC_PI_2, Some(2)),
        // From behind, from the right and from below only backs are there, which eyeballs do not show; behind
        // them are the insides of the opposite plates, culled as well.
        (PI, 0.0, None),
        (-FRAC_PI_2, 0.0, None),
        (0.0, -FRAC_PI_2, None),
    ];
    for way in 0..2 {
        let meshes = plates.clone().map(|plate| both_windings(plate)[way].clone());
        let parts: Vec<_> = (meshes.iter().zip(&colors))
            .map(|((_, mesh), color)| {
                let textures = PartTextures { color: Some(color), ..PartTextures::default() };
                part(mesh, PartKind::Eyeball, textures)
            })
            .collect();
        let avatar = model(gpu, &parts);
        for (name, shading) in shadings() {
            for (yaw, pitch, expected) in views {
                let camera = Camera::orbit(Vec3::ZERO, 5.0, yaw, pitch, 0.6, 1.0);
                let scene = lit_scene(camera, bare_light(Environment::uniform([1.0; 3])));
                let light = light_of(shading, SIZE, &scene, &avatar).middle();
                for channel in 0..3 {
                    let said = format!("{name}, {}: yaw {yaw}, pitch {pitch}: {light}", meshes[0].0);
                    match expected == Some(channel) {
                        true => assert!(light[channel] > 0.2, "{said}"),
                        false => assert!(light[channel] < 0.1, "{said}"),
                    }
                }
            }
        }
    }
}

#[test]
fn a_ball_is_seen_from_all_sides_and_never_its_inside() {
    let Some(gpu) = gpu() else { return };
    for (way, mesh) in both_windings(ball(Vec3::ZERO, 1.0, 16)) {
        for kind in [PartKind::Skin, PartKind::Eyeball, PartKind::Surface] {
            let avatar = model(gpu, &[part(&mesh, kind, PartTextures::default())]);
            for (name, shading) in shadings() {
                for (yaw, pitch) in [(0.3, 0.0), (-FRAC_PI_2, 0.0), (PI, 0.0), (0.0, -1.4)] {
                    let camera = Camera::orbit(Vec3::ZERO, 5.0, yaw, pitch, 0.6, 1.0);
                    // From the eye: lit where normals point outward, dark on insides.
                    let scene = lit_scene(camera, key_light(camera.eye()));
                    let [r, g, b] = light_of(shading, SIZE, &scene, &avatar).middle().to_array();
                    let said = format!("{name}, {way}, {kind:?}: yaw {yaw}, pitch {pitch}: {r} {g} {b}");
                    assert!(r > 0.15 && g > 0.09 && b > 0.07, "{said}");
                }
            }
        }
    }
}

#[test]
fn skin_and_teeth_are_seen_from_behind_and_teeth_are_lit_there() {
    let Some(gpu) = gpu() else { return };
    for (way, sheet) in both_windings(square(Vec3::ZERO, 1.0)) {
        let light = Light {
            key: Lamp { direction_world: Vec3::NEG_Z, radiance: [1.0; 3] },
            ..bare_light(Environment::uniform([0.3; 3]))
        };
        for (yaw, pitch) in [(PI, 0.0), (2.5, 0.4)] {
            let scene = lit_scene(Camera::orbit(Vec3::ZERO, 5.0, yaw, pitch, 0.6, 1.0), light);
            for (name, shading) in shadings() {
                let seen = |kind| {
                    let avatar = model(gpu, &[part(&sheet, kind, PartTextures::default())]);
                    light_of(shading, SIZE, &scene, &avatar).middle().x
                };
                let (teeth, skin) = (seen(PartKind::Surface), seen(PartKind::Skin));
                assert!(teeth > 0.6, "{name}, {way}, {yaw}: {teeth}");
                // The inside of the skin is a hollow that lamps do not reach: dark, but there, and not all
                // outline.
                assert!((0.04..0.15).contains(&skin), "{name}, {way}, {yaw}: {skin}");
            }
        }
    }
}

#[test]
fn skin_of_a_file_is_seen_from_behind_where_the_file_says_so() {
    let Some(gpu) = gpu() else { return };
    let sheet = square(Vec3::ZERO, 1.0);
    let light = bare_light(Environment::uniform([0.3; 3]));
    let avatar = model(gpu, &[part(&sheet, PartKind::Skin, PartTextures::default())]);
    for (name, shading) in shadings() {
        let seen = |yaw, is_double_sided| {
            let scene = lit_scene(Camera::orbit(Vec3::ZERO, 5.0, yaw, 0.0, 0.6, 1.0), light);
            let standard = Some(Standard { is_double_sided, ..Standard::default() });
            let material = Material { standard, ..Material::of(PartKind::Skin) };
            avatar.0.set_material(&gpu.queue, 0, &material).expect("a part");
            light_of(shading, SIZE, &scene, &avatar).middle()
        };
        assert!(seen(0.0, false).min_element() > 0.1, "{name}");
        assert_eq!(seen(0.0, false), seen(0.0, true), "{name}");
        assert_ne!(seen(PI, true), Vec3::ZERO, "{name}");
        // Behind the outline of a cartoon are its back sides.
        let behind = if shading == Shading::Toon { seen(PI, true) } else { Vec3::ZERO };
        assert_eq!(seen(PI, false), behind, "{name}");
    }
}

#[test]
fn a_mirrored_part_with_the_indices_of_the_other_is_its_mirror_picture() {
    let Some(gpu) = gpu() else { return };
    let left = ball(Vec3::new(0.3, 0.1, 0.0), 0.9, 12);
    let right = mirrored(&left);
    // Light that is its own mirror picture.
    let lamp = |direction_world| Lamp { direction_world, radiance: [0.6; 3] };
    let light = Light {
        key: lamp(Vec3::new(0.0, 0.5, 0.8)),
        rim: lamp(Vec3::new(0.0, 0.4, -1.0)),
        ..bare_light(Environment { sky: [0.4; 3], ..Environment::uniform([0.1; 3]) })
    };
    let scene = lit_scene(Camera::orbit(Vec3::ZERO, 4.0, 0.0, 0.0, 0.6, 1.0), light);
    for kind in [PartKind::Eyeball, PartKind::Cornea, PartKind::Skin, PartKind::Surface] {
        let [one, other] =
            [&left, &right].map(|mesh| model(gpu, &[part(mesh, kind, PartTextures::default())]));
        for (name, shading) in shadings() {
            let one = light_of(shading, SIZE, &scene, &one);
            let other = light_of(shading, SIZE, &scene, &other);
            assert!(one.light.iter().any(|light| light.max_element() > 0.02), "{name}, {kind:?} is visible");
            let differing = one.difference_share(&other.flipped(), 0.012);
            // Pixels on an edge may fall to either side.
            assert!(differing < 0.01, "{name}, {kind:?}: {differing}");
        }
    }
}
