//! The other side of drag and drop under X11 (freedesktop.org, *Drag-and-Drop Protocol for the X Window
//! System*): a program from which a file is dragged onto a window.

use super::PATIENCE;
use std::path::Path;
use std::time::{Duration, Instant};
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    ClientMessageEvent, ConnectionExt, CreateWindowAux, EventMask, PropMode, SELECTION_NOTIFY_EVENT,
    SelectionNotifyEvent, WindowClass,
};
use x11rb::wrapper::ConnectionExt as _;

pub(crate) fn drop_file(display: &str, target: u32, path: &Path) {
    let (connection, screen) = x11rb::connect(Some(display)).expect("the display");
    let root = connection.setup().roots[screen].root;
    let source = connection.generate_id().expect("a number");
    let aux = CreateWindowAux::new();
    let made = connection.create_window(0, source, root, 0, 0, 1, 1, 0, WindowClass::INPUT_ONLY, 0, &aux);
    made.expect("sent").check().expect("a window");
    let atom = |name: &str| {
        connection.intern_atom(false, name.as_bytes()).expect("sent").reply().expect("an atom").atom
    };
    let (selection, list) = (atom("XdndSelection"), atom("text/uri-list"));
    connection
        .set_selection_owner(source, selection, x11rb::CURRENT_TIME)
        .expect("sent")
        .check()
        .expect("ours");
    let send = |name: &str, data: [u32; 5]| {
        let event = ClientMessageEvent::new(32, target, atom(name), data);
        let sent = connection.send_event(false, target, EventMask::NO_EVENT, event).expect("sent");
        sent.check().expect("the display took it");
    };
    const VERSION: u32 = 5;
    send("XdndEnter", [source, VERSION << 24, list, 0, 0]);
    send("XdndPosition", [source, 0, 60 << 16 | 60, x11rb::CURRENT_TIME, atom("XdndActionCopy")]);
    let start = Instant::now();
    let (mut served, mut dropped) = (false, false);
    let finished = atom("XdndFinished");
    loop {
        assert!(start.elapsed() < PATIENCE, "nobody takes what is dropped (asked: {served})");
        match connection.poll_for_event().expect("events") {
            None => std::thread::sleep(Duration::from_millis(10)),
            Some(Event::SelectionRequest(request)) => {
                let uri = format!("file://{}\r\n", path.display());
                let (window, property) = (request.requestor, request.property);
                connection
                    .change_property8(PropMode::REPLACE, window, property, list, uri.as_bytes())
                    .expect("sent")
                    .check()
                    .expect("written");
                let answer = SelectionNotifyEvent {
                    response_type: SELECTION_NOTIFY_EVENT,
                    sequence: 0,
                    time: request.time,
                    requestor: window,
                    selection: request.selection,
                    target: request.target,
                    property,
                };
                let sent = connection.send_event(false, window, EventMask::NO_EVENT, answer).expect("sent");
                sent.check().expect("the display took it");
                served = true;
            }
            Some(Event::ClientMessage(message)) if message.type_ == finished => return,
            Some(_) => {}
        }
        if served && !dropped {
            send("XdndDrop", [source, 0, x11rb::CURRENT_TIME, 0, 0]);
            dropped = true;
        }
    }
}
