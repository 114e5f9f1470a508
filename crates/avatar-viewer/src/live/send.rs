//! A face that goes out.

use super::Follow;
use anyhow::{Context, Result};
use avatar_live::VmcSender;
use std::net::{Ipv4Addr, UdpSocket};

/// A socket that a face goes out by.
pub(crate) struct Sending {
    socket: UdpSocket,
    sender: VmcSender,
}

impl Sending {
    pub(crate) fn new(to: &str) -> Result<Self> {
        let expected = || format!("--send: expected a computer that can be sent to, found {to:?}");
        let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).with_context(expected)?;
        socket.connect(to).with_context(expected)?;
        Ok(Self { socket, sender: VmcSender::default() })
    }

    /// Sends the face. Nobody may be there to hear it.
    pub(crate) fn send(&mut self, follow: &Follow, secs: f64) {
        let Self { socket, sender } = self;
        sender.send(follow.receiver.face(), secs, &mut |packet| drop(socket.send(packet)));
    }
}
