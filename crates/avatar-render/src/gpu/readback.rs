//! Reading buffers back without an async runtime.

use std::future::Future;
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};

/// A buffer could not be read back from the GPU.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected to read a buffer back, found: {reason}")]
pub struct ReadbackError {
    /// What wgpu says.
    pub reason: String,
}

impl ReadbackError {
    fn new(reason: impl ToString) -> Self {
        Self { reason: reason.to_string() }
    }
}

#[derive(Default)]
struct Signal {
    result: Option<Result<(), wgpu::BufferAsyncError>>,
    waker: Option<Waker>,
}

/// Resolves when wgpu has called back.
#[derive(Clone, Default)]
struct Mapped(Arc<Mutex<Signal>>);

impl Mapped {
    fn signal(&self) -> MutexGuard<'_, Signal> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Future for Mapped {
    type Output = Result<(), wgpu::BufferAsyncError>;

    fn poll(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Self::Output> {
        let mut signal = self.signal();
        match signal.result.take() {
            Some(result) => Poll::Ready(result),
            None => {
                signal.waker = Some(context.waker().clone());
                Poll::Pending
            }
        }
    }
}

/// Maps a whole buffer for reading. Natively this waits for the GPU; in a browser it yields to the event
/// loop.
pub(crate) async fn mapped(
    device: &wgpu::Device,
    buffer: &wgpu::Buffer,
) -> Result<wgpu::BufferView, ReadbackError> {
    let done = Mapped::default();
    let notify = done.clone();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        let mut signal = notify.signal();
        signal.result = Some(result);
        if let Some(waker) = signal.waker.take() {
            waker.wake();
        }
    });
    device.poll(wgpu::PollType::wait_indefinitely()).map_err(ReadbackError::new)?;
    done.await.map_err(ReadbackError::new)?;
    buffer.get_mapped_range(..).map_err(ReadbackError::new)
}
