use std::fmt;

/// What a packet is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Protocol {
    /// Live Link Face.
    LiveLink,
    /// VMC, and plain Open Sound Control.
    Vmc,
    /// iFacialMocap, of either version.
    IFacialMocap,
    /// Lines of MediaPipe's face landmarker.
    MediaPipe,
    /// Frames from elsewhere, such as a recording: [`crate::Receiver::push`].
    Frames,
}

impl Protocol {
    /// Its name, as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::LiveLink => "livelink",
            Self::Vmc => "vmc",
            Self::IFacialMocap => "ifacialmocap",
            Self::MediaPipe => "mediapipe",
            Self::Frames => "frames",
        }
    }

    /// The largest packet that is read. Landmarks make lines of MediaPipe long.
    pub fn limit(self) -> usize {
        if self == Self::MediaPipe { 256 * 1024 } else { 16 * 1024 }
    }
}

impl fmt::Display for Protocol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
