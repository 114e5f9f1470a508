use crate::{ControlTable, MixError, Pose, PoseSet};

impl Pose {
    /// A weighted mixture of poses. Each control that any of them names gets
    ///
    /// ```text
    /// default + Σ weight · (value − default)
    /// ```
    ///
    /// over the poses that name it, clamped to its range: poses add up, and half a pose is half way from the
    /// undeformed face. Duration and transition are those of the first pose that has one, the timing of a
    /// control that of the first pose that names the control and has one for it ([`Self::timing`]). Weights
    /// that are not finite count as 0; values that are not finite are ignored.
    pub fn mixed(name: impl Into<String>, parts: &[(&Self, f32)], controls: &ControlTable) -> Self {
        let mut mixed = Self::new(name, Vec::new());
        mixed.duration_secs = parts.iter().find_map(|(pose, _)| pose.duration_secs);
        mixed.transition = parts.iter().find_map(|(pose, _)| pose.transition);
        for (index, control) in controls.controls().iter().enumerate() {
            let named = || {
                let value = |pose: &Self| pose.value(index).filter(|value| value.is_finite());
                parts.iter().filter_map(move |(pose, weight)| Some((*pose, value(pose)?, *weight)))
            };
            let default = f64::from(control.default);
            let (mut sum, mut whole, mut count) = (default, None, 0);
            for (_, value, weight) in named() {
                let weight = if weight.is_finite() { f64::from(weight) } else { 0.0 };
                sum += weight * (f64::from(value) - default);
                count += 1;
                whole = (weight == 1.0).then_some(value);
            }
            let value = match (count, whole) {
                (0, _) => continue,
                // One whole pose keeps its bits.
                (1, Some(value)) => value,
                _ => sum as f32,
            };
            let value = value.max(control.min).min(control.max);
            mixed.values.push((index, value));
            let timed = |pose: &Self| pose.timings.iter().any(|(other, _)| *other == index);
            let timing = named().find(|(pose, ..)| timed(pose)).map(|(pose, ..)| (index, pose.timing(index)));
            mixed.timings.extend(timing);
        }
        mixed
    }
}

impl PoseSet {
    /// Reads a mixture such as `smile`, `smile:0.5` or `smile:0.5 wink-left`: names of poses, each with a
    /// weight (1 if absent), separated by blanks, commas or plus signs. See [`Pose::mixed`].
    ///
    /// # Errors
    /// An unknown pose, a weight that is not a finite number, a text without poses.
    pub fn mix(&self, text: &str, controls: &ControlTable) -> Result<Pose, MixError> {
        let words = text.split(|c: char| c.is_whitespace() || c == ',' || c == '+');
        let mut parts = Vec::new();
        for word in words.filter(|word| !word.is_empty()) {
            let (name, weight) = word.split_once(':').unwrap_or((word, "1"));
            let pose = self.get(name).ok_or_else(|| MixError::UnknownPose {
                name: name.to_owned(),
                nearest: self.nearest(name).map(str::to_owned),
            })?;
            let number = weight.parse().ok().filter(|weight: &f32| weight.is_finite());
            let weight = number
                .ok_or_else(|| MixError::Weight { pose: name.to_owned(), weight: weight.to_owned() })?;
            parts.push((pose, weight));
        }
        match parts[..] {
            [] => Err(MixError::Empty),
            [(pose, 1.0)] => Ok(pose.clone()),
            _ => Ok(Pose::mixed(text.trim(), &parts, controls)),
        }
    }
}
