//! Faces that arrive: sockets and standard input, and what is done with what comes.

mod calibration;
mod listen;
mod pages;
mod queue;
mod inbox;
mod web_socket;
mod follow;
mod send;
mod taken;

pub(crate) use calibration::CalibrationFile;
pub(crate) use follow::{Follow, line};
pub(crate) use inbox::Inbox;
pub(crate) use listen::{FORMATS, Listen, SendTo, everywhere, usual};
pub(crate) use pages::{Origin, Pages};
pub(crate) use send::Sending;
pub(crate) use taken::{Recorder, Take};
