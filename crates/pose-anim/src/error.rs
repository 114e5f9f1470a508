use placed_toml::did_you_mean;

/// Why a [`crate::ControlTable`] does not fit a rig and its shapes.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BindError {
    /// A control that drives a joint which the rig does not have.
    #[error("control {control:?}: expected a joint of the rig, found {joint:?}{}", did_you_mean(.nearest.as_deref()))]
    UnknownJoint {
        /// Name of the control.
        control: String,
        /// The joint that it names.
        joint: String,
        /// The rig's joint that is probably meant.
        nearest: Option<String>,
    },
    /// A control that drives a blend shape which does not exist.
    #[error("control {control:?}: expected a blend shape of the face, found {shape:?}{}", did_you_mean(.nearest.as_deref()))]
    UnknownShape {
        /// Name of the control.
        control: String,
        /// The shape that it names.
        shape: String,
        /// The face's shape that is probably meant.
        nearest: Option<String>,
    },
}

/// Why control values could not be applied.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ApplyError {
    /// A slice of a wrong length.
    #[error("expected {expected} {what}, found {found}")]
    Length {
        /// Which slice.
        what: &'static str,
        /// Length that the binding asks for.
        expected: usize,
        /// Length of the slice.
        found: usize,
    },
    /// A value that is NaN or infinite.
    #[error("control {control}: expected a finite value, found {value}")]
    NotFinite {
        /// Index of the control.
        control: usize,
        /// The value.
        value: f32,
    },
}

/// Why poses could not be mixed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MixError {
    /// A pose that does not exist.
    #[error("expected the name of a pose, found {name:?}{}", did_you_mean(.nearest.as_deref()))]
    UnknownPose {
        /// The name.
        name: String,
        /// The pose that is probably meant.
        nearest: Option<String>,
    },
    /// A weight that is not a finite number.
    #[error("pose {pose:?}: expected a finite number as weight, found {weight:?}")]
    Weight {
        /// Name of the pose.
        pose: String,
        /// The weight.
        weight: String,
    },
    /// A text without any pose.
    #[error("expected poses such as \"smile\" or \"smile:0.5 wink-left\", found none")]
    Empty,
}

/// Why a clip could not be made or edited.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ClipError {
    /// A track without keys, or the removal of its last key.
    #[error("control {control}: expected a track with at least one key, found none")]
    NoKeys {
        /// Index of the control.
        control: usize,
    },
    /// Two tracks of one control.
    #[error("control {control}: expected one track, found two")]
    TwoTracks {
        /// Index of the control.
        control: usize,
    },
    /// A key that does not exist.
    #[error("control {control}: expected a key below {keys}, found {key}")]
    NoSuchKey {
        /// Index of the control.
        control: usize,
        /// Index of the key.
        key: usize,
        /// Number of keys.
        keys: usize,
    },
    /// A time that is out of order.
    #[error(
        "control {control}, key {key}: expected a time from {earliest_secs} s to {latest_secs} s, found {time_secs} s"
    )]
    Time {
        /// Index of the control.
        control: usize,
        /// Index of the key.
        key: usize,
        /// The time.
        time_secs: f64,
        /// The earliest that is possible.
        earliest_secs: f64,
        /// The latest that is possible.
        latest_secs: f64,
    },
    /// NaN, infinity, or a number beyond 10¹².
    #[error("control {control}, key {key}: expected finite numbers up to 1e12, found others")]
    NotFinite {
        /// Index of the control.
        control: usize,
        /// Index of the key.
        key: usize,
    },
    /// A piece of a span that begins or ends outside of it.
    #[error(
        "control {control}, key {key}: expected a piece of a span between its shares 0 and 1, found another"
    )]
    Share {
        /// Index of the control.
        control: usize,
        /// Index of the key.
        key: usize,
    },
    /// A factor of time that is not greater than 0, or too large.
    #[error("expected a factor greater than 0 that keeps the clip within 1000000 s, found {factor}")]
    Factor {
        /// The factor.
        factor: f64,
    },
    /// A clip that would be too long.
    #[error("expected a clip of at most 1000000 s, found {duration_secs} s")]
    TooLong {
        /// The length.
        duration_secs: f64,
    },
    /// An error bound that is negative or NaN.
    #[error("expected an error bound of 0 or more, found {bound}")]
    Bound {
        /// The bound.
        bound: f64,
    },
}

/// Why time could not advance.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AdvanceError {
    /// Time runs forward only.
    #[error("expected a time step of 0 or more seconds, found {dt_secs}")]
    Negative {
        /// The time step.
        dt_secs: f64,
    },
    /// A time step that is NaN.
    #[error("expected a time step of 0 or more seconds, found NaN")]
    NotANumber,
}

impl AdvanceError {
    /// Accepts 0, positive numbers and positive infinity (everything arrives).
    pub(crate) fn check(dt_secs: f64) -> Result<(), Self> {
        if dt_secs.is_nan() {
            Err(Self::NotANumber)
        } else if dt_secs < 0.0 {
            Err(Self::Negative { dt_secs })
        } else {
            Ok(())
        }
    }
}

/// Why a player could not jump to values.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum JumpError {
    /// Not one value per control.
    #[error("expected {expected} values, one per control, found {found}")]
    Length {
        /// Number of controls.
        expected: usize,
        /// Number of values.
        found: usize,
    },
    /// A value that is NaN or infinite.
    #[error("control {control}: expected a finite value, found {value}")]
    NotFinite {
        /// Index of the control.
        control: usize,
        /// The value.
        value: f32,
    },
    /// Of a crowd only.
    #[error(transparent)]
    Face(#[from] UnknownFace),
}

/// A face that a crowd does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected a face below {faces}, the number of faces in the crowd, found {face}")]
#[non_exhaustive]
pub struct UnknownFace {
    /// The face that was asked for.
    pub face: usize,
    /// Number of faces.
    pub faces: usize,
}
