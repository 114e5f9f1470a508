//! How far a long job is, on standard error.

use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

/// Jobs that are over by then say nothing.
const SILENT: Duration = Duration::from_secs(1);
/// Between two states of the bar.
const BAR_EVERY: Duration = Duration::from_millis(100);
/// Between two lines, where standard error is no terminal.
const LINE_EVERY: Duration = Duration::from_secs(5);
const BAR_WIDTH: u64 = 30;
/// Back to the line's beginning, and nothing on it.
const CLEAR: &str = "\r\x1b[K";

/// A bar in a terminal, a line now and then elsewhere.
pub(crate) struct Progress {
    what: &'static str,
    total: u64,
    started: Instant,
    told: Instant,
    terminal: bool,
    /// Whether there is a bar to be cleared away.
    shown: bool,
}

impl Progress {
    /// Progress of a job of `total` steps; `what` is the noun for one step, such as "frame".
    pub(crate) fn new(what: &'static str, total: u64) -> Self {
        let now = Instant::now();
        let terminal = std::io::stderr().is_terminal();
        Self { what, total, started: now, told: now, terminal, shown: false }
    }

    /// Shows that `done` steps are finished.
    pub(crate) fn step(&mut self, done: u64) {
        let now = Instant::now();
        let every = if self.terminal { BAR_EVERY } else { LINE_EVERY };
        if now - self.started < SILENT || now - self.told < every {
            return;
        }
        self.told = now;
        let state = state(self.what, done, self.total, now - self.started);
        let mut out = std::io::stderr().lock();
        // Nothing is lost if nobody reads it.
        let _ = match self.terminal {
            true => write!(out, "{CLEAR}{} {state}", bar(done, self.total)),
            false => writeln!(out, "{state}"),
        };
        let _ = out.flush();
        self.shown = self.terminal;
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.shown {
            let _ = write!(std::io::stderr(), "{CLEAR}");
        }
    }
}

fn bar(done: u64, total: u64) -> String {
    let filled = (done * BAR_WIDTH).checked_div(total).unwrap_or(BAR_WIDTH).min(BAR_WIDTH);
    (0..BAR_WIDTH).map(|place| if place < filled { '█' } else { '░' }).collect()
}

/// `frame 30 of 90, 0:04 left`
fn state(what: &str, done: u64, total: u64, elapsed: Duration) -> String {
    let left = total.saturating_sub(done);
    let secs = if done == 0 { 0.0 } else { elapsed.as_secs_f64() / done as f64 * left as f64 };
    let secs = secs.ceil() as u64;
    format!("{what} {done} of {total}, {}:{:02} left", secs / 60, secs % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_state_is_told_in_words() {
        let after = |done, secs| state("frame", done, 90, Duration::from_millis(secs));
        assert_eq!(after(30, 2000), "frame 30 of 90, 0:04 left");
        assert_eq!(after(1, 2000), "frame 1 of 90, 2:58 left");
        assert_eq!(after(90, 9000), "frame 90 of 90, 0:00 left");
        assert_eq!(after(0, 9000), "frame 0 of 90, 0:00 left");
    }

    #[test]
    fn the_bar_fills() {
        let filled = |done| bar(done, 90).chars().filter(|c| *c == '█').count();
        assert_eq!([0, 45, 89, 90, 99].map(filled), [0, 15, 29, 30, 30]);
        assert_eq!(bar(7, 90).chars().count(), 30);
    }
}
