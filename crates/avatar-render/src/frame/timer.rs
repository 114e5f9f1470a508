//! Measures passes.

use crate::frame::passes::{FRAME_PASSES, Pass};
use crate::gpu::readback::{ReadbackError, mapped};

/// Measures how long the passes of a frame take on the GPU, where the device has
/// [`wgpu::Features::TIMESTAMP_QUERY`].
#[derive(Debug)]
pub struct PassTimer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readable: wgpu::Buffer,
    nanoseconds_per_tick: f32,
}

/// Which part of a pass of the frame a render pass covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Span {
    /// All of it.
    Whole,
    /// The first of several: it notes the start.
    Start,
    /// Neither the first nor the last: it notes nothing.
    Between,
    /// The last of several: it notes the end.
    End,
}

impl Span {
    /// That of one of `count` render passes.
    pub(crate) fn of(index: usize, count: usize) -> Self {
        match (index == 0, index + 1 == count) {
            (true, true) => Self::Whole,
            (true, false) => Self::Start,
            (false, false) => Self::Between,
            (false, true) => Self::End,
        }
    }
}

const QUERIES: u32 = 2 * FRAME_PASSES.len() as u32;
/// Bytes from the times of one pass to those of the next: queries are resolved to aligned offsets only.
const PASS_BYTES: u64 = wgpu::QUERY_RESOLVE_BUFFER_ALIGNMENT;

impl PassTimer {
    /// A timer, or `None` where the device has no timestamps.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Option<Self> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let buffer = |label, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: FRAME_PASSES.len() as u64 * PASS_BYTES,
                usage,
                mapped_at_creation: false,
            })
        };
        Some(Self {
            queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("times of passes"),
                ty: wgpu::QueryType::Timestamp,
                count: QUERIES,
            }),
            resolved: buffer(
                "times of passes",
                wgpu::BufferUsages::QUERY_RESOLVE
                    | wgpu::BufferUsages::COPY_SRC
                    | wgpu::BufferUsages::COPY_DST,
            ),
            readable: buffer(
                "times of passes: readable",
                wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            ),
            nanoseconds_per_tick: queue.get_timestamp_period(),
        })
    }

    fn slots(pass: Pass) -> (u32, u32) {
        let place = FRAME_PASSES.iter().position(|other| *other == pass).unwrap_or(0) as u32;
        (2 * place, 2 * place + 1)
    }

    pub(crate) fn compute_pass(&self, pass: Pass) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let (start, end) = Self::slots(pass);
        Some(wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(start),
            end_of_pass_write_index: Some(end),
        })
    }

    pub(crate) fn render_pass(&self, pass: Pass, span: Span) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let (start, end) = Self::slots(pass);
        let (start, end) = match span {
            Span::Whole => (Some(start), Some(end)),
            Span::Start => (Some(start), None),
            Span::Between => return None,
            Span::End => (None, Some(end)),
        };
        Some(wgpu::RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: start,
            end_of_pass_write_index: end,
        })
    }

    /// Records that the times of these passes are kept, and those of earlier frames cleared.
    pub(crate) fn finish(&self, encoder: &mut wgpu::CommandEncoder, passes: impl Iterator<Item = Pass>) {
        encoder.clear_buffer(&self.resolved, 0, None);
        for (start, end) in passes.map(Self::slots) {
            let offset = u64::from(start / 2) * PASS_BYTES;
            encoder.resolve_query_set(&self.queries, start..end + 1, &self.resolved, offset);
        }
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readable, 0, self.readable.size());
    }

    /// Waits for the last frame that was submitted with this timer: names of its passes and how many
    /// nanoseconds each took. Passes that the shading does not need are missing.
    ///
    /// # Errors
    /// A lost device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read(&self, device: &wgpu::Device) -> Result<Vec<(&'static str, f64)>, ReadbackError> {
        pollster::block_on(self.read_async(device))
    }

    /// The same, for callers that cannot block.
    ///
    /// # Errors
    /// As above.
    pub async fn read_async(&self, device: &wgpu::Device) -> Result<Vec<(&'static str, f64)>, ReadbackError> {
        let view = mapped(device, &self.readable).await?;
        let ticks: &[u64] = bytemuck::cast_slice(&view);
        let period = f64::from(self.nanoseconds_per_tick);
        let per_pass = ticks.chunks_exact(PASS_BYTES as usize / size_of::<u64>());
        // The times of passes that did not run are 0.
        let ran = FRAME_PASSES.iter().zip(per_pass).filter(|(_, pair)| pair[1] != 0);
        let times = ran.map(|(pass, pair)| (pass.label(), pair[1].saturating_sub(pair[0]) as f64 * period));
        let times = times.collect();
        drop(view);
        self.readable.unmap();
        Ok(times)
    }
}
