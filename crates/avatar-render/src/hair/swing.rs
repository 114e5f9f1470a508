//! Motion of hair: guides swing behind the head, and the strands of their locks follow.

use crate::gpu::bindings::{storage_entry, uniform_entry};
use crate::gpu::buffers::written_buffer;
use crate::gpu::pipeline::compute_pipeline;
use crate::hair::programs::SWING_PASS;
use crate::hair::uniforms::{GROW_WORKGROUP_SIZE, POINT_STRIDE};
use avatar_groom::{Oscillator, SEGMENTS, TICKS_PER_SECOND, TickClock, Ticks};
use bytemuck::{Pod, Zeroable};
use std::sync::atomic::{AtomicBool, Ordering};

/// WGSL `Swing`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GpuSwing {
    pub(crate) ticks: u32,
    pub(crate) first: f32,
    pub(crate) step: f32,
    pub(crate) rest: f32,
    pub(crate) tick: f32,
    pub(crate) is_still: u32,
    pub(crate) pad: [f32; 2],
    pub(crate) oscillators: [[f32; 4]; SEGMENTS + 1],
}

/// WGSL `Mote`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GpuMote {
    pub(crate) position: [f32; 3],
    pub(crate) pad_0: f32,
    pub(crate) velocity: [f32; 3],
    pub(crate) pad_1: f32,
    pub(crate) held: [f32; 3],
    pub(crate) pad_2: f32,
    pub(crate) held_at_frame: [f32; 3],
    pub(crate) pad_3: f32,
}

/// The motion of one avatar's hair.
#[derive(Debug)]
pub(crate) struct SwingState {
    uniform: wgpu::Buffer,
    pub(crate) offsets: wgpu::Buffer,
    group: wgpu::BindGroup,
    guide_count: u32,
    oscillators: [[f32; 4]; SEGMENTS + 1],
    /// The clock at the last frame that was drawn.
    drawn: TickClock,
    /// Seconds since then; NaN if hair is to hang still.
    seconds: f64,
    /// Whether the motes are where the guides were at the last frame.
    has_begun: bool,
    is_moving: bool,
    /// Whether time was set for which no pass is recorded yet.
    is_due: AtomicBool,
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let compute = wgpu::ShaderStages::COMPUTE;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("swing hair"),
        entries: &[
            uniform_entry(0, compute),
            storage_entry(1, compute, true),
            storage_entry(2, compute, false),
            storage_entry(3, compute, false),
        ],
    })
}

pub(crate) fn swing_pipeline(device: &wgpu::Device) -> wgpu::ComputePipeline {
    compute_pipeline(device, &SWING_PASS, &[&layout(device)], &[])
}

impl SwingState {
    /// For guides whose tips swing `frequency` times a second.
    pub(crate) fn new(
        device: &wgpu::Device,
        guides: &wgpu::Buffer,
        guide_count: u32,
        frequency: f32,
    ) -> Self {
        let points = u64::from(guide_count.max(1)) * POINT_STRIDE as u64;
        let buffer = |label, size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let storage = wgpu::BufferUsages::STORAGE;
        let bytes = size_of::<GpuSwing>() as u64;
        let uniform = written_buffer(device, "hair: swing", bytes, wgpu::BufferUsages::UNIFORM);
        let motes = buffer("hair: motes", points * size_of::<GpuMote>() as u64, storage);
        let copied = storage | wgpu::BufferUsages::COPY_SRC;
        let offsets = buffer("hair: offsets of guides", points * size_of::<[f32; 4]>() as u64, copied);
        let buffers = [&uniform, guides, &motes, &offsets];
        let entries: Vec<_> = (0u32..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("swing hair"),
            layout: &layout(device),
            entries: &entries,
        });
        let oscillators = Oscillator::along(frequency).map(|spring| {
            let Oscillator { place, speed } = spring;
            [place[0], place[1], speed[0], speed[1]]
        });
        Self {
            uniform,
            offsets,
            group,
            guide_count,
            oscillators,
            drawn: TickClock::default(),
            seconds: f64::NAN,
            has_begun: false,
            is_moving: false,
            is_due: AtomicBool::new(false),
        }
    }

    /// Whether strands are where their guides swing to, and not where they grow.
    pub(crate) fn is_moving(&self) -> bool {
        self.is_moving
    }

    /// Whether time was set that no pass has spent yet.
    pub(crate) fn is_due(&self) -> bool {
        self.is_due.load(Ordering::Relaxed)
    }

    /// Lets the next pass spend the time that the last one spent, for work that was lost. Later times are
    /// added to it.
    pub(crate) fn redo(&self) {
        if self.has_begun {
            self.is_due.store(true, Ordering::Relaxed);
        }
    }

    /// Whether hair hangs still as if no time had ever passed.
    pub(crate) fn is_stopped(&self) -> bool {
        !self.has_begun
    }

    pub(crate) fn stop(&mut self) {
        (self.has_begun, self.is_moving) = (false, false);
    }

    /// Lets time pass until the next frame. If `dt_secs` is negative, above 0.5 or NaN, hair hangs still
    /// where the head is then.
    pub(crate) fn advance(&mut self, queue: &wgpu::Queue, dt_secs: f64) {
        let dt_secs = if self.has_begun { dt_secs } else { f64::NAN };
        self.has_begun = true;
        if self.is_due.swap(true, Ordering::Relaxed) {
            // The last time was never drawn: both add up.
            self.seconds += dt_secs;
        } else {
            self.drawn.advance(self.seconds);
            self.seconds = dt_secs;
        }
        let Ticks { count, first, step, rest, is_still } = { self.drawn }.advance(self.seconds);
        self.is_moving = !is_still;
        let swing = GpuSwing {
            ticks: count,
            first,
            step,
            rest: rest as f32,
            tick: 1.0 / TICKS_PER_SECOND,
            is_still: is_still.into(),
            pad: [0.0; 2],
            oscillators: self.oscillators,
        };
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&swing));
    }

    /// Records the motion of guides, once after each change of the time. `pipeline` is asked for then alone.
    pub(crate) fn record<'a>(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        pipeline: impl FnOnce() -> &'a wgpu::ComputePipeline,
    ) {
        if self.is_due.swap(false, Ordering::Relaxed) {
            pass.set_pipeline(pipeline());
            pass.set_bind_group(0, &self.group, &[]);
            pass.dispatch_workgroups(self.guide_count.div_ceil(GROW_WORKGROUP_SIZE), 1, 1);
        }
    }
}
