//! Where faces come from and go to, as the command line says it.

use avatar_live::Protocol;
use std::fmt;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::str::FromStr;

/// A format and where it arrives: `livelink`, `vmc:39539`, `ifacialmocap:0.0.0.0:49983`, `mediapipe:-`,
/// `mediapipe:ws`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Listen {
    pub(crate) protocol: Protocol,
    pub(crate) place: Place,
}

/// Where faces arrive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// Lines on standard input.
    Input,
    /// UDP.
    Datagrams(SocketAddr),
    /// Messages of a page in a browser.
    WebSocket(SocketAddr),
}

impl Place {
    pub(crate) fn address(&self) -> Option<SocketAddr> {
        match self {
            Self::Input => None,
            Self::Datagrams(address) | Self::WebSocket(address) => Some(*address),
        }
    }

    /// The same at another address.
    pub(crate) fn at(&self, address: SocketAddr) -> Self {
        match self {
            Self::Input => Self::Input,
            Self::Datagrams(_) => Self::Datagrams(address),
            Self::WebSocket(_) => Self::WebSocket(address),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input => write!(f, "standard input"),
            Self::Datagrams(address) => write!(f, "{address}"),
            Self::WebSocket(address) => write!(f, "ws://{address}"),
        }
    }
}

/// Formats by their names, what people call them, and where they usually arrive on this computer.
pub(crate) const FORMATS: [(Protocol, &str, Place); 4] = [
    (Protocol::LiveLink, "Live Link Face", Place::Datagrams(here(11111))),
    (Protocol::Vmc, "VMC and OSC", Place::Datagrams(here(39539))),
    (Protocol::IFacialMocap, "iFacialMocap", Place::Datagrams(here(49983))),
    (Protocol::MediaPipe, "MediaPipe, from a page in a browser", Place::WebSocket(here(8765))),
];

/// A format at its usual port, of this computer alone or of all.
pub(crate) fn usual(protocol: Protocol, hears_others: bool) -> Option<Listen> {
    let (.., place) = FORMATS.into_iter().find(|(other, ..)| *other == protocol)?;
    let port = place.address()?.port();
    Some(Listen { protocol, place: place.at((everywhere(hears_others), port).into()) })
}

const fn here(port: u16) -> SocketAddr {
    SocketAddr::new(HERE, port)
}

/// The address at which all computers are heard, or this one alone.
pub(crate) fn everywhere(hears_others: bool) -> IpAddr {
    if hears_others { IpAddr::V4(Ipv4Addr::UNSPECIFIED) } else { HERE }
}

/// This computer alone: who wants to hear others has to say so.
const HERE: IpAddr = IpAddr::V4(Ipv4Addr::LOCALHOST);

impl FromStr for Listen {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || {
            "expected livelink, vmc, ifacialmocap or mediapipe, then perhaps :PORT, :ADDRESS or :ADDRESS:PORT \
             (mediapipe:- for standard input, mediapipe:ws for a page in a browser, also with :PORT and so on)"
                .to_owned()
        };
        let (name, place) = text.split_once(':').unwrap_or((text, ""));
        let known = FORMATS.into_iter().find(|(protocol, ..)| protocol.name().eq_ignore_ascii_case(name));
        let (protocol, _, usual) = known.ok_or_else(expected)?;
        let at = |place: &str, usual: Option<u16>| {
            let port =
                || usual.ok_or_else(|| format!("expected {protocol}:PORT, {protocol}:- or {protocol}:ws"));
            match (place, place.parse::<u16>(), place.parse::<SocketAddr>(), place.parse::<IpAddr>()) {
                ("", ..) => Ok(here(port()?)),
                (_, Ok(port), ..) => Ok(here(port)),
                (_, _, Ok(address), _) => Ok(address),
                (.., Ok(ip)) => Ok((ip, port()?).into()),
                _ => Err(expected()),
            }
        };
        let usual_port = usual.address().map(|address| address.port());
        let place = match (usual, place, place.split_once(':').unwrap_or((place, ""))) {
            (Place::WebSocket(_), "-", _) => Place::Input,
            (Place::WebSocket(_), _, ("ws", place)) => Place::WebSocket(at(place, usual_port)?),
            // It has a usual port as a WebSocket alone.
            (Place::WebSocket(_), place, _) => Place::Datagrams(at(place, None)?),
            (_, place, _) => Place::Datagrams(at(place, usual_port)?),
        };
        Ok(Self { protocol, place })
    }
}

/// Where the face is sent: `vmc:127.0.0.1:39540`, or by the name of a computer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SendTo(pub(crate) String);

impl FromStr for SendTo {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let place = text.strip_prefix("vmc:").filter(|place| {
            place.rsplit_once(':').is_some_and(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok())
        });
        place.map(|place| Self(place.to_owned())).ok_or_else(|| "expected vmc:HOST:PORT".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_read() {
        let listen = |text: &str| text.parse::<Listen>().map(|listen| listen.place.to_string());
        for (text, address) in [
            ("livelink", "127.0.0.1:11111"),
            ("LiveLink:9", "127.0.0.1:9"),
            ("vmc", "127.0.0.1:39539"),
            ("vmc:0.0.0.0", "0.0.0.0:39539"),
            ("ifacialmocap:0.0.0.0:7", "0.0.0.0:7"),
            ("mediapipe:9000", "127.0.0.1:9000"),
            ("vmc:[::1]:5", "[::1]:5"),
            ("mediapipe:-", "standard input"),
            ("mediapipe:ws", "ws://127.0.0.1:8765"),
            ("mediapipe:ws:7", "ws://127.0.0.1:7"),
            ("mediapipe:ws:0.0.0.0", "ws://0.0.0.0:8765"),
            ("mediapipe:ws:[::1]:5", "ws://[::1]:5"),
        ] {
            assert_eq!(listen(text), Ok(address.to_owned()), "{text}");
        }
        for text in [
            "",
            "vcm",
            "mediapipe",
            "vmc:-",
            "vmc:70000",
            "livelink:here:9",
            "mediapipe:0.0.0.0",
            "vmc:ws",
            "mediapipe:ws:x",
            "mediapipe:wss",
        ] {
            assert!(listen(text).is_err(), "{text}");
        }
        assert_eq!("vmc:host:9".parse(), Ok(SendTo("host:9".to_owned())));
        for text in ["vmc:9", "osc:host:9", "vmc:host:port", "vmc::9"] {
            assert!(text.parse::<SendTo>().is_err(), "{text}");
        }
    }
}
