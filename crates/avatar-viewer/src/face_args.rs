use crate::clips::{self, FoundClip};
use crate::life_args::{LifeArgs, Living};
use crate::numbers::{finite, seconds};
use crate::speech::Spoken;
use crate::speech_args::SpeechArgs;
use crate::standard;
use crate::usage::{self, unknown};
use anyhow::Result;
use avatar_pack::{FaceState, MotionAt, Pack};
use clap::{ArgGroup, ArgMatches, Args};
use glam::Affine3A;
use pose_anim::{Control, Drive};
use rig_core::{Axis, Elementary, JointId, product};
use std::borrow::Cow;
use std::str::FromStr;

/// A face state on the command line: a pose, then single controls and joints.
#[derive(Clone, Debug, Default, Args)]
#[command(group(ArgGroup::new("timed").args(["clip", "life", "visemes", "audio", "say"]).multiple(true)))]
pub(crate) struct FaceArgs {
    /// Pose to start from, or a mixture: "smile:0.5 wink-left"
    #[arg(long, value_name = "NAME")]
    pose: Option<String>,
    /// Set exactly this control, in degrees or as a weight; may be repeated
    #[arg(long, value_name = "CONTROL=VALUE", allow_hyphen_values = true)]
    set: Vec<Setting>,
    /// Set this joint's local transform to a product of rotations about its own axes, left to right; may be
    /// repeated
    #[arg(long, value_name = "JOINT=AXIS:DEG[,AXIS:DEG...]", allow_hyphen_values = true)]
    rotate: Vec<Rotation>,
    /// Clip of the avatar's file or clips.toml to start from, as `info` lists them, or a face tracker's
    /// recording, FILE.csv; what --set and --rotate concern is theirs
    #[arg(long, value_name = "NAME", conflicts_with = "pose")]
    clip: Option<String>,
    #[command(flatten)]
    speech: SpeechArgs,
    #[command(flatten)]
    life: LifeArgs,
    /// Seconds from the beginning of the clip, of the speech and of the life
    #[arg(long, value_name = "SECONDS", requires = "timed", default_value_t = 0.0, value_parser = seconds, allow_hyphen_values = true)]
    time: f32,
}

/// `CONTROL=VALUE`
#[derive(Clone, Debug)]
struct Setting {
    control: String,
    value: f32,
}

impl FromStr for Setting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (control, value) = text.rsplit_once('=').ok_or("expected CONTROL=VALUE, as in jaw.open=12")?;
        let value = finite_value(value)?;
        Ok(Self { control: control.trim().to_owned(), value })
    }
}

/// `JOINT=AXIS:DEG[,AXIS:DEG…]`
#[derive(Clone, Debug)]
struct Rotation {
    /// As it was given.
    text: String,
    joint: String,
    factors: Vec<Elementary>,
}

impl FromStr for Rotation {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = "expected JOINT=AXIS:DEGREES[,AXIS:DEGREES…] with x, y or z, as in HeadJoint=x:20,y:-10";
        let (joint, factors) = text.split_once('=').ok_or(form)?;
        let factor = |factor: &str| {
            let (axis, degrees) = factor.split_once(':').ok_or(form)?;
            let axis = match axis.trim() {
                "x" | "X" => Axis::X,
                "y" | "Y" => Axis::Y,
                "z" | "Z" => Axis::Z,
                _ => return Err(form.to_owned()),
            };
            Ok(Elementary::rotation(axis, finite_value(degrees)?.to_radians()))
        };
        let factors = factors.split(',').map(factor).collect::<Result<_, _>>()?;
        Ok(Self { text: text.to_owned(), joint: joint.trim().to_owned(), factors })
    }
}

/// A number within an argument, which its error has to name.
fn finite_value(text: &str) -> Result<f32, String> {
    finite(text).map_err(|expected| format!("{expected}, found {text:?}"))
}

/// A face state that is known to fit a pack.
#[derive(Clone, Debug, Default)]
pub(crate) struct FaceChoice {
    /// Control values of the pose, before couplings.
    values: Vec<f32>,
    settings: Vec<(usize, f32)>,
    locals: Vec<(JointId, Affine3A)>,
    /// Weights of shapes that a clip sets, by their places in the pack.
    weights: Vec<(usize, f32)>,
    /// What the values come from, in words of the command line; nothing if from nowhere.
    start: Vec<String>,
    /// The rotations among `locals`, in those words.
    rotations: Vec<String>,
    /// What lies over the values, and under single settings.
    life: Option<Living>,
}

impl FaceChoice {
    /// A pose's values on top of the defaults, and nothing else.
    pub(crate) fn of_values(values: Vec<f32>) -> Self {
        Self { values, ..Self::default() }
    }

    /// What a clip sets at a time, and nothing else.
    pub(crate) fn of_found(clip: &FoundClip, pack: &Pack, time_secs: f64) -> Result<Self> {
        let mut values = pack.controls().defaults();
        let set = clip.at(pack, time_secs, &mut values)?;
        Ok(Self::of_values(values).with_motion(set))
    }

    /// The same choice, with life on top.
    pub(crate) fn with_life(self, life: Option<Living>) -> Self {
        Self { life, ..self }
    }

    /// The life on top, without which the choice goes on.
    pub(crate) fn take_life(&mut self) -> Option<Living> {
        self.life.take()
    }

    /// A clip of a file at a time, only to be described.
    pub(crate) fn of_clip(pack: &Pack, clip: &str, time_secs: f64) -> Self {
        let start = vec![format!("clip={clip}"), format!("time={time_secs}")];
        Self { start, ..Self::of_values(pack.controls().defaults()) }
    }

    /// The same choice, with the joints and weights that a clip of a file sets.
    pub(crate) fn with_motion(self, set: MotionAt) -> Self {
        Self { locals: set.locals, weights: set.weights, ..self }
    }

    /// The choice as a line of `pose=NAME`, `clip=NAME`, `time=SECONDS`, `CONTROL=VALUE` and
    /// `rotate=JOINT=…`, apart by semicolons: what the options of these names (and `--set`) take. A face at
    /// rest is an empty line.
    pub(crate) fn describe(&self, pack: &Pack) -> String {
        let defaults = pack.controls().defaults();
        let base = if self.start.is_empty() { &defaults } else { &self.values };
        let mut entries = self.start.clone();
        let values = self.start_values();
        for ((control, value), base) in pack.controls().controls().iter().zip(&values).zip(base) {
            if value != base {
                entries.push(format!("{}={value}", control.name));
            }
        }
        if let Some(life) = &self.life {
            let is_new = |entry: &String| !entry.starts_with("time=");
            entries.retain(is_new);
            entries.extend(life.describe());
        }
        entries.extend(self.rotations.iter().map(|rotation| format!("rotate={rotation}")));
        entries.join("; ")
    }

    /// The same choice with the mouth of a speech at a time.
    pub(crate) fn speaking(mut self, spoken: &Spoken, secs: f64) -> Self {
        spoken.say(secs, &mut self.values);
        self
    }

    /// Control values with the single settings in place: where a window's motion starts.
    pub(crate) fn start_values(&self) -> Vec<f32> {
        let mut values = self.values.clone();
        self.settings.iter().for_each(|&(control, value)| values[control] = value);
        values
    }

    /// Values of the controls, without single settings.
    pub(crate) fn values(&self) -> &[f32] {
        &self.values
    }

    /// The same choice with something laid over its values. They are described by themselves, unless joints
    /// or shapes come from a clip, which no values could tell.
    pub(crate) fn showing(mut self, lay: impl FnOnce(&[f32], &mut [f32]) -> Result<()>) -> Self {
        let mut values = self.values.clone();
        if self.weights.is_empty()
            && self.locals.len() == self.rotations.len()
            && lay(&self.values, &mut values).is_ok()
        {
            self.values = values;
            self.start.clear();
        }
        self
    }

    /// Brings the state into this choice, as a picture of one moment shows it: what swings hangs still.
    pub(crate) fn apply(&self, pack: &Pack, state: &mut FaceState) -> Result<()> {
        self.pose(pack, state)?;
        Ok(state.settle(pack)?)
    }

    /// The same as the next frame of a film, so many seconds after the one before: what swings follows.
    pub(crate) fn apply_after(&self, secs: f64, pack: &Pack, state: &mut FaceState) -> Result<()> {
        self.pose(pack, state)?;
        Ok(state.swing(pack, secs)?)
    }

    /// The pose with life on top; what swings is where the pose has it.
    fn pose(&self, pack: &Pack, state: &mut FaceState) -> Result<()> {
        let mut values = Cow::Borrowed(&self.values);
        if let Some(life) = &self.life {
            life.over(values.to_mut())?;
        }
        self.apply_values(&values, pack, state)
    }

    /// The same with these values in place of its own: under single settings.
    pub(crate) fn apply_values(&self, values: &[f32], pack: &Pack, state: &mut FaceState) -> Result<()> {
        let set = |values: &mut [f32]| {
            for &(control, value) in &self.settings {
                values[control] = value;
            }
        };
        state.pose_with(pack, values, set, &self.locals)?;
        state.set_weights(&self.weights);
        Ok(())
    }
}

impl FaceArgs {
    /// Whether any face but that at rest is asked for.
    pub(crate) fn is_given(&self) -> bool {
        let is_posed = self.pose.is_some() || !self.set.is_empty() || !self.rotate.is_empty();
        is_posed || self.clip.is_some() || self.speech.is_given() || self.life.is_given()
    }

    /// Whether it is said how the face lives, or that it does not.
    pub(crate) fn says_life(&self) -> bool {
        self.life.is_given()
    }

    /// Looks all names up. `matches` tells the order in which options were given: where `--set` and
    /// `--rotate` concern one joint, the later one wins.
    pub(crate) fn resolve(&self, pack: &Pack, matches: &ArgMatches) -> Result<FaceChoice> {
        let mut values = pack.controls().defaults();
        if let Some(name) = &self.pose {
            let pose = usage::pose(pack, name)?;
            pose.values.iter().for_each(|&(control, value)| values[control] = value);
        }
        let positions = |option: &str| matches.indices_of(option).into_iter().flatten();
        let mut choice = FaceChoice::of_values(values);
        choice.start.extend(self.pose.iter().map(|pose| format!("pose={pose}")));
        let mut driven_later = Vec::new();
        for (setting, position) in self.set.iter().zip(positions("set")) {
            let (control, value) = self.setting(pack, setting)?;
            choice.settings.push((control, value));
            driven_later.push((joint_of(pack, control), position));
        }
        self.start_from_clip(pack, &mut choice)?;
        self.speak(pack, &mut choice)?;
        choice.life = self.life.begin(pack);
        if let Some(life) = &mut choice.life {
            life.go_to(self.time.into())?;
        }
        for (rotation, position) in self.rotate.iter().zip(positions("rotate")) {
            let joint = pack.rig().joint(&rotation.joint);
            let joint = joint.ok_or_else(|| {
                unknown("joint", &rotation.joint, pack.rig().names().iter().map(String::as_str))
            })?;
            if !driven_later.iter().any(|&(driven, later)| driven == Some(joint) && later > position) {
                choice.locals.push((joint, product(&rotation.factors)));
                choice.rotations.push(rotation.text.clone());
            }
        }
        Ok(choice)
    }

    /// Takes over what the clip sets, except for joints and shapes that single controls were set for.
    fn start_from_clip(&self, pack: &Pack, choice: &mut FaceChoice) -> Result<()> {
        let Some(clip) = &self.clip else { return Ok(()) };
        let at = clips::find(pack, clip)?.at(pack, self.time.into(), &mut choice.values)?;
        choice.start = vec![format!("clip={clip}"), format!("time={}", self.time)];
        let set = |control: &Control| {
            choice.settings.iter().any(|(index, _)| pack.controls().index(&control.name) == Some(*index))
        };
        let driven: Vec<&Control> =
            pack.controls().controls().iter().filter(|control| set(control)).collect();
        let is_joint_set = |joint: JointId| {
            driven.iter().any(|control| match &control.drives {
                Drive::Joint { joint: name, .. } => pack.rig().joint(name) == Some(joint),
                Drive::Shape { .. } => false,
            })
        };
        let is_shape_set = |shape: usize| {
            driven.iter().any(|control| match &control.drives {
                Drive::Shape { shape: name } => pack.follows(shape, name),
                Drive::Joint { .. } => false,
            })
        };
        let locals: Vec<_> = at.locals.into_iter().filter(|(joint, _)| !is_joint_set(*joint)).collect();
        let weights: Vec<_> = at.weights.into_iter().filter(|(shape, _)| !is_shape_set(*shape)).collect();
        choice.locals.extend(locals);
        choice.weights = weights;
        Ok(())
    }

    /// Adds what is spoken. Controls that speech concerns and that were set are part of the expression that
    /// it adds to, so that lips close all the same.
    fn speak(&self, pack: &Pack, choice: &mut FaceChoice) -> Result<()> {
        let Some(spoken) = Spoken::read(&self.speech, pack)? else { return Ok(()) };
        let (under, exact): (Vec<_>, Vec<_>) =
            choice.settings.iter().partition(|(control, _)| spoken.concerns(*control));
        choice.settings = exact;
        choice.start.extend(self.speech.describe());
        if self.clip.is_none() {
            choice.start.push(format!("time={}", self.time));
        }
        for (control, value) in under {
            choice.values[control] = value;
            choice.start.push(format!("{}={value}", pack.controls().controls()[control].name));
        }
        spoken.say(self.time.into(), &mut choice.values);
        Ok(())
    }

    fn setting(&self, pack: &Pack, setting: &Setting) -> Result<(usize, f32)> {
        let controls = pack.controls().controls();
        let index = pack.controls().index(&setting.control).ok_or_else(|| {
            unknown("control", &setting.control, controls.iter().map(|control| control.name.as_str()))
        })?;
        let control = &controls[index];
        let value = setting.value.clamp(control.min, control.max);
        if value != setting.value {
            let (min, max, found) = (control.min, control.max, setting.value);
            standard::warn(format_args!(
                "--set {}: expected {min} to {max}, found {found}: clamped to {value}",
                control.name
            ));
        }
        Ok((index, value))
    }
}

fn joint_of(pack: &Pack, control: usize) -> Option<JointId> {
    match &pack.controls().controls()[control].drives {
        Drive::Joint { joint, .. } => pack.rig().joint(joint),
        Drive::Shape { .. } => None,
    }
}
