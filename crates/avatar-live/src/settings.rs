/// How the face follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Delay of the lags that make the line between frames smooth, in seconds.
    pub lag_secs: f64,
    /// Greatest delay of the 1€ filter, in seconds: that of what rests. `None` does without it.
    pub smooth_secs: Option<f64>,
    /// Jitter beyond this is not waited for, in seconds.
    pub jitter_limit_secs: f64,
    /// How long it takes until the face of [`crate::Receiver::advance`] is seen, in seconds: drawing it. That
    /// is made up for by being early, by at most half of the time between frames.
    pub lead_secs: f64,
    /// How long the last frame is held when none comes, in seconds.
    pub hold_secs: f64,
    /// Delay of the way to neutral after that, and back, in seconds; also from one sender to another.
    pub ease_secs: f64,
}

impl Default for Settings {
    /// 5 ms of lags, no 1€ filter, no time for drawing, up to 200 ms of jitter, 0.3 s of holding, 0.3 s of
    /// easing.
    fn default() -> Self {
        Self {
            lag_secs: 0.005,
            smooth_secs: None,
            jitter_limit_secs: 0.2,
            lead_secs: 0.0,
            hold_secs: 0.3,
            ease_secs: 0.3,
        }
    }
}
