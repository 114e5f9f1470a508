use crate::mp4_sound::{SoundCoder, Tail, coded, muxing};
use crate::yuv::Planes;
use crate::{FilmError, Rate, Soundtrack};
use mp4::{AvcConfig, MediaConfig, Mp4Config, Mp4Sample, Mp4Writer, TrackConfig, TrackType};
use openh264::OpenH264API;
use openh264::encoder::{
    BitRate, Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, Profile, QpRange,
    RateControlMode, TransferCharacteristics, VuiConfig,
};
use openh264::formats::YUVSlices;
use std::io::{Seek, Write};

/// Strength of quantisation, the same everywhere: hardly anything is lost that is seen.
const QUANTISER: u8 = 20;
/// Seconds after which a frame stands for itself again, so that players can jump there.
const KEY_SECS: f64 = 2.0;
/// Wants to be given, and decides nothing: the quantiser is fixed.
const BIT_RATE: u32 = 20_000_000;
/// The track of the frames; a sound is the second one.
const TRACK: u32 = 1;

/// H.264 in MP4, in BT.709, and AAC.
pub(crate) struct Mp4Film<W: Write + Seek> {
    writer: Mp4Writer<Tail<W>>,
    sound: Option<SoundCoder>,
    encoder: Encoder,
    planes: Planes,
    /// Pixels in a row of the frames that come.
    width: usize,
    rate: Rate,
    frames: u64,
}

impl<W: Write + Seek> Mp4Film<W> {
    pub(crate) fn new(sink: W, width: usize, height: usize, rate: Rate) -> Result<Self, FilmError> {
        let brand = |name: &[u8; 4]| mp4::FourCC { value: *name };
        let config = Mp4Config {
            major_brand: brand(b"isom"),
            minor_version: 512,
            compatible_brands: [b"isom", b"iso2", b"avc1", b"mp41"].map(brand).to_vec(),
            timescale: rate.frames().into(),
        };
        let hz = rate.per_second();
        // The frames hold sRGB; it has the primaries and the matrix of BT.709.
        let colors = VuiConfig::bt709().transfer_characteristics(TransferCharacteristics::Srgb);
        let coding = EncoderConfig::new()
            // What all players know. The encoder's others need arithmetic coding, which cannot be asked for.
            .profile(Profile::Baseline)
            // With one quantiser nothing is controlled; this mode does not complain of that.
            .rate_control_mode(RateControlMode::Bufferbased)
            .qp(QpRange::new(QUANTISER, QUANTISER))
            .bitrate(BitRate::from_bps(BIT_RATE))
            .max_frame_rate(FrameRate::from_hz(hz as f32))
            .intra_frame_period(IntraFramePeriod::from_num_frames((KEY_SECS * hz).ceil() as u32))
            .skip_frames(false)
            .adaptive_quantization(false)
            .background_detection(false)
            .scene_change_detect(false)
            // One thread, for the same bytes on every machine with the same processor.
            .num_threads(1)
            .vui(colors);
        Ok(Self {
            writer: Mp4Writer::write_start(Tail::new(sink)?, &config).map_err(muxing)?,
            sound: None,
            encoder: Encoder::with_api_config(OpenH264API::from_source(), coding).map_err(coded)?,
            planes: Planes::new(width, height),
            width,
            rate,
            frames: 0,
        })
    }

    /// The film has this sound, which was checked.
    pub(crate) fn set_sound(&mut self, sound: Soundtrack) -> Result<(), FilmError> {
        self.sound = Some(SoundCoder::new(sound)?);
        Ok(())
    }

    pub(crate) fn push(&mut self, rgba: &[u8]) -> Result<(), FilmError> {
        let Planes { width, height, .. } = self.planes;
        self.planes.fill(rgba, self.width);
        let Planes { y, u, v, .. } = &self.planes;
        let picture = YUVSlices::new((y, u, v), (width, height), (width, width / 2, width / 2));
        let stream = self.encoder.encode(&picture).map_err(coded)?;
        let is_sync = matches!(stream.frame_type(), FrameType::IDR);
        let (mut sps, mut pps, mut bytes) = (None, None, Vec::new());
        for layer in (0..stream.num_layers()).filter_map(|layer| stream.layer(layer)) {
            for unit in (0..layer.nal_count()).filter_map(|unit| layer.nal_unit(unit)) {
                let unit = without_start(unit);
                match unit.first().map(|head| head & 0x1f) {
                    Some(7) => sps = Some(unit.to_vec()),
                    Some(8) => pps = Some(unit.to_vec()),
                    _ => {
                        bytes.extend_from_slice(&(unit.len() as u32).to_be_bytes());
                        bytes.extend_from_slice(unit);
                    }
                }
            }
        }
        if bytes.is_empty() {
            return Err(coded("expected a coded frame, found nothing"));
        }
        // A track begins with its parameter sets; those that come again are the same.
        if self.frames == 0 {
            let sets = sps.filter(|sps| sps.len() >= 4).zip(pps);
            let (seq_param_set, pic_param_set) = sets.ok_or_else(|| coded("expected parameter sets"))?;
            let (width, height) = (width as u16, height as u16);
            let media = AvcConfig { width, height, seq_param_set, pic_param_set };
            let track = TrackConfig {
                track_type: TrackType::Video,
                timescale: self.rate.frames().into(),
                language: "und".to_owned(),
                media_conf: MediaConfig::AvcConfig(media),
            };
            self.writer.add_track(&track).map_err(muxing)?;
        }
        let duration = self.rate.secs().into();
        let start_time = self.frames * u64::from(self.rate.secs());
        let sample = Mp4Sample { start_time, duration, rendering_offset: 0, is_sync, bytes: bytes.into() };
        self.writer.write_sample(TRACK, &sample).map_err(muxing)?;
        self.frames += 1;
        if let Some(sound) = &mut self.sound {
            sound.write_until(&mut self.writer, self.rate.time_secs(self.frames), false)?;
        }
        Ok(())
    }

    pub(crate) fn finish(mut self) -> Result<W, FilmError> {
        if let Some(sound) = &mut self.sound {
            sound.write_until(&mut self.writer, self.rate.time_secs(self.frames), true)?;
        }
        self.writer.write_end().map_err(muxing)?;
        let (mut sink, index) = self.writer.into_writer().into_parts();
        match &self.sound {
            Some(sound) => sink.write_all(&sound.index(&index, self.rate, self.frames)?)?,
            None => sink.write_all(&index)?,
        }
        Ok(sink)
    }
}

/// The unit without the zeros and the one that it begins with in a stream.
fn without_start(unit: &[u8]) -> &[u8] {
    let zeros = unit.iter().take_while(|byte| **byte == 0).count();
    unit.get(zeros + 1..).unwrap_or_default()
}
