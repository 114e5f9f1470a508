//! `controls.toml`, `poses.toml` and `clips.toml` as texts that their readers take.

use crate::{
    Clip, ClipSet, Control, ControlTable, Drive, Easing, JointMotion, Pace, Pose, PoseSet, Timing,
    Transition, Wrap,
};
use glam::Vec3;
use placed_toml::string;
use std::fmt::Write;

/// Axes that have a name.
const AXES: [(&str, Vec3); 6] = [
    ("+x", Vec3::X),
    ("-x", Vec3::NEG_X),
    ("+y", Vec3::Y),
    ("-y", Vec3::NEG_Y),
    ("+z", Vec3::Z),
    ("-z", Vec3::NEG_Z),
];

impl ControlTable {
    /// A text that [`ControlTable::from_toml`] reads as these controls and couplings; an axis other than ±x,
    /// ±y and ±z may come back changed in its last digit. Names have to be fit for files: not empty, numbers
    /// within 1e9.
    ///
    /// ```
    /// use pose_anim::ControlTable;
    /// let face = ControlTable::default_face();
    /// assert_eq!(ControlTable::from_toml(&face.to_toml()).unwrap(), face);
    /// ```
    pub fn to_toml(&self) -> String {
        let mut out = String::new();
        for control in self.controls() {
            write_control(&mut out, control);
        }
        let name = |index: usize| self.controls().get(index).map_or("", |control| &control.name);
        for coupling in self.couplings() {
            gap(&mut out);
            let (from, to) = (string(name(coupling.from)), string(name(coupling.to)));
            let _ = writeln!(out, "[[coupling]]\nfrom = {from}\nto = {to}\nfactor = {:?}", coupling.factor);
        }
        out
    }
}

impl PoseSet {
    /// A text that [`PoseSet::from_toml`] reads as these poses, if their values are in the ranges of the
    /// controls.
    ///
    /// ```
    /// use pose_anim::{ControlTable, PoseSet};
    /// let face = ControlTable::default_face();
    /// let poses = PoseSet::default_face(&face);
    /// assert_eq!(PoseSet::from_toml(&poses.to_toml(&face), &face).unwrap(), poses);
    /// ```
    pub fn to_toml(&self, controls: &ControlTable) -> String {
        let mut out = String::new();
        for pose in &self.poses {
            write_pose(&mut out, pose, controls);
        }
        out
    }
}

impl ClipSet {
    /// A text that [`ClipSet::from_toml`] reads as these clips, if their values are numbers of 32 bits in the
    /// ranges of the controls.
    ///
    /// ```
    /// use pose_anim::{Clip, ClipSet, ControlTable, Easing, Key, Track};
    /// let face = ControlTable::default_face();
    /// let keys = vec![Key::new(0.0, 2.0, Easing::MinimumJerk), Key::new(0.25, 8.5, Easing::Linear)];
    /// let nod = Track::new(1, keys)?;
    /// let clips = ClipSet { clips: vec![Clip::new("nod", vec![nod])?] };
    /// assert_eq!(ClipSet::from_toml(&clips.to_toml(&face), &face)?, clips);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn to_toml(&self, controls: &ControlTable) -> String {
        let mut out = String::new();
        for clip in &self.clips {
            write_clip(&mut out, clip, controls);
        }
        out
    }
}

fn write_clip(out: &mut String, clip: &Clip, controls: &ControlTable) {
    gap(out);
    let _ = writeln!(out, "[[clip]]\nname = {}", string(&clip.name));
    if let Some(key) = &clip.key {
        let _ = writeln!(out, "key = {}", string(key));
    }
    match clip.wrap {
        Wrap::Once => {}
        Wrap::Loop => out.push_str("wrap = \"loop\"\n"),
        Wrap::PingPong => out.push_str("wrap = \"ping-pong\"\n"),
    }
    out.push_str("[clip.tracks]\n");
    for track in clip.tracks() {
        let Some(control) = controls.controls().get(track.control()) else { continue };
        let _ = writeln!(out, "{} = [", string(&control.name));
        for key in track.keys() {
            let _ = write!(out, "    {{ t = {:?}, v = {:?}", key.time_secs, key.value as f32);
            let _ = match key.transition {
                Transition::Ease(Easing::Linear) => Ok(()),
                Transition::Ease(function) => write!(out, ", transition = {}", easing(function)),
                Transition::Hermite { leaving, arriving } => {
                    write!(out, ", slopes = [{leaving:?}, {arriving:?}]")
                }
                Transition::Part { easing: function, from, to, rise } => {
                    let of = easing(function);
                    write!(out, ", part = {{ of = {of}, from = {from:?}, to = {to:?}, rise = {rise:?} }}")
                }
            };
            out.push_str(" },\n");
        }
        out.push_str("]\n");
    }
}

/// A transition function by its name, or by its handles.
fn easing(easing: Easing) -> String {
    match (easing.name(), easing) {
        (Some(name), _) => string(&name),
        (None, Easing::Bezier(handles)) => format!("{handles:?}"),
        // Every other function has a name.
        (None, _) => string("linear"),
    }
}

fn gap(out: &mut String) {
    if !out.is_empty() {
        out.push('\n');
    }
}

fn write_control(out: &mut String, control: &Control) {
    gap(out);
    let Control { name, drives, min, max, default, pace, group } = control;
    let _ = writeln!(out, "[[control]]\nname = {}", string(name));
    match drives {
        Drive::Joint { joint, axis, kind } => {
            let named = AXES.iter().find(|(_, other)| other == axis);
            let axis = named.map_or_else(|| format!("{:?}", axis.to_array()), |(name, _)| string(name));
            let _ = writeln!(out, "joint = {}\naxis = {axis}", string(joint));
            if *kind == JointMotion::Translation {
                out.push_str("kind = \"translation\"\n");
            }
        }
        Drive::Shape { shape } => {
            let _ = writeln!(out, "shape = {}", string(shape));
        }
    }
    let _ = writeln!(out, "min = {min:?}\nmax = {max:?}");
    if *default != 0.0 {
        let _ = writeln!(out, "default = {default:?}");
    }
    if *pace != Pace::named(name, drives) {
        let _ = writeln!(out, "seconds = [{:?}, {:?}]", pace.shortest_secs, pace.longest_secs);
    }
    if let Some(group) = group {
        let _ = writeln!(out, "group = {}", string(group));
    }
}

fn write_pose(out: &mut String, pose: &Pose, controls: &ControlTable) {
    gap(out);
    let name_of = |index: usize| controls.controls().get(index).map(|control| string(&control.name));
    let _ = writeln!(out, "[[pose]]\nname = {}", string(&pose.name));
    if let Some(key) = &pose.key {
        let _ = writeln!(out, "key = {}", string(key));
    }
    if let Some(duration_secs) = pose.duration_secs {
        let _ = writeln!(out, "duration = {duration_secs:?}");
    }
    if let Some(transition) = pose.transition {
        let _ = writeln!(out, "transition = {}", easing(transition));
    }
    // Tables come last: what follows one would belong to it.
    if !pose.values.is_empty() {
        out.push_str("[pose.controls]\n");
    }
    for (name, value) in pose.values.iter().filter_map(|(index, value)| Some((name_of(*index)?, value))) {
        let _ = writeln!(out, "{name} = {value:?}");
    }
    if !pose.timings.is_empty() {
        out.push_str("[pose.timing]\n");
    }
    for (name, timing) in pose.timings.iter().filter_map(|(index, timing)| Some((name_of(*index)?, timing))) {
        let Timing { delay_secs, factor } = timing;
        let _ = writeln!(out, "{name} = {{ delay = {delay_secs:?}, factor = {factor:?} }}");
    }
}
