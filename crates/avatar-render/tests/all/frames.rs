//! Frames of one renderer, one after the other: what is measured, and what is left over from the last one.

use crate::common::stage::Stage;
use crate::common::{ball, gpu, model, part, scene, shadings, skip};
use avatar_mesh::PartKind;
use avatar_render::{Environment, Light, PartTextures, PassTimer, Scene};
use glam::Vec3;

const SIZE: u32 = 48;
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// The passes of a frame as the crate's documentation lists them.
fn passes(shading: &str) -> &'static [&'static str] {
    match shading {
        "plain" => &["deform", "avatars"],
        "low" | "toon" => &["deform", "shadows", "avatars"],
        "medium" => &["deform", "shadows", "depth and normals", "ambient occlusion", "avatars"],
        _ => &[
            "deform",
            "shadows",
            "depth and normals",
            "ambient occlusion",
            "light on skin",
            "scatter across",
            "avatars",
        ],
    }
}

#[test]
fn a_timer_names_the_passes_that_ran_in_their_order() {
    let Some(gpu) = gpu() else { return };
    let (device, queue) = (&gpu.device, &gpu.queue);
    let Some(timer) = PassTimer::new(device, queue) else {
        skip("the device has no timestamps");
        return;
    };
    let mesh = ball(Vec3::ZERO, 1.0, 12);
    let (model, state) = model(gpu, &[part(&mesh, PartKind::Skin, PartTextures::default())]);
    // From the most passes to the fewest and back: what one leaves is not the next one's.
    let order = [3, 2, 1, 0, 4, 3];
    for (name, shading) in order.map(|i| shadings()[i]) {
        let stage = Stage::new(gpu, shading, SIZE, FORMAT);
        let view = stage.texture.create_view(&Default::default());
        let mut encoder = device.create_command_encoder(&Default::default());
        let avatars = [(&model, &state)];
        stage
            .renderer
            .draw_timed(&mut encoder, &view, &stage.targets, queue, &scene(4.0), &avatars, Some(&timer))
            .expect("what belongs together");
        queue.submit([encoder.finish()]);
        let times = timer.read(device).expect("times");
        let names: Vec<_> = times.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, passes(name), "{name}");
        // A second is long for so small a picture; every pass that runs takes some time.
        assert!(times.iter().all(|(_, nanoseconds)| (0.0..1e9).contains(nanoseconds)), "{name}: {times:?}");
        assert!(times.iter().map(|(_, nanoseconds)| nanoseconds).sum::<f64>() > 0.0, "{name}");
    }
}

#[test]
fn a_new_environment_leaves_nothing_of_the_old_one() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball(Vec3::ZERO, 1.0, 12);
    let eye = ball(Vec3::new(0.0, 0.0, 0.9), 0.4, 12);
    let none = PartTextures::default();
    let (model, state) =
        model(gpu, &[part(&mesh, PartKind::Skin, none), part(&eye, PartKind::Eyeball, none)]);
    let lit = |environment| Scene { light: Light { environment, ..Light::studio() }, ..scene(4.0) };
    let environments = [Environment::STUDIO, Environment::DAYLIGHT, Environment::DARK_ROOM];
    for (name, shading) in shadings() {
        let draw = |stage: &Stage, environment| stage.bytes(gpu, &lit(environment), &[(&model, &state)]);
        let one = Stage::new(gpu, shading, SIZE, FORMAT);
        let in_turn = environments.map(|environment| draw(&one, environment));
        let again = draw(&one, environments[0]);
        assert!(in_turn[0] == again, "{name}: back to the first");
        assert!(in_turn[0] != in_turn[1], "{name}: an environment is seen");
        let fresh = draw(&Stage::new(gpu, shading, SIZE, FORMAT), environments[2]);
        assert!(in_turn[2] == fresh, "{name}: after others");
    }
}

#[test]
fn frames_recorded_together_have_their_own_cameras_and_lamps() {
    let Some(gpu) = gpu() else { return };
    let (device, queue) = (&gpu.device, &gpu.queue);
    let mesh = ball(Vec3::ZERO, 1.0, 12);
    let (model, state) = model(gpu, &[part(&mesh, PartKind::Skin, PartTextures::default())]);
    let avatars = [(&model, &state)];
    for (name, shading) in shadings() {
        let scenes = [3.0, 5.0].map(|distance| {
            let mut scene = scene(distance);
            scene.light.key.direction_world.x *= 4.0 - distance;
            scene
        });
        let stage = Stage::new(gpu, shading, SIZE, FORMAT);
        let alone = scenes.map(|scene| stage.bytes(gpu, &scene, &avatars));
        // A target that is drawn into first and read last, and one that is drawn into in between.
        let other = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: stage.texture.size(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let together = stage.bytes_after(gpu, |encoder| {
            for (texture, scene) in [(&other, &scenes[1]), (&stage.texture, &scenes[0]), (&other, &scenes[1])]
            {
                let view = texture.create_view(&Default::default());
                stage
                    .renderer
                    .draw(encoder, &view, &stage.targets, queue, scene, &avatars)
                    .expect("what belongs together");
            }
        });
        assert!(together == alone[0], "{name}");
        assert!(alone[0] != alone[1], "{name}");
    }
}
