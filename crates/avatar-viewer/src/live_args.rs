use crate::live::{Listen, Origin, SendTo};
use crate::numbers::positive;
use clap::Args;
use std::path::PathBuf;

/// What drives a face from outside, and where it goes.
#[derive(Debug, Args)]
pub(crate) struct LiveOptions {
    /// Where a face arrives: livelink, vmc (and plain Open Sound Control), ifacialmocap or mediapipe, on its
    /// usual port of this computer alone, or with :PORT, :ADDRESS or :ADDRESS:PORT (0.0.0.0 hears everybody);
    /// mediapipe:- reads lines of JSON from standard input, mediapipe:ws hears a page in a browser, by
    /// WebSocket (with :PORT and so on); may be repeated
    #[arg(long, value_name = "FORMAT[:ADDRESS][:PORT]", required_unless_present = "play")]
    pub(crate) listen: Vec<Listen>,
    /// A page in a browser that may send faces by WebSocket although it is not of this computer, such as
    /// `https://example.org`; may be repeated. `null` is a file that a browser shows, but also a frame in any
    /// page
    #[arg(long, value_name = "ORIGIN", requires = "listen")]
    pub(crate) page: Vec<Origin>,
    /// Plays a recording of Live Link Face with its own times
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) play: Option<PathBuf>,
    /// Call what the face is one second after it has come neutral
    #[arg(long)]
    pub(crate) calibrate: bool,
    /// Keep in this file what is neutral, and how much stronger the avatar moves [default: calibration.toml
    /// in the folder of the avatar, NAME.calibration.toml beside its file, or among the user's settings for
    /// the built-in one]
    #[arg(long, value_name = "FILE.toml")]
    pub(crate) calibration: Option<PathBuf>,
    /// Smooth by the 1€ filter: 0 is off, 1 is later by up to 100 ms where the face rests
    #[arg(long, default_value = "0", value_parser = share, allow_hyphen_values = true, value_name = "SHARE")]
    pub(crate) smooth: f32,
    /// Swap left and right, as in a mirror
    #[arg(long)]
    pub(crate) mirror: bool,
    /// Write what the face did at the end: a table of Live Link Face (.csv), or a clip of the avatar (.toml)
    #[arg(long, value_name = "FILE")]
    pub(crate) record: Option<PathBuf>,
    /// Send the face on by VMC
    #[arg(long, value_name = "vmc:HOST:PORT")]
    pub(crate) send: Option<SendTo>,
    /// Open no window
    #[arg(long)]
    pub(crate) headless: bool,
    /// Seconds after which it ends [default: half a second after the recording of --play]
    #[arg(long, value_parser = positive, allow_hyphen_values = true, value_name = "SECONDS", requires = "headless")]
    pub(crate) seconds: Option<f64>,
    /// The motion of all controls, as .csv of the verb trace; `-` is standard output
    #[arg(long, value_name = "FILE", requires = "headless")]
    pub(crate) trace: Option<PathBuf>,
    /// Rows, and frames that are recorded and sent, per second
    #[arg(long, default_value = "60", value_parser = positive, allow_hyphen_values = true, value_name = "RATE")]
    pub(crate) hz: f64,
}

fn share(text: &str) -> Result<f32, String> {
    let share = text.trim().parse().ok().filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "expected a number from 0 to 1".to_owned())
}
