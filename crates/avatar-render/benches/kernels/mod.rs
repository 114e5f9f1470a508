//! Compute passes beside a plain kernel that copies, vec4 by vec4, so that it reads and writes as many bytes.

use avatar_render::headless::Gpu;
use std::time::Instant;

const COPY: &str = "
@group(0) @binding(0) var<storage, read> source: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> copied: array<vec4f>;

@compute @workgroup_size(64)
fn copy_main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < arrayLength(&copied); i += groups.x * 64u) {
        copied[i] = source[i];
    }
}
";

/// Kernels per submission: what a submission costs by itself is little beside them.
const REPEATS: u32 = 8;

/// A submission's time by the clock.
fn timed(gpu: &Gpu, record: impl Fn(&mut wgpu::CommandEncoder)) -> f64 {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    record(&mut encoder);
    let commands = encoder.finish();
    let start = Instant::now();
    gpu.queue.submit([commands]);
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("done");
    start.elapsed().as_secs_f64()
}

/// Seconds that one of these passes and a plain kernel take that reads and writes as many bytes, medians of
/// rounds in turns.
pub(crate) fn pass_and_copy(
    gpu: &Gpu,
    bytes: usize,
    rounds: usize,
    record: impl Fn(&mut wgpu::CommandEncoder),
) -> (f64, f64) {
    let device = &gpu.device;
    let size = (bytes as u64 / 2).next_multiple_of(16);
    let buffer = || {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("bench: copy"),
            size,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        })
    };
    let (source, copied) = (buffer(), buffer());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("bench: copy"),
        source: wgpu::ShaderSource::Wgsl(COPY.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("bench: copy"),
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("bench: copy"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: source.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: copied.as_entire_binding() },
        ],
    });
    let copy = |encoder: &mut wgpu::CommandEncoder| {
        for _ in 0..REPEATS {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups((size / 16).div_ceil(64).min(65_535) as u32, 1, 1);
        }
    };
    let work = |encoder: &mut wgpu::CommandEncoder| (0..REPEATS).for_each(|_| record(encoder));
    let (mut empty, mut working, mut copying) = (Vec::new(), Vec::new(), Vec::new());
    // The first of each makes what is made at the first use.
    timed(gpu, work);
    timed(gpu, copy);
    for _ in 0..2 * rounds {
        empty.push(timed(gpu, |_| {}));
        working.push(timed(gpu, work));
        copying.push(timed(gpu, copy));
    }
    let floor = median(&mut empty);
    let each = |times: &mut [f64]| (median(times) - floor).max(1e-9) / f64::from(REPEATS);
    (each(&mut working), each(&mut copying))
}

/// The one in the middle.
pub(crate) fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}
