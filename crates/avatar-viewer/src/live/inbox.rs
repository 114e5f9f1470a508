//! Threads that read sockets and standard input, and a bounded queue of what they read.

use super::listen::{Listen, Place};
use super::pages::Pages;
use super::queue::{LOOK, Packet, Queue};
use super::web_socket;
use anyhow::{Context, Result, anyhow};
use avatar_live::{Gate, Protocol};
use std::fmt;
use std::io::{BufRead, ErrorKind, Read};
use std::net::{IpAddr, SocketAddr, TcpListener, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// A socket that is read.
struct Inlet {
    protocol: Protocol,
    place: Place,
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Drop for Inlet {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        // Its port is free again only then.
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// What has arrived. Threads end when it is dropped; the one that reads standard input with the program.
pub(crate) struct Inbox {
    queue: Queue,
    inlets: Vec<Inlet>,
}

impl fmt::Debug for Inbox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.places()).finish()
    }
}

impl Inbox {
    /// Begins to listen. `wake` is called after each packet, and when a page is turned away, by other
    /// threads.
    ///
    /// # Errors
    /// As those of [`Self::listen`].
    pub(crate) fn open(
        listens: &[Listen],
        pages: Pages,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self> {
        let queue = Queue { packets: Arc::default(), is_over: Arc::default(), pages, wake: Arc::new(wake) };
        let mut inbox = Self { queue, inlets: Vec::new() };
        listens.iter().try_for_each(|listen| inbox.listen(*listen))?;
        Ok(inbox)
    }

    /// Begins to listen at one more place.
    ///
    /// # Errors
    /// A port that is taken, an address that is not of this computer, and a system without threads.
    pub(crate) fn listen(&mut self, Listen { protocol, place }: Listen) -> Result<()> {
        let is_over = Arc::new(AtomicBool::new(false));
        let mut queue = self.queue.clone();
        let expected = || format!("listening to {protocol}: expected a free port at {place}");
        let (address, work): (_, Box<dyn FnOnce() + Send>) = match place {
            Place::Input => (None, Box::new(move || read_lines(protocol, &queue))),
            Place::Datagrams(address) => {
                let socket = UdpSocket::bind(address).with_context(expected)?;
                socket.set_read_timeout(Some(LOOK)).with_context(expected)?;
                queue.is_over = is_over.clone();
                let address = socket.local_addr().with_context(expected)?;
                (Some(address), Box::new(move || listen(&socket, protocol, &queue)))
            }
            Place::WebSocket(address) => {
                let listener = TcpListener::bind(address).with_context(expected)?;
                listener.set_nonblocking(true).with_context(expected)?;
                queue.is_over = is_over.clone();
                let address = listener.local_addr().with_context(expected)?;
                (Some(address), Box::new(move || web_socket::listen(&listener, protocol, &queue)))
            }
        };
        let thread = std::thread::Builder::new().name(format!("listens to {protocol}")).spawn(work);
        let thread = thread.map_err(|error| {
            anyhow!("listening to {protocol}: expected a thread to listen in, found: {error}")
        })?;
        // Only a socket can be closed: the thread that reads standard input ends with the program.
        if let Some(address) = address {
            let place = place.at(address);
            self.inlets.push(Inlet { protocol, place, is_over, thread: Some(thread) });
        }
        Ok(())
    }

    /// Ends listening to a format.
    pub(crate) fn silence(&mut self, protocol: Protocol) {
        self.inlets.retain(|inlet| inlet.protocol != protocol);
    }

    /// Listens at another address of this computer, to each format at the port that it has.
    ///
    /// # Errors
    /// As those of [`Self::listen`], of the first format that is not listened to any more; the others are.
    pub(crate) fn move_to(&mut self, ip: IpAddr) -> Result<()> {
        let moved = |(protocol, place): (Protocol, Place)| {
            let port = place.address()?.port();
            Some(Listen { protocol, place: place.at((ip, port).into()) })
        };
        let listens: Vec<_> = self.places().filter_map(moved).collect();
        self.stop();
        // A port is free once its thread has ended.
        self.inlets.clear();
        let failed = listens.into_iter().filter_map(|listen| self.listen(listen).err());
        // All are tried, whatever becomes of one.
        failed.reduce(|first, _| first).map_or(Ok(()), Err)
    }

    /// Tells all threads to end: at once, because each looks only now and then.
    fn stop(&self) {
        self.inlets.iter().for_each(|inlet| inlet.is_over.store(true, Ordering::Relaxed));
    }

    /// Where it listens.
    pub(crate) fn places(&self) -> impl Iterator<Item = (Protocol, Place)> {
        self.inlets.iter().map(|inlet| (inlet.protocol, inlet.place))
    }

    /// Which pages in a browser may send.
    pub(crate) fn pages(&self) -> &Pages {
        &self.queue.pages
    }

    /// A packet that has arrived.
    pub(crate) fn take(&self) -> Option<Packet> {
        self.queue.packets.take()
    }

    /// The next packet, if it arrives by then.
    pub(crate) fn take_until(&self, then: Instant) -> Option<Packet> {
        self.queue.packets.take_until(then)
    }
}

impl Drop for Inbox {
    fn drop(&mut self) {
        self.queue.is_over.store(true, Ordering::Relaxed);
        self.stop();
    }
}

fn listen(socket: &UdpSocket, protocol: Protocol, queue: &Queue) {
    let mut buffer = vec![0; 1 << 16];
    let (mut gate, start) = (Gate::default(), Instant::now());
    while !queue.is_over() {
        let (length, origin) = match socket.recv_from(&mut buffer) {
            Ok(received) => received,
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => continue,
            // A packet that was sent from here did not arrive, or an interruption: the socket lives on.
            Err(_) => {
                std::thread::sleep(Duration::from_millis(1));
                continue;
            }
        };
        // A flood ends here, before it costs memory.
        if gate.admits(start.elapsed().as_secs_f64(), origin, length) {
            queue.offer(origin, protocol, buffer.get(..length).unwrap_or_default());
        }
    }
}

fn read_lines(protocol: Protocol, queue: &Queue) {
    let mut input = std::io::stdin().lock();
    let origin = SocketAddr::from(([127, 0, 0, 1], 0));
    while !queue.is_over() {
        let mut bytes = Vec::new();
        match (&mut input).take(protocol.limit() as u64).read_until(b'\n', &mut bytes) {
            Ok(0) | Err(_) => break,
            Ok(_) => {}
        }
        // A pipe waits, so no line is lost.
        queue.put(origin, protocol, bytes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_port_that_is_taken_keeps_no_other_from_moving() {
        let here = |protocol| Listen { protocol, place: Place::Datagrams(([127, 0, 0, 1], 0).into()) };
        let listens = [Protocol::LiveLink, Protocol::Vmc].map(here);
        let mut inbox = Inbox::open(&listens, Pages::default(), || ()).expect("free ports");
        let address = |(_, place): (Protocol, Place)| place.address().expect("a socket");
        let ports: Vec<u16> = inbox.places().map(|place| address(place).port()).collect();
        // Another program has the first one's port at another address: then nobody can have it at all.
        let other = UdpSocket::bind(SocketAddr::from(([127, 0, 0, 2], ports[0]))).expect("a free port");
        let error = inbox.move_to([0, 0, 0, 0].into()).expect_err("the port is taken");
        assert!(
            error.to_string().contains(&format!("livelink: expected a free port at 0.0.0.0:{}", ports[0]))
        );
        let left: Vec<_> = inbox.places().collect();
        assert_eq!(left, [(Protocol::Vmc, Place::Datagrams(([0, 0, 0, 0], ports[1]).into()))]);
        drop(other);
        inbox.move_to([127, 0, 0, 1].into()).expect("a free port");
        assert_eq!(inbox.places().next().map(address), Some(([127, 0, 0, 1], ports[1]).into()));
    }
}
