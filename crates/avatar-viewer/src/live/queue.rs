//! What threads that listen hand packets to.

use super::pages::Pages;
use avatar_live::Protocol;
use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How often a thread looks whether it is to end.
pub(super) const LOOK: Duration = Duration::from_millis(100);
/// So many packets wait.
const WAITING: usize = 256;

/// A packet, and when it arrived.
#[derive(Debug)]
pub(crate) struct Packet {
    pub(crate) at: Instant,
    pub(crate) origin: SocketAddr,
    pub(crate) protocol: Protocol,
    pub(crate) bytes: Vec<u8>,
    /// Its source waits until there is room: nothing of it is given up.
    waits: bool,
}

/// What threads hand packets to.
#[derive(Clone)]
pub(super) struct Queue {
    pub(super) packets: Arc<Packets>,
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

    /// Hands a packet over that has arrived now, unless too many of its source wait.
    pub(super) fn offer(&self, origin: SocketAddr, protocol: Protocol, bytes: &[u8]) {
        let packet = Packet { at: Instant::now(), origin, protocol, bytes: bytes.to_vec(), waits: false };
        if self.packets.offer(packet) {
            (self.wake)();
        }
    }

    /// Hands a packet over, and waits until there is room.
    pub(super) fn put(&self, origin: SocketAddr, protocol: Protocol, bytes: Vec<u8>) {
        self.packets.wait_for_room(|| self.is_over());
        self.packets.push(Packet { at: Instant::now(), origin, protocol, bytes, waits: true });
        (self.wake)();
    }
}

/// Packets that wait, in the order in which they came. At most [`WAITING`] are from sources that do not wait
/// for room: beyond that, the last packet of the busiest of them is dropped for that of a quieter one, so
/// that a flood takes no room from a phone.
#[derive(Default)]
pub(super) struct Packets {
    waiting: Mutex<Waiting>,
    /// Something has come, or has been taken.
    changed: Condvar,
}

#[derive(Default)]
struct Waiting {
    packets: VecDeque<Packet>,
    /// How many there are of each source that does not wait.
    counts: Vec<(SocketAddr, usize)>,
    /// How many there are of those that do.
    kept: usize,
}

impl Waiting {
    fn count(&self, origin: SocketAddr) -> usize {
        self.counts.iter().find(|(source, _)| *source == origin).map_or(0, |(_, count)| *count)
    }

    fn push(&mut self, packet: Packet) {
        match self.counts.iter_mut().find(|(source, _)| *source == packet.origin) {
            _ if packet.waits => self.kept += 1,
            Some((_, count)) => *count += 1,
            None => self.counts.push((packet.origin, 1)),
        }
        self.packets.push_back(packet);
    }

    fn remove(&mut self, place: usize) -> Option<Packet> {
        let packet = self.packets.remove(place)?;
        match self.counts.iter_mut().find(|(source, _)| *source == packet.origin) {
            _ if packet.waits => self.kept = self.kept.saturating_sub(1),
            Some((_, count)) => *count = count.saturating_sub(1),
            None => {}
        }
        self.counts.retain(|(_, count)| *count > 0);
        Some(packet)
    }
}

impl Packets {
    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes a packet in; whether there was room for it.
    fn offer(&self, packet: Packet) -> bool {
        let mut waiting = self.waiting();
        if waiting.packets.len().saturating_sub(waiting.kept) >= WAITING {
            let most = waiting.counts.iter().max_by_key(|(_, count)| *count).copied();
            let Some((source, count)) = most else { return false };
            if waiting.count(packet.origin) + 1 >= count {
                return false;
            }
            // Its last one: what came first is due first.
            let place = waiting.packets.iter().rposition(|packet| packet.origin == source && !packet.waits);
            place.and_then(|place| waiting.remove(place));
        }
        waiting.push(packet);
        drop(waiting);
        self.changed.notify_all();
        true
    }

    /// Waits until there is room for one more of those that wait.
    fn wait_for_room(&self, is_over: impl Fn() -> bool) {
        let mut waiting = self.waiting();
        while waiting.kept >= WAITING && !is_over() {
            waiting = self.changed.wait_timeout(waiting, LOOK).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    fn push(&self, packet: Packet) {
        self.waiting().push(packet);
        self.changed.notify_all();
    }

    /// The packet that came first.
    pub(super) fn take(&self) -> Option<Packet> {
        let packet = self.waiting().remove(0);
        if packet.is_some() {
            self.changed.notify_all();
        }
        packet
    }

    /// The packet that came first, if there is one by then.
    pub(super) fn take_until(&self, then: Instant) -> Option<Packet> {
        let mut waiting = self.waiting();
        loop {
            let left = then.saturating_duration_since(Instant::now());
            if let Some(packet) = waiting.remove(0) {
                drop(waiting);
                self.changed.notify_all();
                return Some(packet);
            }
            if left.is_zero() {
                return None;
            }
            waiting = self.changed.wait_timeout(waiting, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn packet(port: u16, number: usize) -> Packet {
        let bytes = number.to_le_bytes().to_vec();
        Packet {
            at: Instant::now(),
            origin: ([127, 0, 0, 1], port).into(),
            protocol: Protocol::LiveLink,
            bytes,
            waits: false,
        }
    }

    /// However much somebody sends between two frames of the window, a phone's packets all wait.
    #[test]
    fn a_flood_takes_no_room_from_a_phone() {
        let packets = Packets::default();
        let mut flooded = 0;
        for number in 0..60_000 {
            flooded += usize::from(packets.offer(packet(1, number)));
            if number % 1000 == 0 {
                assert!(packets.offer(packet(2, number / 1000)), "{number}");
            }
        }
        assert!((WAITING - 60..=WAITING).contains(&flooded), "{flooded}");
        let mut of_phone = Vec::new();
        let mut count = 0;
        while let Some(packet) = packets.take() {
            count += 1;
            if packet.origin.port() == 2 {
                of_phone.push(usize::from_le_bytes(packet.bytes.try_into().expect("eight bytes")));
            }
        }
        assert_eq!((count, of_phone), (WAITING, (0..60).collect::<Vec<_>>()));
        // Two floods share the room.
        for number in 0..1000 {
            packets.offer(packet(1, number));
        }
        for number in 0..1000 {
            packets.offer(packet(2, number));
        }
        let counts = packets.waiting().counts.clone();
        assert!(counts.iter().all(|(_, count)| count.abs_diff(WAITING / 2) <= 1), "{counts:?}");
        while packets.take().is_some() {}
        assert!(packets.waiting().counts.is_empty());
        let then = Instant::now() + Duration::from_millis(20);
        assert!(packets.take_until(then).is_none() && Instant::now() >= then);
    }

    #[test]
    fn who_may_not_lose_anything_waits_for_room() {
        let queue = Queue {
            packets: Arc::default(),
            is_over: Arc::default(),
            pages: Pages::default(),
            wake: Arc::new(|| ()),
        };
        let origin = ([127, 0, 0, 1], 0).into();
        std::thread::scope(|scope| {
            scope.spawn(|| {
                (0..1000u16).for_each(|n| queue.put(origin, Protocol::MediaPipe, n.to_le_bytes().to_vec()))
            });
            // A flood meanwhile.
            scope.spawn(|| {
                while !queue.is_over() {
                    queue.offer(([127, 0, 0, 1], 9).into(), Protocol::LiveLink, &[]);
                }
            });
            let then = Instant::now() + Duration::from_secs(60);
            let mut expected = 0..1000u16;
            while !expected.is_empty() {
                let packet = queue.packets.take_until(then).expect("a packet");
                if packet.origin == origin {
                    assert_eq!(packet.bytes, expected.next().unwrap_or_default().to_le_bytes());
                }
            }
            queue.is_over.store(true, Ordering::Relaxed);
        });
    }
}
