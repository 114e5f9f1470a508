//! What the user wants of whoever drives the face from outside.

use super::App;
use super::messages::About;
use avatar_panel::Wish;
use std::path::Path;

impl App {
    /// Carries out what the tab of live faces wants.
    pub(super) fn wish(&mut self, wish: Wish) {
        let live = &mut self.live;
        match wish {
            Wish::Listen { inlet, is_wanted } => {
                let done = live.listen(inlet, is_wanted);
                self.expect_somebody(is_wanted && done.is_ok());
                self.messages.report(About::Live, "Nothing arrives there.", done);
            }
            Wish::HearOthers(hears_others) => {
                let done = live.hear_others(hears_others);
                self.messages.report(About::Live, "Nothing arrives there.", done);
            }
            Wish::LetIn(page) => live.let_in(page),
            Wish::Play => super::loading::ask_for_recording(self.proxy.clone()),
            Wish::Follow(sender) => live.follow.receiver.choose(sender),
            Wish::Calibrate => {
                let done = live.calibrate();
                self.messages.report(About::Live, "The calibration was not kept.", done);
            }
            Wish::ForgetCalibration => {
                let done = live.forget_calibration();
                self.messages.report(About::Live, "The calibration was not forgotten.", done);
            }
            Wish::Mirror(is_mirrored) => live.follow.receiver.set_mirrored(is_mirrored),
            Wish::Smooth(smooth) => live.set_smooth(smooth),
            Wish::OnTop(is_on_top) => self.set_on_top(is_on_top),
        }
    }

    /// Plays a recording of a face.
    pub(super) fn play_recording(&mut self, path: &Path) {
        let done = self.live.play(path);
        self.expect_somebody(done.is_ok());
        self.messages.report(About::Live, "The recording is not played.", done);
        self.presenter.redraw();
    }

    /// A face that is driven blinks as its person does.
    fn expect_somebody(&mut self, is_expected: bool) {
        if is_expected && self.session.face.lives() {
            self.session.face.set_life(false);
        }
    }

    /// Writes what `--calibrate` has called neutral, once it has.
    pub(super) fn keep_calibration(&mut self) {
        if let Err(error) = self.live.keep_calibration() {
            self.messages.error(About::Live, "The calibration was not kept.", &error);
        }
    }

    pub(super) fn set_on_top(&mut self, is_on_top: bool) {
        self.live.is_on_top = is_on_top;
        self.presenter.set_on_top(is_on_top);
    }
}
