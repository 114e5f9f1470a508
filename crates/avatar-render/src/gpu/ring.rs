//! Uniforms of several draws in one buffer.

use super::buffers::written_buffer;
use std::num::NonZeroU64;
use std::sync::atomic::{AtomicU64, Ordering};

/// Room for several values in one uniform buffer, bound with a dynamic offset. A write to a buffer takes
/// effect before the whole submission, so two draws that are submitted together must not share a slot.
#[derive(Debug)]
pub(crate) struct Ring<T> {
    pub(crate) buffer: wgpu::Buffer,
    next: AtomicU64,
    of: std::marker::PhantomData<fn(T)>,
}

/// Frames that may be recorded before one submission.
pub(crate) const FRAME_SLOTS: u32 = 256;

/// A run of slots in a ring, by the number of the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reserved(u64);

impl<T: bytemuck::Pod> Ring<T> {
    /// WebGPU's default alignment of dynamic offsets.
    const SLOT_BYTES: u32 = (size_of::<T>() as u32).next_multiple_of(256);
    const FOR_TESTS: wgpu::BufferUsages =
        if cfg!(test) { wgpu::BufferUsages::COPY_SRC } else { wgpu::BufferUsages::empty() };
    /// Size of the binding.
    pub(crate) const BYTES: Option<NonZeroU64> = NonZeroU64::new(size_of::<T>() as u64);

    pub(crate) fn new(device: &wgpu::Device, label: &str, slots_per_frame: u32) -> Self {
        let size = u64::from(Self::SLOT_BYTES * FRAME_SLOTS * slots_per_frame);
        let buffer = written_buffer(device, label, size, wgpu::BufferUsages::UNIFORM | Self::FOR_TESTS);
        Self { buffer, next: AtomicU64::new(0), of: std::marker::PhantomData }
    }

    /// The binding of one slot; the dynamic offset chooses it.
    pub(crate) fn binding(&self) -> wgpu::BindingResource<'_> {
        let buffer = &self.buffer;
        wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size: Self::BYTES })
    }

    /// Writes a value into the next slot and returns its offset for the bind group.
    pub(crate) fn push(&self, queue: &wgpu::Queue, value: &T) -> u32 {
        let first = self.reserve(1);
        self.write(queue, first, 0, value)
    }

    /// Reserves the next `count` slots, which must not be more than the ring has.
    pub(crate) fn reserve(&self, count: u32) -> Reserved {
        Reserved(self.next.fetch_add(count.into(), Ordering::Relaxed))
    }

    /// Writes a value into one of the slots that are reserved and returns its offset for the bind group.
    pub(crate) fn write(&self, queue: &wgpu::Queue, reserved: Reserved, index: u32, value: &T) -> u32 {
        let offset = self.offset(reserved, index);
        queue.write_buffer(&self.buffer, u64::from(offset), bytemuck::bytes_of(value));
        offset
    }

    /// The offset of a reserved slot.
    pub(crate) fn offset(&self, reserved: Reserved, index: u32) -> u32 {
        let slots = self.buffer.size() / u64::from(Self::SLOT_BYTES);
        ((reserved.0 + u64::from(index)) % slots) as u32 * Self::SLOT_BYTES
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::device::{Gpu, gpu_for_tests};
    use crate::gpu::readback::mapped;
    use pollster::block_on;

    /// The first number in each slot, after `also` was submitted together with what reads them.
    fn slots(gpu: &Gpu, ring: &Ring<[u32; 4]>, also: usize) -> Vec<u8> {
        let size = ring.buffer.size();
        let buffer = || {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("readable"),
                size,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let readable = buffer();
        let encoder =
            || gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("slots") });
        let mut commands = vec![encoder()];
        commands[0].copy_buffer_to_buffer(&ring.buffer, 0, &readable, 0, size);
        commands.extend((0..also).map(|_| {
            let mut encoder = encoder();
            encoder.clear_buffer(&buffer(), 0, Some(16));
            encoder
        }));
        gpu.queue.submit(commands.into_iter().map(wgpu::CommandEncoder::finish).collect::<Vec<_>>());
        let view = block_on(mapped(&gpu.device, &readable)).expect("mapped");
        view.chunks_exact(Ring::<[u32; 4]>::SLOT_BYTES as usize).map(|slot| slot[0]).collect()
    }

    #[allow(clippy::disallowed_methods, reason = "the test is about threads")]
    #[test]
    fn a_slot_keeps_its_value_while_another_thread_submits() {
        let Some(gpu) = gpu_for_tests() else { return };
        for round in 0..100 {
            let ring = Ring::new(&gpu.device, "ring", 1);
            let start = std::sync::Barrier::new(2);
            std::thread::scope(|scope| {
                scope.spawn(|| {
                    start.wait();
                    // Long enough for the other to write meanwhile.
                    slots(&gpu, &ring, 100);
                });
                start.wait();
                for _ in 0..FRAME_SLOTS {
                    ring.push(&gpu.queue, &[7; 4]);
                }
            });
            let lost = slots(&gpu, &ring, 0).iter().filter(|value| **value != 7).count();
            assert_eq!(lost, 0, "round {round}");
        }
    }

    #[test]
    fn slots_that_are_reserved_are_different_ones_until_all_are_used() {
        let Some(gpu) = gpu_for_tests() else { return };
        let ring: Ring<[u32; 4]> = Ring::new(&gpu.device, "ring", 3);
        // Also after billions of frames.
        ring.next.store(u64::from(u32::MAX) - 5, Ordering::Relaxed);
        let reserved = [700, 60, 8].map(|count| (ring.reserve(count), count));
        let offsets: std::collections::BTreeSet<u32> =
            reserved.iter().flat_map(|(first, count)| (0..*count).map(|i| ring.offset(*first, i))).collect();
        assert_eq!(offsets.len(), 768);
        assert!(offsets.iter().all(|offset| u64::from(*offset) < ring.buffer.size()));
    }
}
