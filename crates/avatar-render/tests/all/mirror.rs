//! A mirrored face under mirrored light is a mirrored picture, however lopsided both are.

use crate::common;
use crate::common::stage::{light_of, lit_scene};
use crate::common::{Random, ball, gpu, model, part, shadings, square};
use avatar_mesh::{Mesh, PartKind, Skinning};
use avatar_render::headless::Gpu;
use avatar_render::{
    AvatarModel, AvatarState, Camera, Environment, Image, Lamp, Light, Panel, PartBones, PartDesc,
    PartTextures, Shading, Terms, ToneMap,
};
use glam::{Affine3A, Vec3};

const SIZE: u32 = 80;

const MIRROR: Vec3 = Vec3::new(-1.0, 1.0, 1.0);

/// The mesh at the other side of x = 0, wound outward again.
fn mirror_mesh(mesh: &Mesh) -> Mesh {
    Mesh {
        positions: mesh.positions.iter().map(|p| *p * MIRROR).collect(),
        normals: mesh.normals.iter().map(|n| *n * MIRROR).collect(),
        triangles: mesh.triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect(),
        ..mesh.clone()
    }
}

fn mirror_light(light: &Light) -> Light {
    let lamp = |lamp: Lamp| Lamp { direction_world: lamp.direction_world * MIRROR, ..lamp };
    let panel = |panel: Panel| Panel { direction_world: panel.direction_world * MIRROR, ..panel };
    let environment = Environment { panels: light.environment.panels.map(panel), ..light.environment };
    Light { key: lamp(light.key), fill: lamp(light.fill), rim: lamp(light.rim), environment, ..*light }
}

/// Nothing of it is its own mirror image.
fn lopsided_light() -> Light {
    let lamp = |x, y, z, radiance| Lamp { direction_world: Vec3::new(x, y, z), radiance };
    let panel = |x, y, z, radius_rad| Panel {
        direction_world: Vec3::new(x, y, z),
        radius_rad,
        radiance: [1.5, 1.2, 0.8],
    };
    Light {
        key: lamp(0.9, 0.5, 0.7, [1.0, 0.9, 0.8]),
        fill: lamp(-0.5, -0.3, 0.9, [0.2, 0.25, 0.3]),
        rim: lamp(0.7, 0.6, -0.5, [0.5, 0.6, 0.7]),
        environment: Environment {
            panels: [
                panel(0.8, 0.1, 0.6, 0.4),
                panel(-0.3, 0.9, 0.2, 0.3),
                panel(0.5, -0.8, 0.4, 0.5),
                Panel::OFF,
            ],
            ..Environment::STUDIO
        },
        exposure: 0.8,
        tone_map: ToneMap::Linear,
    }
}

/// A bumpy head with a tilted row of teeth on one side of its front and an eye on the other.
fn head() -> [(PartKind, Mesh); 4] {
    let mut skin = ball(Vec3::new(0.1, 0.0, -0.9), 1.0, 28);
    for p in &mut skin.positions {
        let bumps = (7.0 * p.x + 1.0).sin() * (5.0 * p.y - 0.5).cos() * (6.0 * p.z + 2.0 * p.x).sin();
        *p += 0.07 * bumps * (*p - Vec3::new(0.1, 0.0, -0.9));
    }
    let mut mesh = ball(Vec3::new(0.35, 0.25, 0.05), 0.3, 16);
    // The poles of balls are above and below, those of eyes in front: painted around that axis.
    mesh.uvs = mesh.normals.iter().map(|n| 0.5 + 0.3 * n.truncate()).collect();
    let mut teeth = square(Vec3::new(-0.3, -0.35, 0.2), 0.25);
    teeth.positions.iter_mut().for_each(|p| p.z += 0.3 * p.x + 0.1 * p.y);
    let cornea = cap(Vec3::new(0.35, 0.25, 0.17), 0.2, 0.15);
    [
        (PartKind::Skin, skin),
        (PartKind::Eyeball, mesh),
        (PartKind::Cornea, cornea),
        (PartKind::Surface, teeth),
    ]
}

/// The part of a ball in front of its middle that is at most `widest` away from its axis.
fn cap(center: Vec3, radius: f32, widest: f32) -> Mesh {
    let mut mesh = ball(center, radius, 24);
    let inside = |i: &u32| {
        let from = mesh.positions[*i as usize] - center;
        from.z > 0.0 && from.truncate().length() <= widest
    };
    let kept: Vec<[u32; 3]> = mesh.triangles.iter().filter(|t| t.iter().all(inside)).copied().collect();
    // Vertices that no triangle names would count as part of the cornea's shape.
    let used: Vec<u32> = kept.iter().flatten().copied().collect();
    mesh.positions = used.iter().map(|i| mesh.positions[*i as usize]).collect();
    mesh.normals = used.iter().map(|i| mesh.normals[*i as usize]).collect();
    mesh.uvs = used.iter().map(|i| mesh.uvs[*i as usize]).collect();
    mesh.triangles = (0..kept.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    mesh
}

/// A smooth normal map and colours, neither of which is its own mirror image.
fn painting() -> [Image; 2] {
    let paint = |color: fn(f32, f32) -> [f32; 3]| {
        let pixels = (0..64 * 64).flat_map(|i| {
            let [r, g, b] = color((i % 64) as f32 / 64.0, (i / 64) as f32 / 64.0);
            [r, g, b, 1.0].map(|value| (value * 255.0) as u8)
        });
        Image { width: 64, height: 64, rgba: pixels.collect() }
    };
    const TURN: f32 = std::f32::consts::TAU;
    [
        paint(|u, v| {
            [0.5 + 0.4 * (TURN * (2.0 * u + v)).sin(), 0.5 + 0.3 * (TURN * 3.0 * u).cos(), 0.3 + 0.5 * v]
        }),
        paint(|u, v| [0.5 + 0.15 * (TURN * 4.0 * u).sin(), 0.5 + 0.1 * (TURN * (3.0 * v + u)).cos(), 0.97]),
    ]
}

fn avatar(gpu: &Gpu, meshes: &[(PartKind, Mesh)]) -> (AvatarModel, AvatarState) {
    let [color, normal] = painting();
    let textures = PartTextures { color: Some(&color), normal: Some(&normal), ..PartTextures::default() };
    let parts: Vec<_> = meshes
        .iter()
        .map(|(kind, mesh)| {
            let textures = if *kind == PartKind::Cornea { PartTextures::default() } else { textures };
            part(mesh, *kind, textures)
        })
        .collect();
    model(gpu, &parts)
}

#[test]
fn a_mirrored_head_in_mirrored_light_is_a_mirrored_picture() {
    let Some(gpu) = gpu() else { return };
    let meshes = head();
    let mirrored = meshes.clone().map(|(kind, mesh)| (kind, mirror_mesh(&mesh)));
    let (one, other) = (avatar(gpu, &meshes), avatar(gpu, &mirrored));
    let light = lopsided_light();
    // The eye is one whose iris is refracted.
    let [with, without] = [true, false].map(|eye_optics| {
        let scene = lit_scene(Camera::orbit(Vec3::new(0.35, 0.25, 0.2), 1.2, 0.4, 0.0, 0.5, 1.0), light);
        light_of(Shading::Natural(Terms { eye_optics, ..Terms::NONE }), SIZE, &scene, &one)
    });
    assert!(with.difference_share(&without, 0.012) > 0.05);
    let (yaw, pitch) = (0.7, 0.3);
    let scene = |yaw, light| lit_scene(Camera::orbit(Vec3::ZERO, 5.0, yaw, pitch, 0.5, 1.0), light);
    for (name, shading) in shadings() {
        let here = light_of(shading, SIZE, &scene(yaw, light), &one);
        let there = light_of(shading, SIZE, &scene(-yaw, mirror_light(&light)), &other).flipped();
        // Three of 255 steps where the light is 1. Edges of triangles, shadows and tones may fall to either
        // side.
        let share = here.difference_share(&there, 0.012);
        assert!(share < 0.01, "{name}, yaw {yaw}: {share}");
        // The same head from the same side is something else: the comparison can tell.
        let not_mirrored = light_of(shading, SIZE, &scene(-yaw, light), &one).flipped();
        assert!(here.difference_share(&not_mirrored, 0.012) > 0.2, "{name}, yaw {yaw}");
    }
}

#[test]
fn a_bone_that_mirrors_draws_what_a_mirrored_mesh_does() {
    let Some(gpu) = gpu() else { return };
    let meshes = head();
    let mirrored = meshes.clone().map(|(kind, mesh)| (kind, mirror_mesh(&mesh)));
    let (mut one, other) = (avatar(gpu, &meshes), avatar(gpu, &mirrored));
    one.1.set(&gpu.queue, &[Affine3A::from_scale(MIRROR)], &[]).expect("lengths fit");
    for (name, shading) in shadings() {
        for yaw in [0.0, 0.8, -1.9] {
            let scene = lit_scene(Camera::orbit(Vec3::ZERO, 5.0, yaw, 0.3, 0.5, 1.0), lopsided_light());
            let by_bone = light_of(shading, SIZE, &scene, &one);
            let by_mesh = light_of(shading, SIZE, &scene, &other);
            let share = by_bone.difference_share(&by_mesh, 0.004);
            assert!(share < 0.002, "{name}, yaw {yaw}: {share}");
        }
    }
    // And back again: the same bytes as before.
    one.1.set(&gpu.queue, &[Affine3A::IDENTITY], &[]).expect("lengths fit");
    let untouched = avatar(gpu, &meshes);
    let scene = lit_scene(Camera::orbit(Vec3::ZERO, 5.0, 0.8, 0.3, 0.5, 1.0), lopsided_light());
    let [again, first] = [&one, &untouched].map(|avatar| light_of(shadings()[3].1, SIZE, &scene, avatar));
    assert_eq!(again.difference_share(&first, 0.0), 0.0);
}

/// Two parts of one mesh, each with its own bone; the second one's triangles are the first one's shifted.
fn pair(mesh: &Mesh, shift: Vec3) -> Mesh {
    let count = mesh.positions.len();
    let mut both = mesh.clone();
    both.positions.extend(mesh.positions.iter().map(|p| *p + shift));
    both.normals.extend(&mesh.normals);
    both.uvs.extend(&mesh.uvs);
    both.triangles.extend(mesh.triangles.iter().map(|t| t.map(|corner| corner + count as u32)));
    let of = |bone: u16| vec![[bone, 0, 0, 0]; count];
    both.skinning = Some(Skinning {
        bones: [of(0), of(1)].concat(),
        weights: vec![[1.0, 0.0, 0.0, 0.0]; 2 * count],
        ..Skinning::default()
    });
    both
}

#[test]
fn one_part_can_have_bones_that_mirror_and_others() {
    let Some(gpu) = gpu() else { return };
    let [(_, skin), ..] = head();
    let shift = Vec3::X * 1.6;
    let both = pair(&skin, shift);
    let moved = |mesh: &Mesh, by: Vec3| Mesh {
        positions: mesh.positions.iter().map(|p| *p + by).collect(),
        ..mesh.clone()
    };
    let halves = [moved(&mirror_mesh(&skin), -shift), moved(&skin, shift)];
    for kind in [PartKind::Skin, PartKind::Surface, PartKind::Eyeball] {
        let skinned = PartDesc { bones: PartBones::PerVertex, ..part(&both, kind, PartTextures::default()) };
        let one = AvatarModel::new(&gpu.device, &gpu.queue, &[skinned], 2).expect("valid");
        let mut state = AvatarState::new(&gpu.device, &one);
        let bones = [Affine3A::from_translation(-shift) * Affine3A::from_scale(MIRROR), Affine3A::IDENTITY];
        state.set(&gpu.queue, &bones, &[]).expect("lengths fit");
        let apart = [&halves[0], &halves[1]].map(|half| part(half, kind, PartTextures::default()));
        let (one, other) = ((one, state), model(gpu, &apart));
        // Plain shading knows nothing of what differs between one part and two, as its height.
        for shading in [Shading::Plain, Shading::Toon] {
            let scene = lit_scene(Camera::orbit(Vec3::ZERO, 7.0, 0.4, 0.3, 0.6, 1.0), lopsided_light());
            let here = light_of(shading, SIZE, &scene, &one);
            let there = light_of(shading, SIZE, &scene, &other);
            let share = here.difference_share(&there, 0.004);
            assert!(share < 0.002, "{kind:?} {shading:?}: {share}");
        }
    }
}

#[test]
fn the_mirror_of_a_random_light_is_found_for_each_lamp_alone() {
    let Some(gpu) = gpu() else { return };
    let meshes = head();
    let mirrored = meshes.clone().map(|(kind, mesh)| (kind, mirror_mesh(&mesh)));
    let (one, other) = (avatar(gpu, &meshes), avatar(gpu, &mirrored));
    let mut random = Random(11);
    let camera = Camera::orbit(Vec3::ZERO, 5.0, 0.0, 0.0, 0.5, 1.0);
    for (name, shading) in shadings() {
        for place in 0..3 {
            let mut lamps = [common::stage::NO_LAMP; 3];
            lamps[place] = Lamp { direction_world: random.unit(), radiance: [1.0; 3] };
            let [key, fill, rim] = lamps;
            let light =
                Light { key, fill, rim, ..common::stage::bare_light(Environment::uniform([0.05; 3])) };
            let here = light_of(shading, SIZE, &lit_scene(camera, light), &one);
            let there = light_of(shading, SIZE, &lit_scene(camera, mirror_light(&light)), &other).flipped();
            let share = here.difference_share(&there, 0.012);
            assert!(share < 0.01, "{name}, lamp {place} {}: {share}", lamps[place].direction_world);
        }
    }
}
