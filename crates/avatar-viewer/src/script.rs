//! Poses at their times, as the command line says them, and the motion that they make.

use crate::usage::{self, usage};
use anyhow::Result;
use avatar_pack::Pack;
use pose_anim::{Player, Pose};

/// Poses and the seconds at which they are pressed, in the order of the times.
pub(crate) struct Script(Vec<(f64, Pose)>);

impl Script {
    /// `TIME POSE; TIME POSE; …` in any order.
    pub(crate) fn parse(script: &str, pack: &Pack) -> Result<Self> {
        let mut presses = Vec::new();
        for entry in script.split(';').map(str::trim).filter(|entry| !entry.is_empty()) {
            let form =
                || usage(format!("--script: expected \"SECONDS POSE; SECONDS POSE; …\", found {entry:?}"));
            let (time, name) = entry.split_once(char::is_whitespace).ok_or_else(form)?;
            let secs: f64 = time.parse().map_err(|_| form())?;
            if !secs.is_finite() || secs < 0.0 {
                return Err(usage(format!(
                    "--script: expected seconds from 0 on, found {time} in {entry:?}"
                )));
            }
            presses.push((secs, usage::pose(pack, name.trim())?));
        }
        presses.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        Ok(Self(presses))
    }

    /// The motion from its beginning, at rest.
    pub(crate) fn motion(&self, pack: &Pack) -> Motion<'_> {
        let pressed = Player::new(pack.controls());
        Motion { presses: &self.0, pressed_secs: 0.0, now: pressed.clone(), pressed }
    }

    /// When everything has come to rest.
    pub(crate) fn rest_secs(&self, pack: &Pack) -> Result<f64> {
        let mut motion = self.motion(pack);
        let last_secs = self.0.last().map_or(0.0, |(time, _)| *time);
        Ok(last_secs + motion.at(last_secs)?.secs_to_rest())
    }
}

/// A script under way. Every state is found from the last press in one step, so that it does not depend, not
/// even in its last bit, on which times were asked for before.
pub(crate) struct Motion<'a> {
    /// Those to come.
    presses: &'a [(f64, Pose)],
    /// The state just after the last press.
    pressed: Player,
    pressed_secs: f64,
    now: Player,
}

impl Motion<'_> {
    /// The state at a time, which is not before that of the last call.
    pub(crate) fn at(&mut self, secs: f64) -> Result<&Player> {
        while let Some(((time, pose), later)) = self.presses.split_first() {
            if *time > secs {
                break;
            }
            self.pressed.advance(time - self.pressed_secs)?;
            self.pressed.press(pose);
            self.pressed_secs = *time;
            self.presses = later;
        }
        self.now.clone_from(&self.pressed);
        self.now.advance((secs - self.pressed_secs).max(0.0))?;
        Ok(&self.now)
    }
}
