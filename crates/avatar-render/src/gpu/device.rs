use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// An opened GPU.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The instance that the adapter and all surfaces come from.
    pub instance: wgpu::Instance,
    /// The chosen adapter.
    pub adapter: wgpu::Adapter,
    /// Its device: WebGPU's default limits, but buffers and storage bindings as large as the adapter allows,
    /// and no optional features but timestamps.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Name, kind and driver of the adapter.
    pub info: wgpu::AdapterInfo,
    /// Errors of the device that no call returns, such as running out of memory.
    pub errors: GpuErrors,
}

/// The first error of a device that no call returned (wgpu alone would panic), and whether the device is
/// lost.
#[derive(Clone, Debug, Default)]
pub struct GpuErrors {
    first: Arc<Mutex<Option<String>>>,
    lost: Arc<AtomicBool>,
}

impl GpuErrors {
    /// The first error since the last call, if there was one.
    pub fn take(&self) -> Option<String> {
        self.slot().take()
    }

    /// Whether the device is lost, for whatever reason: nothing on it can be used any more, and another has
    /// to be opened.
    pub fn is_lost(&self) -> bool {
        self.lost.load(Ordering::Relaxed)
    }

    fn slot(&self) -> MutexGuard<'_, Option<String>> {
        self.first.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Collects the errors of a device from now on.
    fn listen(device: &wgpu::Device) -> Self {
        let errors = Self::default();
        let heard = errors.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            heard.slot().get_or_insert_with(|| error.to_string());
        }));
        let lost = Arc::clone(&errors.lost);
        device.set_device_lost_callback(move |_, _| lost.store(true, Ordering::Relaxed));
        errors
    }
}

/// Which adapters to consider.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GpuOptions {
    /// Graphics interfaces to look for adapters of.
    pub backends: wgpu::Backends,
    /// Only software adapters.
    pub software: bool,
}

impl Default for GpuOptions {
    /// All backends of this build; hardware is preferred, software is accepted.
    fn default() -> Self {
        Self { backends: wgpu::Instance::enabled_backend_features(), software: false }
    }
}

/// Why there is no GPU.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoAdapter {
    /// Nothing was found.
    #[error("expected a GPU adapter ({looked_for}), found none: {reason}")]
    NotFound {
        /// What was looked for.
        looked_for: String,
        /// What wgpu says.
        reason: String,
    },
    /// A limit of the adapter is below WebGPU's default.
    #[error("adapter {adapter:?}: expected {limit} of {expected}, as WebGPU promises, found {found}")]
    Limit {
        /// Name of the adapter.
        adapter: String,
        /// Name of the limit.
        limit: &'static str,
        /// WebGPU's default.
        expected: u64,
        /// What the adapter has.
        found: u64,
    },
    /// The adapter gives no device.
    #[error("adapter {adapter:?}: expected a device, found: {reason}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// What wgpu says.
        reason: String,
    },
}

/// Opens the best adapter, hardware before software.
///
/// # Errors
/// No adapter, or one with less than WebGPU's default limits.
pub async fn open(options: GpuOptions) -> Result<Gpu, NoAdapter> {
    // wgpu panics without a backend.
    if wgpu::Instance::enabled_backend_features().is_empty() {
        let reason = "this build has no backend for this platform".to_owned();
        return Err(NoAdapter::NotFound { looked_for: looked_for(options, false), reason });
    }
    let descriptor = wgpu::InstanceDescriptor {
        backends: options.backends,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    };
    open_with(wgpu::Instance::new(descriptor), options, None).await
}

/// Opens the best adapter that can show pictures on a surface of this instance.
///
/// # Errors
/// As [`open()`].
pub async fn open_for_surface(
    instance: wgpu::Instance,
    surface: &wgpu::Surface<'_>,
    options: GpuOptions,
) -> Result<Gpu, NoAdapter> {
    open_with(instance, options, Some(surface)).await
}

/// [`open()`] for callers without an executor.
///
/// # Errors
/// As [`open()`].
#[cfg(not(target_arch = "wasm32"))]
pub fn open_blocking(options: GpuOptions) -> Result<Gpu, NoAdapter> {
    pollster::block_on(open(options))
}

/// [`open_for_surface()`] for callers without an executor.
///
/// # Errors
/// As [`open()`].
#[cfg(not(target_arch = "wasm32"))]
pub fn open_for_surface_blocking(
    instance: wgpu::Instance,
    surface: &wgpu::Surface<'_>,
    options: GpuOptions,
) -> Result<Gpu, NoAdapter> {
    pollster::block_on(open_for_surface(instance, surface, options))
}

fn looked_for(options: GpuOptions, for_surface: bool) -> String {
    let kind = if options.software { "software" } else { "hardware or software" };
    let purpose = if for_surface { " that presents to the window" } else { "" };
    let backends: Vec<_> = options.backends.iter_names().map(|(name, _)| name.to_lowercase()).collect();
    format!("{kind}{purpose}, through {}", backends.join(", "))
}

async fn open_with(
    instance: wgpu::Instance,
    options: GpuOptions,
    surface: Option<&wgpu::Surface<'_>>,
) -> Result<Gpu, NoAdapter> {
    let request = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        force_fallback_adapter: options.software,
        compatible_surface: surface,
        ..Default::default()
    };
    let adapter = instance.request_adapter(&request).await.map_err(|error| NoAdapter::NotFound {
        looked_for: looked_for(options, surface.is_some()),
        reason: error.to_string(),
    })?;
    let info = adapter.get_info();
    let mut missing = None;
    wgpu::Limits::default().check_limits_with_fail_fn(&adapter.limits(), true, |limit, expected, found| {
        missing = Some(NoAdapter::Limit { adapter: info.name.clone(), limit, expected, found });
    });
    if let Some(missing) = missing {
        return Err(missing);
    }
    // Timestamps are optional: with them, passes can be measured.
    let required_features = adapter.features() & wgpu::Features::TIMESTAMP_QUERY;
    let offered = adapter.limits();
    // Large avatars need larger buffers than WebGPU's defaults allow. No other limit is raised: sizes of
    // textures and pictures are the same on all adapters.
    let required_limits = wgpu::Limits {
        max_buffer_size: offered.max_buffer_size,
        max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
        ..wgpu::Limits::default()
    };
    let descriptor = wgpu::DeviceDescriptor {
        label: Some("avatars"),
        required_features,
        required_limits,
        ..Default::default()
    };
    let (device, queue) = adapter
        .request_device(&descriptor)
        .await
        .map_err(|error| NoAdapter::NoDevice { adapter: info.name.clone(), reason: error.to_string() })?;
    let errors = GpuErrors::listen(&device);
    Ok(Gpu { instance, adapter, device, queue, info, errors })
}

/// The GPU for tests of this crate. Without one it prints why and returns `None`; with `MIMIK_REQUIRE_GPU=1`
/// it panics.
#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "a test may ask the environment how strict it is to be")]
pub(crate) fn gpu_for_tests() -> Option<Gpu> {
    use std::io::Write as _;
    match open_blocking(GpuOptions::default()) {
        Ok(gpu) => Some(gpu),
        Err(reason) => {
            let required = std::env::var("MIMIK_REQUIRE_GPU").is_ok_and(|value| value == "1");
            assert!(!required, "MIMIK_REQUIRE_GPU=1, but {reason}");
            let _ = writeln!(std::io::stderr(), "SKIPPED: {reason}");
            None
        }
    }
}
