//! Buffers.

/// Zeros to be written by the queue. wgpu would clear what was never written when a submission first binds it, and where another
/// thread writes in just that moment, it would clear what was written: this buffer is whole from the start.
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
