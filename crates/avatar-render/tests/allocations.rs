//! What a frame allocates. A program of its own: other tests would draw on the same device at the same time,
//! and what wgpu allocates depends on that.
#![allow(dead_code, reason = "it uses a share of the helpers")]

#[path = "all/common/mod.rs"]
mod common;

use avatar_mesh::PartKind;
use avatar_render::{PartTextures, Shading};
use common::stage::Stage;
use common::{ball, gpu, model, part, scene};
use glam::Vec3;
use wgpu::TextureFormat;

const FORMAT: TextureFormat = TextureFormat::Rgba8UnormSrgb;

/// What is allocated is wgpu's: as much for parts that are sorted by their distance as for parts that are
/// not.
#[test]
fn a_frame_allocates_no_list_of_what_it_draws() {
    let Some(gpu) = gpu() else { return };
    let mesh = ball(Vec3::ZERO, 1.0, 4);
    let allocations = |kind, avatars: usize| {
        let (model, state) = model(gpu, &[part(&mesh, kind, PartTextures::default())]);
        let stage = Stage::new(gpu, Shading::Plain, 8, FORMAT);
        let view = stage.texture.create_view(&Default::default());
        let avatars = vec![(&model, &state); avatars];
        let mut counts = [0; 8];
        for count in &mut counts {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let draw = || {
                let queue = &gpu.queue;
                let drawn =
                    stage.renderer.draw(&mut encoder, &view, &stage.targets, queue, &scene(4.0), &avatars);
                drawn.expect("what belongs together");
            };
            *count = allocation_counter::measure(draw).count_total;
            gpu.queue.submit([encoder.finish()]);
            // What wgpu uses again depends on whether the frame before has ended.
            gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the frame ends");
        }
        // The first frame is the one that fills wgpu's pools and our lists.
        counts[1..].iter().copied().min().unwrap_or_default()
    };
    for avatars in [1, 64, 1024] {
        let [clear, opaque] = [PartKind::Cornea, PartKind::Surface].map(|kind| allocations(kind, avatars));
        // What is clear is bound part by part, in a longer list of wgpu's.
        assert!(clear <= opaque + 2, "{avatars}: {clear} for what is clear, {opaque} for what is opaque");
        // wgpu's lists grow by doubling: nothing is allocated for each avatar.
        assert!(opaque < 100, "{avatars}: {opaque}");
    }
}
