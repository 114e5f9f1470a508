use super::{Clip, Key, LATEST_SECS, Track, Transition, Wrap};
use crate::{ClipError, Easing};

impl Track {
    /// Inserts a key at a time without changing the curve, up to rounding, for every kind of transition.
    /// Returns the index of the new key, or of the key that is already there.
    ///
    /// # Errors
    /// A time below 0 or above 10⁶ s, or NaN.
    pub fn bake(&mut self, time_secs: f64) -> Result<usize, ClipError> {
        if !(0.0..=LATEST_SECS).contains(&time_secs) {
            let (control, key) = (self.control(), self.keys.len());
            return Err(ClipError::Time {
                control,
                key,
                time_secs,
                earliest_secs: 0.0,
                latest_secs: LATEST_SECS,
            });
        }
        if let Some(index) = self.keys.iter().position(|key| key.time_secs == time_secs) {
            return Ok(index);
        }
        let state = self.at(time_secs);
        let index = self.keys.partition_point(|key| key.time_secs < time_secs);
        let mut key = Key { time_secs, value: state.value, transition: Transition::LINEAR };
        let span_secs = index.checked_sub(1).zip(self.keys.get(index)).map(|(before, after)| {
            let start_secs = self.keys[before].time_secs;
            (time_secs - start_secs) / (after.time_secs - start_secs)
        });
        let rise = |keys: &[Key]| keys[index].value - keys[index - 1].value;
        if let Some(share) = span_secs {
            let (left, right) = match self.keys[index - 1].transition {
                same @ Transition::Ease(Easing::Linear | Easing::StepStart | Easing::StepEnd) => (same, same),
                Transition::Ease(easing) => {
                    let rise = rise(&self.keys);
                    (
                        Transition::Part { easing, from: 0.0, to: share, rise },
                        Transition::Part { easing, from: share, to: 1.0, rise },
                    )
                }
                Transition::Part { easing, from, to, rise } => {
                    let middle = from + share * (to - from);
                    (
                        Transition::Part { easing, from, to: middle, rise },
                        Transition::Part { easing, from: middle, to, rise },
                    )
                }
                Transition::Hermite { leaving, arriving } => (
                    Transition::Hermite { leaving, arriving: state.velocity },
                    Transition::Hermite { leaving: state.velocity, arriving },
                ),
            };
            self.keys[index - 1].transition = left;
            key.transition = right;
        } else if let Some(last) = index.checked_sub(1).and_then(|last| self.keys.get_mut(last)) {
            last.transition = Transition::LINEAR;
        }
        self.keys.insert(index, key);
        Ok(index)
    }

    /// Moves a key in time, no further than its neighbours, and in value.
    ///
    /// # Errors
    /// No such key, a time beyond a neighbour's, a number that is not finite; then nothing changes.
    pub fn move_key(&mut self, index: usize, time_secs: f64, value: f64) -> Result<(), ClipError> {
        let control = self.control();
        let key = *self.keys.get(index).ok_or(ClipError::NoSuchKey {
            control,
            key: index,
            keys: self.keys.len(),
        })?;
        let moved = Key { time_secs, value, ..key };
        moved.check(control, index)?;
        let earliest_secs = index.checked_sub(1).map_or(0.0, |before| self.keys[before].time_secs);
        let latest_secs = self.keys.get(index + 1).map_or(LATEST_SECS, |after| after.time_secs);
        if !(earliest_secs..=latest_secs).contains(&time_secs) {
            return Err(ClipError::Time { control, key: index, time_secs, earliest_secs, latest_secs });
        }
        self.keys[index] = moved;
        Ok(())
    }

    /// Sets how the track goes on from a key.
    ///
    /// # Errors
    /// No such key, a number that is not finite; then nothing changes.
    pub fn set_transition(&mut self, index: usize, transition: Transition) -> Result<(), ClipError> {
        let control = self.control();
        let key = *self.keys.get(index).ok_or(ClipError::NoSuchKey {
            control,
            key: index,
            keys: self.keys.len(),
        })?;
        let changed = Key { transition, ..key };
        changed.check(control, index)?;
        self.keys[index] = changed;
        Ok(())
    }

    /// Deletes a key. The span before it, with its transition, then runs to the next key.
    ///
    /// # Errors
    /// No such key, or the only one.
    pub fn remove_key(&mut self, index: usize) -> Result<Key, ClipError> {
        let control = self.control();
        match self.keys.len() {
            keys if index >= keys => Err(ClipError::NoSuchKey { control, key: index, keys }),
            1 => Err(ClipError::NoKeys { control }),
            _ => Ok(self.keys.remove(index)),
        }
    }

    /// Removes everything before a time, which becomes the start.
    fn keep_from(&mut self, time_secs: f64) -> Result<(), ClipError> {
        let first = self.bake(time_secs)?;
        // Of keys at one time the last one says what follows.
        let same = self.keys.iter().skip(first).take_while(|key| key.time_secs <= time_secs).count();
        self.keys.drain(..first + same.saturating_sub(1));
        self.keys.iter_mut().for_each(|key| key.time_secs -= time_secs);
        Ok(())
    }

    /// Removes everything after a time.
    fn keep_until(&mut self, time_secs: f64) -> Result<(), ClipError> {
        let last = self.bake(time_secs)?;
        self.keys.truncate(last + 1);
        Ok(())
    }

    fn scale_time(&mut self, factor: f64) {
        for key in &mut self.keys {
            key.time_secs *= factor;
            if let Transition::Hermite { leaving, arriving } = &mut key.transition {
                *leaving /= factor;
                *arriving /= factor;
            }
        }
    }

    fn reverse(&mut self, duration_secs: f64) {
        // A wait at the start becomes one at the end, which only a key can hold.
        if let Some(first) = self.keys.first().copied().filter(|first| first.time_secs > 0.0) {
            self.keys.insert(0, Key { time_secs: 0.0, transition: Transition::LINEAR, ..first });
        }
        self.keys.reverse();
        for index in 0..self.keys.len() {
            // The span that now begins here had its transition at the key that now ends it.
            let transition =
                self.keys.get(index + 1).map_or(Transition::LINEAR, |next| next.transition.reversed());
            let key = &mut self.keys[index];
            *key = Key { time_secs: duration_secs - key.time_secs, transition, ..*key };
        }
    }

    /// Appends the keys of another track, `offset_secs` later. Until the first of them the track stays at its
    /// last value.
    fn append(&mut self, other: &Self, offset_secs: f64) {
        let Some((last, first)) = self.keys.last_mut().zip(other.keys.first()) else { return };
        last.transition = Transition::STEP;
        let joint = Key { time_secs: offset_secs, value: first.value, transition: Transition::LINEAR };
        if first.time_secs > 0.0 {
            self.keys.push(joint);
        }
        self.keys.extend(other.keys.iter().map(|key| Key { time_secs: key.time_secs + offset_secs, ..*key }));
    }
}

impl Transition {
    /// The transition of the same span played backward.
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Self::Ease(easing) => Self::Ease(easing.reversed()),
            Self::Part { easing, from, to, rise } => {
                Self::Part { easing: easing.reversed(), from: 1.0 - to, to: 1.0 - from, rise: -rise }
            }
            Self::Hermite { leaving, arriving } => Self::Hermite { leaving: -arriving, arriving: -leaving },
        }
    }
}

impl Clip {
    /// The track of a control, to be edited.
    pub fn track_mut(&mut self, control: usize) -> Option<&mut Track> {
        self.tracks.iter_mut().find(|track| track.control() == control)
    }

    /// Makes the clip slower (factor above 1) or faster.
    ///
    /// # Errors
    /// A factor that is not greater than 0, or that makes the clip longer than 10⁶ s; then nothing changes.
    pub fn scale_time(&mut self, factor: f64) -> Result<(), ClipError> {
        let duration_secs = self.duration_secs();
        if !(factor > 1e-6 && duration_secs * factor <= LATEST_SECS && factor < 1e6) {
            return Err(ClipError::Factor { factor });
        }
        self.tracks.iter_mut().for_each(|track| track.scale_time(factor));
        Ok(())
    }

    /// Turns the clip around in time.
    pub fn reverse(&mut self) {
        let duration_secs = self.duration_secs();
        self.tracks.iter_mut().for_each(|track| track.reverse(duration_secs));
    }

    /// Appends another clip to the end of this one. Where their values differ, they jump; a control that only
    /// the second clip has a track for has its first value from the start.
    ///
    /// # Errors
    /// Together they are longer than 10⁶ s; then nothing changes.
    pub fn append(&mut self, other: &Self) -> Result<(), ClipError> {
        let offset_secs = self.duration_secs();
        if offset_secs + other.duration_secs() > LATEST_SECS {
            return Err(ClipError::TooLong { duration_secs: offset_secs + other.duration_secs() });
        }
        for track in &other.tracks {
            match self.track_mut(track.control()) {
                Some(own) => own.append(track, offset_secs),
                None => {
                    let mut track = track.clone();
                    track.keys.iter_mut().for_each(|key| key.time_secs += offset_secs);
                    self.tracks.push(track);
                }
            }
        }
        Ok(())
    }

    /// The same motion from a time on: played from its start it does what this clip does from there, through
    /// all repetitions. A clip that goes to and fro becomes one that repeats the way there and back.
    ///
    /// # Errors
    /// A time below 0 or above 10⁶ s, or NaN; a way there and back that is longer than 10⁶ s.
    pub fn starting_at(&self, time_secs: f64) -> Result<Self, ClipError> {
        let mut whole = self.clone();
        let duration_secs = self.duration_secs();
        let (from_secs, around) = match self.wrap {
            Wrap::Loop if duration_secs > 0.0 => (time_secs.rem_euclid(duration_secs), true),
            Wrap::PingPong if duration_secs > 0.0 => {
                let mut back = self.clone();
                back.reverse();
                whole.append(&back)?;
                whole.wrap = Wrap::Loop;
                (time_secs.rem_euclid(2.0 * duration_secs), true)
            }
            _ => (time_secs, false),
        };
        let mut rest = whole.clone();
        for track in &mut rest.tracks {
            track.keep_from(from_secs)?;
        }
        if around && from_secs > 0.0 {
            let end_secs = whole.duration_secs();
            for track in &mut whole.tracks {
                track.keep_until(from_secs)?;
            }
            // Where all tracks end before the clip does.
            if let Some(track) = rest.tracks.first_mut() {
                track.bake(end_secs - from_secs)?;
            }
            rest.append(&whole)?;
        }
        Ok(rest)
    }
}
