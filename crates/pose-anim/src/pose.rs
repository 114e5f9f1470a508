use crate::Easing;

/// A named set of control values.
///
/// A pose may leave controls out; a press leaves those to whatever they do.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Pose {
    /// Unique name.
    pub name: String,
    /// Name of the key that calls the pose, such as `1`, `q` or `F5`.
    pub key: Option<String>,
    /// Index of a control and its value, in degrees, units of the rig or weights.
    pub values: Vec<(usize, f32)>,
    /// Seconds that a move to this pose takes. `None`: each control takes its own time ([`crate::Pace`]).
    pub duration_secs: Option<f64>,
    /// How the move runs. `None`: with the least jerk. Any other one is led smoothly out of the motion
    /// before, and smoothly to rest.
    pub transition: Option<Easing>,
    /// What differs for single controls.
    pub timings: Vec<(usize, Timing)>,
}

/// When and how fast one control joins in a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Seconds after the press at which the control's move starts; until then it goes on with whatever it
    /// does.
    pub delay_secs: f64,
    /// Multiplies the duration.
    pub factor: f64,
}

impl Default for Timing {
    fn default() -> Self {
        Self { delay_secs: 0.0, factor: 1.0 }
    }
}

impl Pose {
    /// A pose without key, whose controls take their own time.
    pub fn new(name: impl Into<String>, values: Vec<(usize, f32)>) -> Self {
        Self { name: name.into(), values, ..Self::default() }
    }

    /// A pose from one value per control.
    pub fn from_values(name: impl Into<String>, values: &[f32]) -> Self {
        Self::new(name, values.iter().copied().enumerate().collect())
    }

    /// The same pose, whose move takes this many seconds.
    #[must_use]
    pub fn lasting(self, duration_secs: f64) -> Self {
        Self { duration_secs: Some(duration_secs), ..self }
    }

    /// The same pose with another transition function.
    #[must_use]
    pub fn along(self, transition: Easing) -> Self {
        Self { transition: Some(transition), ..self }
    }

    /// The same pose with a timing for one control.
    #[must_use]
    pub fn timed(mut self, control: usize, timing: Timing) -> Self {
        self.timings.push((control, timing));
        self
    }

    /// The timing of a control.
    pub fn timing(&self, control: usize) -> Timing {
        self.timings
            .iter()
            .rev()
            .find(|(index, _)| *index == control)
            .map(|(_, timing)| *timing)
            .unwrap_or_default()
    }

    /// The value of a control, if the pose has one.
    pub fn value(&self, control: usize) -> Option<f32> {
        self.values.iter().rev().find(|(index, _)| *index == control).map(|(_, value)| *value)
    }
}

/// Poses in the order of their file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoseSet {
    /// The poses. Names and keys of a set that was read are unique.
    pub poses: Vec<Pose>,
}

impl PoseSet {
    /// The pose of this name.
    pub fn get(&self, name: &str) -> Option<&Pose> {
        self.poses.iter().find(|pose| pose.name == name)
    }

    /// The pose that this key calls.
    pub fn by_key(&self, key: &str) -> Option<&Pose> {
        self.poses.iter().find(|pose| pose.key.as_deref() == Some(key))
    }

    /// The pose's name that is probably meant by a misspelt one.
    pub fn nearest(&self, name: &str) -> Option<&str> {
        placed_toml::nearest(name, self.poses.iter().map(|pose| pose.name.as_str()))
    }

    /// All poses, in order.
    pub fn iter(&self) -> std::slice::Iter<'_, Pose> {
        self.poses.iter()
    }
}

impl<'a> IntoIterator for &'a PoseSet {
    type Item = &'a Pose;
    type IntoIter = std::slice::Iter<'a, Pose>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}
