//! A tracker's stream on any avatar.

use crate::calibration::Calibration;
use crate::route::Route;
use crate::space::Space;
use crate::standard::Standard;
use std::sync::Arc;

/// What one control of an avatar is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// What it shows: a name of a space.
    pub means: Option<(Standard, usize)>,
    /// The least value.
    pub min: f32,
    /// The largest value.
    pub max: f32,
    /// The value at rest.
    pub rest: f32,
}

/// The space and place of a control's name: ARKit's, those of the nine-joint face, expressions of VRM (also
/// custom ones that are named as ARKit's shapes, behind `expression.`), visemes, curves of MetaHuman, units
/// of MakeHuman.
pub fn meaning(name: &str) -> Option<(Standard, usize)> {
    // `jaw.open` is a joint in degrees, and not a spelling of `jawOpen`.
    if let Some(place) = Standard::Controls.space().index(name).filter(|_| name.contains('.')) {
        return Some((Standard::Controls, place));
    }
    let (name, spaces) = match name.strip_prefix("expression.") {
        Some(rest) => (rest, &[Standard::Vrm1, Standard::ArKit][..]),
        None => (name, &ORDER[..]),
    };
    spaces.iter().find_map(|space| Some((*space, space.space().find(name)?)))
}

/// The spaces in which an avatar is asked to show something, the finest first.
const ORDER: [Standard; 7] = [
    Standard::ArKit,
    Standard::Controls,
    Standard::MetaHuman,
    Standard::MakeHuman,
    Standard::MakeHumanPoses,
    Standard::Vrm1,
    Standard::Oculus,
];

/// Names that no map sets, since others say the same by side, and what they are where the others are missing.
const FOR_BOTH_SIDES: [(Standard, &str, [&str; 2]); 4] = [
    (Standard::Vrm1, "blink", ["eyeBlinkLeft", "eyeBlinkRight"]),
    (Standard::Controls, "smile", ["mouthSmileLeft", "mouthSmileRight"]),
    (Standard::Controls, "frown", ["mouthFrownLeft", "mouthFrownRight"]),
    (Standard::MakeHuman, "mouth-corner-puller", ["mouthSmileLeft", "mouthSmileRight"]),
];

/// The head's angles among Live Link's values, the controls that they turn, and the sign between them: a
/// positive pitch lifts the head, and `head.bow` nods it down.
const HEAD: [(&str, &str, f32); 3] =
    [("headYaw", "head.turn", 1.0), ("headPitch", "head.bow", -1.0), ("headRoll", "head.bend", 1.0)];

/// What moves a control.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// A value of one of the spaces in use.
    Value { space: usize, place: usize, rest: f32 },
    /// The mean of two of ARKit's values.
    Mean([usize; 2]),
    /// One of Live Link's angles, by a factor.
    Angle(usize, f32),
}

#[derive(Clone, Copy, Debug)]
struct Wire {
    control: usize,
    source: Source,
    range: Control,
    /// ARKit's values that move it, a bit for each.
    moved_by: u64,
}

/// A bit for each of these places.
fn bits(places: &[usize]) -> u64 {
    let bit = |place: &usize| u32::try_from(*place).ok().and_then(|place| 1u64.checked_shl(place));
    places.iter().filter_map(bit).fold(0, |bits, bit| bits | bit)
}

/// The way from the 61 values of Live Link Face (ARKit's 52, and angles) to the controls of one avatar.
///
/// Each of ARKit's values is shown once: by a shape of its own name, else by joints, else by expressions or
/// visemes. The head turns by its angles, eyes by ARKit's four directions.
#[derive(Clone, Debug)]
pub struct Retarget {
    calibration: Calibration,
    live: Vec<f32>,
    arkit: Vec<f32>,
    to_arkit: Route,
    spaces: Vec<(Route, Vec<f32>)>,
    wires: Vec<Wire>,
    unsaid: Vec<usize>,
}

impl Retarget {
    /// The way for an avatar with these controls.
    pub fn new(controls: &[Control]) -> Self {
        let arkit = Standard::ArKit.space();
        let live = Standard::LiveLink.space();
        let mut said = vec![false; arkit.len()];
        let mut spaces: Vec<(Route, Vec<f32>)> = Vec::new();
        let mut wires = Vec::new();
        let of_space = |space: Standard| {
            let place = move |control: &Control| control.means.filter(|(own, _)| *own == space);
            controls
                .iter()
                .enumerate()
                .filter_map(move |(at, control)| Some((at, place(control)?.1, *control)))
        };
        for standard in ORDER {
            let Some(route) = Route::between(Standard::ArKit, standard) else { continue };
            let mut newly = Vec::new();
            let number = spaces.len();
            let mut is_read = false;
            for (control, place, range) in of_space(standard) {
                let Some(name) = standard.space().names().get(place) else { continue };
                let sources = sources(&route, place, name.min < name.rest);
                // What others show already would be shown twice.
                if sources.iter().all(|source| said.get(*source) != Some(&false)) {
                    continue;
                }
                let source = Source::Value { space: number, place, rest: name.rest };
                wires.push(Wire { control, source, range, moved_by: bits(&sources) });
                is_read = true;
                newly.extend(sources);
            }
            for (_, name, sides) in FOR_BOTH_SIDES.iter().filter(|(space, ..)| *space == standard) {
                let Some(sources) = pair(arkit, *sides) else { continue };
                let is_said = |at: &usize| said.get(*at) == Some(&true) || newly.contains(at);
                let found =
                    of_space(standard).find(|(_, place, _)| standard.space().index(name) == Some(*place));
                if let Some((control, _, range)) = found.filter(|_| !sources.iter().any(is_said)) {
                    let moved_by = bits(&sources);
                    wires.push(Wire { control, source: Source::Mean(sources), range, moved_by });
                    newly.extend(sources);
                }
            }
            newly.iter().for_each(|at| said.get_mut(*at).into_iter().for_each(|said| *said = true));
            // Nobody computes what nothing reads.
            if is_read {
                spaces.push((route, standard.space().rest()));
            }
        }
        for (angle, name, sign) in HEAD {
            let place = Standard::Controls.space().index(name);
            let control = of_space(Standard::Controls).find(|(_, other, _)| Some(*other) == place);
            if let (Some(angle), Some((control, _, range))) = (live.index(angle), control) {
                let source = Source::Angle(angle, sign.to_degrees());
                wires.push(Wire { control, source, range, moved_by: 0 });
            }
        }
        Self {
            calibration: Calibration::new(live.clone()),
            live: live.rest(),
            arkit: arkit.rest(),
            to_arkit: Route::between(Standard::LiveLink, Standard::ArKit)
                .unwrap_or_else(|| Route::to_itself(arkit.clone())),
            spaces,
            wires,
            unsaid: (0..said.len()).filter(|at| said.get(*at) == Some(&false)).collect(),
        }
    }

    /// The person's neutral face and gains, over Live Link's values.
    pub fn calibration(&mut self) -> &mut Calibration {
        &mut self.calibration
    }

    /// The controls that it sets.
    pub fn controls(&self) -> impl Iterator<Item = usize> + '_ {
        self.wires.iter().map(|wire| wire.control)
    }

    /// Places of ARKit's values that the avatar cannot show.
    pub fn unsaid(&self) -> &[usize] {
        &self.unsaid
    }

    /// Sets the controls for a frame of Live Link's values, in its order; what is missing is at rest. Other
    /// controls are left as they are. Allocates nothing.
    pub fn apply(&mut self, live: &[f32], controls: &mut [f32]) {
        for (place, (slot, name)) in self.live.iter_mut().zip(self.calibration.space().names()).enumerate() {
            *slot = live.get(place).map_or(name.rest, |value| name.clean(*value));
        }
        self.calibration.apply(&mut self.live);
        self.to_arkit.apply(&self.live, &mut self.arkit);
        self.set(controls, true, u64::MAX);
    }

    /// As [`Self::apply`], of ARKit's 52 values in alphabetical order, without calibration; the head is left
    /// as it is.
    pub fn apply_arkit(&mut self, arkit: &[f32], controls: &mut [f32]) {
        self.apply_some(arkit, u64::MAX, controls);
    }

    /// As [`Self::apply_arkit`], of a tracker that says only some of the values: a bit for each that it says,
    /// the lowest for the first. Controls that others move are left as they are.
    pub fn apply_some(&mut self, arkit: &[f32], said: u64, controls: &mut [f32]) {
        let names = Standard::ArKit.space().names();
        for (place, (slot, name)) in self.arkit.iter_mut().zip(names).enumerate() {
            *slot = arkit.get(place).map_or(name.rest, |value| name.clean(*value));
        }
        self.set(controls, false, said);
    }

    fn set(&mut self, controls: &mut [f32], has_angles: bool, said: u64) {
        for (route, values) in &mut self.spaces {
            route.apply(&self.arkit, values);
        }
        let arkit = |place: usize| self.arkit.get(place).copied().unwrap_or(0.0);
        let is_said = |wire: &&Wire| said == u64::MAX || wire.moved_by & said != 0;
        for wire in self.wires.iter().filter(is_said) {
            let moved = match wire.source {
                Source::Value { space, place, rest } => self
                    .spaces
                    .get(space)
                    .and_then(|(_, values)| values.get(place))
                    .map_or(0.0, |value| value - rest),
                Source::Mean([left, right]) => (arkit(left) + arkit(right)) / 2.0,
                Source::Angle(_, _) if !has_angles => continue,
                Source::Angle(place, factor) => self.live.get(place).map_or(0.0, |angle| angle * factor),
            };
            let Control { min, max, rest, .. } = wire.range;
            if let Some(slot) = controls.get_mut(wire.control) {
                *slot = (rest + moved).max(min).min(max);
            }
        }
    }
}

fn pair(space: &Arc<Space>, names: [&str; 2]) -> Option<[usize; 2]> {
    Some([space.index(names[0])?, space.index(names[1])?])
}

/// The values of ARKit that a value of a route's end shows: those that move it up, and those that move it
/// down where it can be below rest. Others only hold it back.
fn sources(route: &Route, place: usize, is_signed: bool) -> Vec<usize> {
    let map = match route.maps() {
        [] => return vec![place],
        [only] => only,
        _ => return Vec::new(),
    };
    let rule = map.rules().iter().find(|rule| rule.to == place);
    let terms = rule.into_iter().flat_map(|rule| &rule.terms).filter(|term| is_signed || term.by > 0.0);
    terms.flat_map(|term| term.of.iter().copied()).collect()
}
