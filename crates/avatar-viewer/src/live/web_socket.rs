//! Pages in a browser that send faces by WebSocket (RFC 6455), one message for each frame.

use super::queue::{LOOK, Queue};
use avatar_live::{Gate, Protocol};
use std::io::ErrorKind;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::{StatusCode, header::ORIGIN};
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, HandshakeError, Message, WebSocket};

/// So many pages are heard at a time; others are turned away.
const PAGES: usize = 4;
/// Who has not said by then that it speaks WebSocket is turned away.
const GREETING: Duration = Duration::from_secs(2);
/// A page that sends too much waits so long for each message: it is slowed down, and costs little.
const TOO_MUCH: Duration = Duration::from_millis(20);

/// Lets pages in until the queue is over. `listener` does not wait.
pub(super) fn listen(listener: &TcpListener, protocol: Protocol, queue: &Queue) {
    let mut pages: Vec<JoinHandle<()>> = Vec::new();
    while !queue.is_over() {
        let Ok((stream, origin)) = listener.accept() else {
            // Nobody, or somebody who has left already.
            std::thread::sleep(LOOK);
            continue;
        };
        pages.retain(|page| !page.is_finished());
        if pages.len() < PAGES {
            let queue = queue.clone();
            let page = std::thread::Builder::new().name(format!("hears {protocol}"));
            // Where there is no thread, the connection is closed.
            pages.extend(page.spawn(move || hear(stream, origin, protocol, &queue)));
        }
    }
    for page in pages {
        // One that panicked has said so.
        let _ = page.join();
    }
}

/// Hears one page until it leaves.
fn hear(stream: TcpStream, origin: SocketAddr, protocol: Protocol, queue: &Queue) {
    let Some(mut socket) = greet(stream, protocol, queue) else { return };
    let (mut gate, start) = (Gate::default(), Instant::now());
    while !queue.is_over() {
        let message = match socket.read() {
            Ok(message) => message,
            Err(Error::Io(error)) if waits(error.kind()) => continue,
            // It has left, or does not keep to the rules.
            Err(_) => break,
        };
        let bytes = match &message {
            Message::Text(text) => text.as_bytes(),
            Message::Binary(bytes) => bytes,
            // Pings are answered, and a farewell, when the socket is read next.
            _ => continue,
        };
        if gate.admits(start.elapsed().as_secs_f64(), origin, bytes.len()) {
            queue.offer(origin, protocol, bytes);
        } else {
            std::thread::sleep(TOO_MUCH);
        }
    }
    let _ = socket.close(None);
    let _ = socket.flush();
}

/// The handshake, of a page that takes its time but not too long.
#[expect(clippy::result_large_err, reason = "it is the library that asks for a whole response")]
fn greet(stream: TcpStream, protocol: Protocol, queue: &Queue) -> Option<WebSocket<TcpStream>> {
    stream.set_nonblocking(false).ok()?;
    stream.set_read_timeout(Some(LOOK)).ok()?;
    stream.set_write_timeout(Some(GREETING)).ok()?;
    let limit = Some(protocol.limit());
    let config = WebSocketConfig::default().max_message_size(limit).max_frame_size(limit);
    let start = Instant::now();
    let whose = |request: &Request, response: Response| {
        let origin = request.headers().get(ORIGIN).map(|origin| String::from_utf8_lossy(origin.as_bytes()));
        // Whoever looks at the window may let it in.
        if queue.pages.admits(origin.as_deref(), || (queue.wake)()) {
            return Ok(response);
        }
        let mut refusal = ErrorResponse::new(Some("expected a page of this computer".to_owned()));
        *refusal.status_mut() = StatusCode::FORBIDDEN;
        Err(refusal)
    };
    let mut greeted = tungstenite::accept_hdr_with_config(stream, whose, Some(config));
    loop {
        match greeted {
            Ok(socket) => return Some(socket),
            Err(HandshakeError::Interrupted(further)) if start.elapsed() < GREETING && !queue.is_over() => {
                greeted = further.handshake();
            }
            Err(_) => return None,
        }
    }
}

/// Whether an error says that nothing has come yet.
fn waits(kind: ErrorKind) -> bool {
    matches!(kind, ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}
