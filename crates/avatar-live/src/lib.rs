//! Faces from phones and webcams: packets of tracking programs in, smooth frames out.
//!
//! ```text
//!  bytes ──▶ a codec ──▶ Frame ──▶ Receiver ──advance(now)──▶ Frame ──▶ ControlMap ──▶ values of controls
//!            Live Link Face         several senders, clocks,
//!            VMC, OSC               jitter, gaps, smoothing,
//!            iFacialMocap           mirror, calibration
//!            MediaPipe
//! ```
//!
//! # Conventions
//!
//! - A [`Frame`] holds what is known of a face at one moment, a value for each **channel** ([`channels`]):
//!   the 52 shapes of ARKit and the 18 expressions of VRM 1.0 as weights from 0 to 1, and the angles of
//!   head and eyes in degrees, with the signs of [`pose_anim::face`]. Left and right are the character's
//!   own.
//! - Codecs take bytes and keep nothing of them, but for [`MediaPipeReader`], which keeps a sender's last
//!   line to compare. Whatever stands in a packet, they do not panic, what they hold is bounded, and an error
//!   says at which byte what was expected ([`DecodeError`]).
//! - A [`Receiver`] has no socket and no clock: whoever has both hands it packets with the time of their
//!   arrival, and asks for the face at a time. Nothing of that allocates once a sender is known, but for
//!   lines of MediaPipe that have other words than the last ones.
//!
//! # Smoothness
//!
//! What [`Receiver::advance`] returns is twice continuously differentiable in time, whatever arrives and
//! whenever: the line through the frames goes through two lags, presence and mirror through three. What
//! [`ControlMap::apply`] makes of it is so within the ranges of the controls.
//!
//! This crate knows no files, no sockets, no clock and no threads, and compiles for `wasm32`.

mod error;
mod protocol;
mod settings;
mod channel;
mod frame;
mod turn;
mod bytes;
mod number;
mod template;
mod live_link;
mod osc;
mod vmc;
mod ifacialmocap;
mod mediapipe;
mod table;
mod map;
mod calibration;
mod lag;
mod one_euro;
mod clock;
mod bucket;
mod buffer;
mod motion;
mod sender;
mod receiver;

pub use bucket::Gate;
pub use calibration::Calibration;
pub use channel::{CHANNELS, Channel, channels};
pub use error::{DecodeError, Found};
pub use frame::Frame;
pub use ifacialmocap::{IFacialMocap, Separator};
pub use live_link::{FrameTime, LIVE_LINK_VALUES, LiveLink};
pub use map::ControlMap;
pub use mediapipe::{MediaPipe, MediaPipeReader, mediapipe_line};
pub use one_euro::OneEuro;
pub use osc::{Arg, Args, Message, OscWriter, read_osc};
pub use placed_toml::TomlError;
pub use protocol::Protocol;
pub use receiver::{Received, Receiver, Refused};
pub use sender::Status;
pub use settings::Settings;
pub use table::{read_table, write_table_header, write_table_row};
pub use vmc::{Vmc, VmcSender};
