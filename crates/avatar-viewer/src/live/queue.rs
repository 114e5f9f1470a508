//! What threads that listen hand packets to.

use super::pages::Pages;
use avatar_live::Protocol;
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::SyncSender;
use std::time::{Duration, Instant};

/// How often a thread looks whether it is to end.
pub(super) const LOOK: Duration = Duration::from_millis(100);

/// A packet, and when it arrived.
#[derive(Debug)]
pub(crate) struct Packet {
    pub(crate) at: Instant,
    pub(crate) origin: SocketAddr,
    pub(crate) protocol: Protocol,
    pub(crate) bytes: Vec<u8>,
}

/// What threads hand packets to.
#[derive(Clone)]
pub(super) struct Queue {
    pub(super) packets: SyncSender<Packet>,
    pub(super) is_over: Arc<AtomicBool>,
    /// Who may send by WebSocket.
    pub(super) pages: Pages,
    /// Called after each packet.
    pub(super) wake: Arc<dyn Fn() + Send + Sync>,
}

impl Queue {
    /// Whether its threads are to end.
    pub(super) fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }

    /// Hands a packet over that has arrived now, unless too many wait.
    pub(super) fn offer(&self, origin: SocketAddr, protocol: Protocol, bytes: &[u8]) {
        let packet = Packet { at: Instant::now(), origin, protocol, bytes: bytes.to_vec() };
        if self.packets.try_send(packet).is_ok() {
            (self.wake)();
        }
    }
}
