//! Buffers that the queue writes.

/// A buffer of zeros for the queue to write. It is mapped at creation, and so initialised from the start:
/// otherwise wgpu clears a buffer that was never written when a submission first binds it, and if another
/// thread writes at that moment, what it wrote is cleared as well.
pub(crate) fn written_buffer(
    device: &wgpu::Device,
    label: &str,
    size: u64,
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: true,
    });
    buffer.unmap();
    buffer
}
