//! Which pages in a browser may send faces.

use crate::standard;
use std::net::{Ipv4Addr, Ipv6Addr};
use std::str::FromStr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// So many pages that were turned away are remembered, so that somebody can let them in.
const TURNED_AWAY: usize = 3;
/// Longer addresses are not remembered.
const LENGTH: usize = 128;

/// Whose page it is, as a browser says it with each connection (RFC 6454): `https://example.org`, with a port
/// unless it is the usual one, or `null` for a file and for a frame without an address.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Origin(String);

impl FromStr for Origin {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || {
            format!(
                "expected an origin such as https://example.org or http://192.168.0.9:8000, found {text:?}"
            )
        };
        let origin = text.trim().trim_end_matches('/').to_ascii_lowercase();
        let place = origin.strip_prefix("https://").map(|place| (place, ":443"));
        let place = place.or_else(|| origin.strip_prefix("http://").map(|place| (place, ":80")));
        match place {
            _ if origin == "null" => Ok(Self(origin)),
            Some((place, usual)) if is_remembered(&origin) && !place.is_empty() && !place.contains('/') => {
                Ok(Self(origin.strip_suffix(usual).unwrap_or(&origin).to_owned()))
            }
            _ => Err(expected()),
        }
    }
}

/// Pages of this computer may send faces, and those that somebody let in. A browser lets every page that is
/// open connect to this computer: without this, any of them could move the face.
#[derive(Clone, Default)]
pub(crate) struct Pages(Arc<Mutex<State>>);

#[derive(Default)]
struct State {
    let_in: Vec<Origin>,
    /// The first ones that were turned away, until they are let in.
    turned_away: Vec<String>,
    has_warned_of_null: bool,
}

impl Pages {
    /// Lets these in, too.
    pub(crate) fn new(let_in: &[Origin]) -> Self {
        Self(Arc::new(Mutex::new(State { let_in: let_in.to_vec(), ..State::default() })))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether a page of this origin may connect; programs say none. `tell` is called when there is a page
    /// more that was turned away and could be let in.
    pub(super) fn admits(&self, origin: Option<&str>, tell: impl FnOnce()) -> bool {
        let Some(origin) = origin else { return true };
        let mut state = self.state();
        if is_here(origin) || state.let_in.iter().any(|page| page.0.eq_ignore_ascii_case(origin)) {
            return true;
        }
        let is_null = origin == "null" && !std::mem::replace(&mut state.has_warned_of_null, true);
        let is_new = origin != "null"
            && is_remembered(origin)
            && state.turned_away.len() < TURNED_AWAY
            && !state.turned_away.iter().any(|page| page == origin);
        if is_new {
            state.turned_away.push(origin.to_owned());
        }
        // Writing may take a while.
        drop(state);
        if is_null {
            standard::warn(
                "mediapipe: expected a page that this computer serves, found a file or a frame without an address",
            );
        }
        if is_new {
            standard::warn(format_args!(
                "mediapipe: expected a page of this computer, found one of {origin}: --page {origin} lets it in"
            ));
            tell();
        }
        false
    }

    /// The pages that were turned away first, until they are let in.
    pub(crate) fn turned_away(&self) -> Vec<String> {
        self.state().turned_away.clone()
    }

    /// Lets one of them in.
    pub(crate) fn let_in(&self, index: usize) {
        let mut state = self.state();
        if index < state.turned_away.len() {
            let page = Origin(state.turned_away.remove(index));
            state.let_in.push(page);
        }
    }
}

/// Whether an origin is short and has nothing in it but what addresses have: no quotation mark, nothing that
/// moves a terminal's cursor.
fn is_remembered(origin: &str) -> bool {
    let is_of_address = |byte: u8| byte.is_ascii_alphanumeric() || b".:/_-[]".contains(&byte);
    !origin.is_empty() && origin.len() <= LENGTH && origin.bytes().all(is_of_address)
}

/// Whether an origin is of this computer. That of a file is `null`, but so is that of a frame in any page.
fn is_here(origin: &str) -> bool {
    let scheme = origin.split_once("://").filter(|(scheme, _)| matches!(*scheme, "http" | "https"));
    let Some((_, place)) = scheme else { return false };
    let is_port = |rest: &str| {
        rest.is_empty() || rest.strip_prefix(':').is_some_and(|port| port.parse::<u16>().is_ok())
    };
    if let Some((host, rest)) = place.strip_prefix('[').and_then(|place| place.split_once(']')) {
        return is_port(rest) && host.parse() == Ok(Ipv6Addr::LOCALHOST);
    }
    let (host, rest) = place.split_at(place.find(':').unwrap_or(place.len()));
    let host = host.to_ascii_lowercase();
    let is_here = host == "localhost"
        || host.ends_with(".localhost")
        || host.parse().is_ok_and(|address: Ipv4Addr| address.is_loopback());
    is_here && is_port(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn admits(pages: &Pages, origin: &str) -> (bool, bool) {
        let mut is_told = false;
        (pages.admits(Some(origin), || is_told = true), is_told)
    }

    #[test]
    fn pages_of_this_computer_are_let_in_and_others_when_somebody_says_so() {
        let named = ["https://Example.org:443/", "http://192.168.0.9:8000"]
            .map(|page| page.parse().expect("an origin"));
        let pages = Pages::new(&named);
        for origin in [
            "http://localhost",
            "http://localhost:8000",
            "https://LOCALHOST:1",
            "http://face.localhost:3000",
            "http://127.0.0.1:5500",
            "http://127.9.9.9",
            "http://[::1]:80",
            "https://example.org",
            "http://192.168.0.9:8000",
        ] {
            assert_eq!(admits(&pages, origin), (true, false), "{origin}");
        }
        assert!(pages.admits(None, || ()));
        assert!(pages.turned_away().is_empty());
        for (index, origin) in
            ["https://example.org:8443", "http://example.org", "https://a.example"].into_iter().enumerate()
        {
            assert_eq!(admits(&pages, origin), (false, true), "{origin}");
            assert_eq!(admits(&pages, origin), (false, false), "told once: {origin}");
            assert_eq!(pages.turned_away().get(index).map(String::as_str), Some(origin));
        }
        // Whoever comes later pushes nobody away.
        assert_eq!(admits(&pages, "https://b.example"), (false, false));
        pages.let_in(1);
        pages.let_in(7);
        assert_eq!(admits(&pages, "http://example.org"), (true, false));
        assert_eq!(pages.turned_away(), ["https://example.org:8443", "https://a.example"]);
    }

    #[test]
    fn who_only_looks_like_this_computer_is_turned_away() {
        for origin in [
            "null",
            "",
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
        ] {
            assert!(!admits(&Pages::default(), origin).0, "{origin}");
        }
        // These are not shown anywhere.
        for origin in [
            "null",
            "",
            "http://a;reboot",
            "http://$(a)",
            "http://a\u{1b}[2J",
            "http://a b",
            &"x".repeat(LENGTH + 1),
        ] {
            let pages = Pages::default();
            assert_eq!(admits(&pages, origin), (false, false), "{origin:?}");
            assert!(pages.turned_away().is_empty());
        }
    }

    #[test]
    fn origins_are_read() {
        for (text, origin) in [
            ("null", "null"),
            ("http://A.example:80", "http://a.example"),
            ("https://[::2]:5/", "https://[::2]:5"),
        ] {
            assert_eq!(text.parse(), Ok(Origin(origin.to_owned())));
        }
        for text in
            ["", "example.org", "https://", "https://example.org/face", "ftp://a.example", "https://a b"]
        {
            assert!(text.parse::<Origin>().is_err(), "{text}");
        }
    }
}
