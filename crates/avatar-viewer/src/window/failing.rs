//! What becomes of a window whose frames are not drawn.

use super::App;
use super::messages::About;
use anyhow::{Context, Result};
use winit::event_loop::ActiveEventLoop;

/// What the window does about frames that were not drawn although the device is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Remedy {
    /// Memory may have run out for a moment.
    TryAgain,
    /// The device may be broken without saying so.
    OpenDevice,
    /// Until something happens: trying for ever would keep a processor busy.
    Wait,
}

impl Remedy {
    /// What follows when so many frames failed in a row.
    fn after(failed_frames: u32) -> Self {
        match failed_frames {
            0 | 1 => Self::TryAgain,
            2 => Self::OpenDevice,
            _ => Self::Wait,
        }
    }
}

impl App {
    /// A frame was not drawn, and the device is not lost: memory may have run out for a moment. The window
    /// stays open, tries once more soon, then on a device opened anew, and after that waits for something to
    /// happen.
    pub(super) fn frame_failed(&mut self, event_loop: &ActiveEventLoop, error: &anyhow::Error) {
        self.failed_frames += 1;
        self.messages.error(About::Device, "A frame was not drawn.", error);
        match Remedy::after(self.failed_frames) {
            Remedy::TryAgain => self.presenter.frames.soon(),
            Remedy::OpenDevice => match self.presenter.reopen(event_loop, &self.session) {
                Ok(_) => {
                    let advice = format!("{error:#}");
                    self.messages.warn(
                        About::Device,
                        "The graphics device failed, and was opened again.",
                        advice,
                    );
                }
                Err(error) => self.fail(event_loop, error),
            },
            Remedy::Wait => {}
        }
    }

    /// Opens another device and uploads the same face, after the device was lost.
    pub(super) fn reopen(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        let opened =
            self.presenter.reopen(event_loop, &self.session).context("the graphics device was lost")?;
        if opened {
            self.messages.news(About::Device, "The graphics device was lost, and opened again.", "");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::Remedy;

    #[test]
    fn failing_frames_are_tried_again_then_drawn_on_another_device_and_then_left() {
        let remedies = [1, 2, 3, 4].map(Remedy::after);
        assert_eq!(remedies, [Remedy::TryAgain, Remedy::OpenDevice, Remedy::Wait, Remedy::Wait]);
    }
}
