//! The system's default devices.

use anyhow::{Context, Result, bail};
use cpal::traits::{DeviceTrait, HostTrait, StreamTrait};
use cpal::{
    BufferSize, Data, ErrorKind, FromSample, Sample, SampleFormat, SizedSample, StreamConfig,
    SupportedBufferSize, SupportedStreamConfig,
};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A device that does not answer for so long is none.
const PATIENCE: Duration = Duration::from_secs(3);
/// So many seconds of what was heard wait to be taken; older ones are lost.
const KEPT_SECS: u32 = 2;

/// Where the sound is: samples that were handed over, and when the last of them will be heard.
#[derive(Clone, Copy, Debug)]
struct Place {
    secs: f64,
    heard_at: Instant,
}

/// How many pieces of sound a second are asked for. Few come late: what is heard reaches the lips that much
/// later. Of many, some come too late on a busy machine, and a gap is heard.
const PLAYED_PIECES_HZ: u32 = 20;
const HEARD_PIECES_HZ: u32 = 50;

/// The same with so many pieces a second, where the device has such: usual ones may be seconds.
fn quick(supported: &SupportedStreamConfig, pieces_hz: u32) -> StreamConfig {
    let frames = supported.sample_rate() / pieces_hz;
    let buffer_size = match supported.buffer_size() {
        SupportedBufferSize::Range { min, max } if (*min..=*max).contains(&frames) => {
            BufferSize::Fixed(frames)
        }
        _ => BufferSize::Default,
    };
    StreamConfig { buffer_size, ..supported.config() }
}

/// Speakers that play a sound.
pub(crate) struct Speaker {
    _stream: cpal::Stream,
    place: Arc<Mutex<Option<Place>>>,
}

/// The device and how it wants its samples.
fn output() -> Result<(cpal::Device, SupportedStreamConfig)> {
    let device = cpal::default_host().default_output_device();
    let device = device.context("expected a device that plays sound, found none")?;
    let config = device.default_output_config().context("expected a device that plays sound")?;
    Ok((device, config))
}

impl Speaker {
    /// Samples a second that the default device wants.
    ///
    /// # Errors
    /// No device, or one that does not tell.
    pub(crate) fn rate_hz() -> Result<u32> {
        Ok(output()?.1.sample_rate())
    }

    /// Plays samples of one channel at the device's rate, after so many seconds of silence. `failed` is told
    /// if the device fails or vanishes later on.
    ///
    /// # Errors
    /// No device, one that cannot be opened, or another than that whose rate it was.
    pub(crate) fn play(
        samples: Arc<[f32]>,
        rate_hz: u32,
        after_secs: f64,
        mut failed: impl FnMut(String) + Send + 'static,
    ) -> Result<Self> {
        let (device, supported) = output()?;
        let config = quick(&supported, PLAYED_PIECES_HZ);
        if config.sample_rate != rate_hz {
            bail!("expected a device of {rate_hz} samples a second, found one of {}", config.sample_rate);
        }
        let (channels, rate) = (usize::from(config.channels).max(1), f64::from(rate_hz.max(1)));
        let place = Arc::new(Mutex::new(None));
        let told = Arc::clone(&place);
        let mut at = -(after_secs * rate).round() as i64;
        let fill = move |data: &mut Data, info: &cpal::OutputCallbackInfo| {
            let times = info.timestamp();
            let later = times.playback.saturating_duration_since(times.callback);
            let now = Place { secs: at as f64 / rate, heard_at: Instant::now() + later };
            *told.lock().unwrap_or_else(PoisonError::into_inner) = Some(now);
            let mut next = || {
                let sample = usize::try_from(at).ok().and_then(|at| samples.get(at));
                at += 1;
                sample.copied().unwrap_or(0.0)
            };
            match data.sample_format() {
                SampleFormat::F32 => write::<f32>(data, channels, &mut next),
                SampleFormat::I16 => write::<i16>(data, channels, &mut next),
                SampleFormat::I32 => write::<i32>(data, channels, &mut next),
                SampleFormat::U16 => write::<u16>(data, channels, &mut next),
                SampleFormat::U8 => write::<u8>(data, channels, &mut next),
                _ => {}
            }
        };
        let tell = move |error: cpal::Error| {
            if is_grave(&error) {
                failed(error.to_string());
            }
        };
        is_known(supported.sample_format())?;
        let stream = device
            .build_output_stream_raw(config, supported.sample_format(), fill, tell, Some(PATIENCE))
            .context("expected a device that plays sound")?;
        stream.play().context("expected a device that plays sound")?;
        Ok(Self { _stream: stream, place })
    }

    /// The time in the sound that is heard now, in seconds; `None` before the device has begun.
    pub(crate) fn secs(&self) -> Option<f64> {
        let Place { secs, heard_at } = (*self.place.lock().unwrap_or_else(PoisonError::into_inner))?;
        let now = Instant::now();
        Some(
            secs + now.saturating_duration_since(heard_at).as_secs_f64()
                - heard_at.saturating_duration_since(now).as_secs_f64(),
        )
    }
}

fn write<T: SizedSample + FromSample<f32>>(data: &mut Data, channels: usize, next: &mut impl FnMut() -> f32) {
    for frame in data.as_slice_mut::<T>().unwrap_or_default().chunks_mut(channels) {
        frame.fill(T::from_sample(next()));
    }
}

/// A microphone that hears.
pub(crate) struct Microphone {
    _stream: cpal::Stream,
    heard: Arc<Mutex<VecDeque<f32>>>,
    rate_hz: u32,
}

impl Microphone {
    /// Opens the default one. `failed` is told if it fails or vanishes later on.
    ///
    /// # Errors
    /// No microphone, or one that cannot be opened.
    pub(crate) fn open(mut failed: impl FnMut(String) + Send + 'static) -> Result<Self> {
        let device = cpal::default_host().default_input_device();
        let device = device.context("expected a microphone, found none")?;
        let supported = device.default_input_config().context("expected a microphone")?;
        let config = quick(&supported, HEARD_PIECES_HZ);
        let channels = usize::from(config.channels).max(1);
        let most = config.sample_rate.saturating_mul(KEPT_SECS) as usize;
        let heard = Arc::new(Mutex::new(VecDeque::with_capacity(most)));
        let into = Arc::clone(&heard);
        let hear = move |data: &Data, _: &cpal::InputCallbackInfo| {
            let mut heard = into.lock().unwrap_or_else(PoisonError::into_inner);
            let mut add = |sample: f32| {
                if heard.len() >= most {
                    heard.pop_front();
                }
                heard.push_back(sample);
            };
            match data.sample_format() {
                SampleFormat::F32 => read::<f32>(data, channels, &mut add),
                SampleFormat::I16 => read::<i16>(data, channels, &mut add),
                SampleFormat::I32 => read::<i32>(data, channels, &mut add),
                SampleFormat::U16 => read::<u16>(data, channels, &mut add),
                SampleFormat::U8 => read::<u8>(data, channels, &mut add),
                _ => {}
            }
        };
        let tell = move |error: cpal::Error| {
            if is_grave(&error) {
                failed(error.to_string());
            }
        };
        is_known(supported.sample_format())?;
        let rate_hz = config.sample_rate;
        let stream = device
            .build_input_stream_raw(config, supported.sample_format(), hear, tell, Some(PATIENCE))
            .context("expected a microphone")?;
        stream.play().context("expected a microphone")?;
        Ok(Self { _stream: stream, heard, rate_hz })
    }

    /// Samples a second.
    pub(crate) fn rate_hz(&self) -> u32 {
        self.rate_hz
    }

    /// Appends what was heard since it was asked last, in one channel.
    pub(crate) fn take(&self, out: &mut Vec<f32>) {
        out.extend(self.heard.lock().unwrap_or_else(PoisonError::into_inner).drain(..));
    }
}

fn read<T: SizedSample>(data: &Data, channels: usize, add: &mut impl FnMut(f32))
where
    f32: FromSample<T>,
{
    for frame in data.as_slice::<T>().unwrap_or_default().chunks(channels) {
        let sum: f32 = frame.iter().map(|sample| f32::from_sample(*sample)).sum();
        add(sum / channels as f32);
    }
}

/// Whether samples of this format can be made and read.
fn is_known(format: SampleFormat) -> Result<()> {
    use SampleFormat::{F32, I16, I32, U8, U16};
    match format {
        F32 | I16 | I32 | U16 | U8 => Ok(()),
        _ => bail!("expected a device of samples f32, i16, i32, u16 or u8, found {format}"),
    }
}

/// Whether sound ends with this error. Others pass: gaps, devices that take over, and what is only asked too
/// early, as ALSA's plugin for PulseAudio says of every stream at first (alsa-plugins 65). Whoever hears
/// nothing for long finds that out by itself.
fn is_grave(error: &cpal::Error) -> bool {
    use ErrorKind::{DeviceNotAvailable, HostUnavailable, PermissionDenied, StreamInvalidated};
    matches!(error.kind(), DeviceNotAvailable | HostUnavailable | PermissionDenied | StreamInvalidated)
}
