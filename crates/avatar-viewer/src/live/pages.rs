//! Which pages in a browser may send faces.

use crate::standard;
use std::net::{Ipv4Addr, Ipv6Addr};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Longer origins are nobody's, and are not remembered; nor is what could move a terminal's cursor.
const LENGTH: usize = 256;
/// So many pages are let in at most.
const PAGES: usize = 64;

/// Pages of this computer may send faces, and those that somebody let in. A browser says with each connection
/// whose page makes it (RFC 6454), and lets every page connect to this computer: without this, any page that
/// is open could move the face.
#[derive(Clone, Default)]
pub(crate) struct Pages(Arc<Mutex<State>>);

#[derive(Default)]
struct State {
    let_in: Vec<String>,
    turned_away: Option<String>,
}

impl Pages {
    /// Lets these in, too: origins, such as `https://example.org`.
    pub(crate) fn new(let_in: &[String]) -> Self {
        Self(Arc::new(Mutex::new(State { let_in: let_in.to_vec(), turned_away: None })))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether a page of this origin may connect; programs say none. Who may not is remembered.
    pub(super) fn admits(&self, origin: Option<&str>) -> bool {
        let Some(origin) = origin else { return true };
        let mut state = self.state();
        if is_here(origin) || state.let_in.iter().any(|page| page.eq_ignore_ascii_case(origin)) {
            return true;
        }
        if origin.len() <= LENGTH && origin.bytes().all(|byte| byte.is_ascii_graphic()) {
            if state.turned_away.is_none() {
                standard::warn(format_args!(
                    "mediapipe: expected a page of this computer, found one of {origin}: --page {origin} lets it in"
                ));
            }
            state.turned_away = Some(origin.to_owned());
        }
        false
    }

    /// The page that was turned away last, until it is let in.
    pub(crate) fn turned_away(&self) -> Option<String> {
        self.state().turned_away.clone()
    }

    /// Lets the page in that was turned away last.
    pub(crate) fn let_in(&self) {
        let mut state = self.state();
        if state.let_in.len() < PAGES
            && let Some(origin) = state.turned_away.take()
        {
            state.let_in.push(origin);
        }
    }
}

/// Whether an origin is of this computer. That of a file is `null`, but so is that of a frame in any page.
fn is_here(origin: &str) -> bool {
    let Some((_, place)) = origin.split_once("://").filter(|(scheme, _)| matches!(*scheme, "http" | "https"))
    else {
        return false;
    };
    let port = |port: &str| {
        port.is_empty() || port.strip_prefix(':').is_some_and(|port| port.parse::<u16>().is_ok())
    };
    if let Some((host, rest)) = place.strip_prefix('[').and_then(|place| place.split_once(']')) {
        return port(rest) && host.parse() == Ok(Ipv6Addr::LOCALHOST);
    }
    let (host, rest) = place.split_at(place.find(':').unwrap_or(place.len()));
    let host = host.to_ascii_lowercase();
    let is_here = host == "localhost"
        || host.ends_with(".localhost")
        || host.parse().is_ok_and(|address: Ipv4Addr| address.is_loopback());
    is_here && port(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_of_this_computer_are_let_in_and_others_when_somebody_says_so() {
        let pages = Pages::new(&["https://example.org".to_owned()]);
        for origin in [
            "http://localhost",
            "http://localhost:8000",
            "https://LOCALHOST:1",
            "http://face.localhost:3000",
            "http://127.0.0.1:5500",
            "http://127.9.9.9",
            "http://[::1]:80",
            "https://example.org",
        ] {
            assert!(pages.admits(Some(origin)), "{origin}");
        }
        assert!(pages.admits(None));
        assert_eq!(pages.turned_away(), None);
        for origin in [
            "null",
            "file://",
            "localhost",
            "ftp://localhost",
            "http://localhost.evil.example",
            "http://evillocalhost",
            "http://localhost:8000.evil.example",
            "http://127.0.0.1.evil.example",
            "http://127.0.0.1@evil.example",
            "http://[::1].evil.example",
            "http://[::2]",
            "http://192.168.0.1",
            "https://example.org:8443",
            "http://example.org",
        ] {
            assert!(!pages.admits(Some(origin)), "{origin}");
            assert_eq!(pages.turned_away().as_deref(), Some(origin));
        }
        pages.let_in();
        assert!(pages.admits(Some("http://example.org")));
        assert_eq!(pages.turned_away(), None);
        for odd in ["x".repeat(LENGTH + 1), "http://a\u{1b}[2J".to_owned(), "http://a b".to_owned()] {
            assert!(!pages.admits(Some(&odd)), "{odd:?}");
        }
        assert_eq!(pages.turned_away(), None);
    }
}
