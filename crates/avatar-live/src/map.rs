//! From channels to the controls of an avatar.

use crate::Frame;
use crate::channel::{CHANNELS, EXPRESSIONS, EYE_LEFT_LR, EYE_RIGHT_UD, SHAPES, channels, find};
use face_space::{Control, Retarget, Route, Standard, meaning};
use pose_anim::ControlTable;

/// An avatar with fewer of ARKit's shapes is not one that has them.
const FEW: usize = 13;

/// A control that one channel sets by itself: an angle, or an expression of VRM.
#[derive(Clone, Copy, Debug)]
struct Wire {
    control: usize,
    channel: usize,
    min: f32,
    max: f32,
    default: f32,
}

impl Wire {
    fn new(controls: &ControlTable, name: &str, channel: usize) -> Option<Self> {
        let control = place(controls, name)?;
        let pose_anim::Control { min, max, default, .. } = *controls.controls().get(control)?;
        Some(Self { control, channel, min, max, default })
    }

    fn set(&self, value: f32, values: &mut [f32]) {
        if let Some(slot) = values.get_mut(self.control) {
            *slot = (self.default + value).clamp(self.min, self.max);
        }
    }
}

/// The control of a channel's name. An avatar's expressions of VRM have `expression.` before theirs.
fn place(controls: &ControlTable, name: &str) -> Option<usize> {
    controls.index(name).or_else(|| controls.index(&format!("expression.{name}")))
}

/// Which controls of an avatar the channels move. Shapes go by [`Retarget`], to whatever the avatar has:
/// shapes of ARKit, joints, expressions of VRM, visemes, curves of MetaHuman, units of MakeHuman. Expressions
/// move those of the same name; a sender that has no shapes moves an avatar's shapes by the map from one to
/// the other. Where avatar and frame both have the shapes that look (`eyeLook…`), these turn the eyes;
/// otherwise the frame's angles do, or, where it has none, angles computed from those shapes.
#[derive(Clone, Debug)]
pub struct ControlMap {
    retarget: Retarget,
    /// Places of the shapes' channels among ARKit's names.
    places: Vec<usize>,
    /// The same of the expressions' channels among VRM's.
    expression_places: Vec<usize>,
    /// From expressions to shapes, for avatars that have shapes.
    to_shapes: Option<Route>,
    shapes: Vec<f32>,
    expressions: Vec<f32>,
    wires: Vec<Wire>,
    /// Whether the avatar has shapes that look.
    looks: bool,
    unmoved: Vec<&'static str>,
}

impl ControlMap {
    /// The map of an avatar's controls, by their names.
    pub fn new(controls: &ControlTable) -> Self {
        let all = controls.controls().iter().map(|control| Control {
            means: meaning(&control.name),
            min: control.min,
            max: control.max,
            rest: control.default,
        });
        Self::with(controls, Retarget::new(&all.collect::<Vec<_>>()))
    }

    /// The map of an avatar's controls, with the way that ARKit's shapes take to them.
    pub fn with(controls: &ControlTable, retarget: Retarget) -> Self {
        let (mut wires, mut unmoved, mut shapes) = (Vec::new(), Vec::new(), 0);
        for (channel, about) in channels().iter().enumerate() {
            if place(controls, about.name).is_none() {
                unmoved.push(about.name);
            } else if channel < SHAPES {
                shapes += 1;
            } else {
                wires.extend(Wire::new(controls, about.name, channel));
            }
        }
        let places = |space: Standard, from: usize, to: usize| {
            let names = channels().get(from..to).unwrap_or_default().iter();
            names.map(|channel| space.space().index(channel.name).unwrap_or(usize::MAX)).collect()
        };
        let to_shapes = (shapes >= FEW).then(|| Route::between(Standard::Vrm1, Standard::ArKit)).flatten();
        Self {
            retarget,
            places: places(Standard::ArKit, 0, SHAPES),
            expression_places: places(Standard::Vrm1, EXPRESSIONS, CHANNELS),
            to_shapes,
            shapes: Standard::ArKit.space().rest(),
            expressions: Standard::Vrm1.space().rest(),
            wires,
            looks: controls.index("eyeLookOutLeft").is_some(),
            unmoved,
        }
    }

    /// Names of the channels that the avatar has no control for, of the same name.
    pub fn unmoved(&self) -> &[&'static str] {
        &self.unmoved
    }

    /// Sets the controls that the frame's channels move. `values` are those of all controls of the avatar, an
    /// entry for each control. Others stay as they are.
    pub fn apply(&mut self, frame: &Frame, values: &mut [f32]) {
        let has = |name: &[u8]| frame.get(find(name).unwrap_or(CHANNELS)).is_some();
        if self.take(frame, 0) {
            // What the frame says in the avatar's own names is set after this, and counts.
            let (shapes, places) = (&self.shapes, &self.places);
            let channels = places.iter().enumerate().filter(|(channel, _)| frame.get(*channel).is_some());
            let bit = |place: usize| u32::try_from(place).ok().and_then(|place| 1u64.checked_shl(place));
            let said = channels.fold(0, |said, (_, place)| said | bit(*place).unwrap_or_default());
            self.retarget.apply_some(shapes, said, values);
        } else if has(b"aa")
            && self.to_shapes.is_some()
            && self.take(frame, EXPRESSIONS)
            && let Some(route) = &mut self.to_shapes
        {
            route.apply(&self.expressions, &mut self.shapes);
            self.retarget.apply_arkit(&self.shapes, values);
        }
        let is_looking = has(b"eyeLookOutLeft");
        for wire in &self.wires {
            let value = match (EYE_LEFT_LR..=EYE_RIGHT_UD).contains(&wire.channel) {
                true if is_looking && self.looks => Some(0.0),
                _ => frame.get(wire.channel),
            };
            if let Some(value) = value {
                wire.set(value, values);
            }
        }
    }

    /// Takes the frame's shapes, or its expressions, in the order of their space; whether there are any.
    fn take(&mut self, frame: &Frame, first: usize) -> bool {
        let (places, slots) = match first {
            0 => (&self.places, &mut self.shapes),
            _ => (&self.expression_places, &mut self.expressions),
        };
        let mut has = false;
        for (channel, place) in places.iter().enumerate() {
            let value = frame.get(first + channel);
            has |= value.is_some();
            if let Some(slot) = slots.get_mut(*place) {
                *slot = value.unwrap_or_default();
            }
        }
        has
    }
}
