//! The poses that an imported face begins with.

use super::shape_sets::ShapeSet;
use pose_anim::{Control, ControlTable, Drive, Pose, PoseSet, face};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::OnceLock;

/// How much of its range a control moves at least in a pose that is nothing without it.
const LEADS: f32 = 1.0 / 3.0;

/// Shapes that show what a control of the nine-joint face does: a line of `assets/stand_ins.txt`.
struct StandIn {
    control: &'static str,
    /// The control's value at which the shapes are there in full.
    full: f32,
    /// Ways to show it, each a list of shapes. A face uses the first way whose shapes it has all of.
    ways: Vec<Vec<&'static str>>,
}

const STAND_INS: &str = include_str!("../../assets/stand_ins.txt");

impl StandIn {
    /// All of them.
    fn all() -> &'static [Self] {
        static ALL: OnceLock<Vec<StandIn>> = OnceLock::new();
        ALL.get_or_init(|| lines().filter_map(Self::of_line).collect())
    }

    fn of_line(line: &'static str) -> Option<Self> {
        let (what, ways) = line.split_once('=')?;
        let (control, full) = what.trim().split_once(' ')?;
        let way = |way: &'static str| way.split('+').map(str::trim).collect();
        Some(Self { control, full: full.trim().parse().ok()?, ways: ways.split('|').map(way).collect() })
    }
}

fn lines() -> impl Iterator<Item = &'static str> {
    STAND_INS.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'))
}

/// The default poses whose main features the face can show, by joints or by shapes that mean the same, and
/// one pose for each shape. `neutral` puts everything to rest.
pub(super) fn poses(controls: &ControlTable) -> PoseSet {
    let translation = Translation::new(controls);
    let mut set = PoseSet::default_face(&translation.face);
    set.poses.retain_mut(|pose| translation.apply(pose));
    let rest = Pose::from_values("neutral", &controls.defaults());
    match set.poses.iter_mut().find(|pose| pose.name == rest.name) {
        Some(neutral) => neutral.values = rest.values,
        None => set.poses.insert(0, rest),
    }
    let usual: HashSet<String> = set.iter().map(|pose| pose.name.clone()).collect();
    for (index, control) in controls.controls().iter().enumerate() {
        let is_shape = matches!(control.drives, Drive::Shape { .. });
        // Names of controls are unique.
        if is_shape && !usual.contains(&control.name) {
            let pose = Pose::new(&control.name, vec![(index, control.max)]);
            set.poses.push(pose);
        }
    }
    set
}

/// From poses of the nine-joint face to those of another.
struct Translation<'a> {
    face: ControlTable,
    controls: &'a ControlTable,
    /// The first control of each shape that is known by its name.
    by_shape: HashMap<&'static str, usize>,
}

impl<'a> Translation<'a> {
    fn new(controls: &'a ControlTable) -> Self {
        let mut by_shape = HashMap::new();
        for (index, control) in controls.controls().iter().enumerate() {
            if let Drive::Shape { shape } = &control.drives
                && let Some((_, name)) = ShapeSet::find(shape)
            {
                by_shape.entry(name).or_insert(index);
            }
        }
        Self { face: ControlTable::default_face(), controls, by_shape }
    }

    /// Says a pose in the controls of the other face; `false` where that cannot show it.
    fn apply(&self, pose: &mut Pose) -> bool {
        let value_of = |name: &str| self.face.index(name).and_then(|index| pose.value(index)).unwrap_or(0.0);
        // Shapes that close an eye close it by both lids.
        let open = |lid: &str| (1.0 - value_of(lid) / 45.0).clamp(0.0, 1.0);
        let moved = |(control, value): &(&Control, f32)| *value != control.default;
        let of_face = pose.values.iter().map(|(index, value)| (&self.face.controls()[*index], *value));
        let has_leader = of_face.clone().filter(moved).any(|(control, value)| leads(control, value));
        let mut values: BTreeMap<usize, f32> = BTreeMap::new();
        for (control, value) in of_face {
            let name = control.name.as_str();
            if let Some(here) = self.controls.index(name) {
                let range = &self.controls.controls()[here];
                values.insert(here, value.max(range.min).min(range.max));
                continue;
            }
            let share = match name {
                face::LID_LEFT_LOWER => open(face::LID_LEFT_UPPER),
                face::LID_RIGHT_LOWER => open(face::LID_RIGHT_UPPER),
                _ => 1.0,
            };
            let mut is_shown = !moved(&(control, value)) || has_leader && !leads(control, value);
            for (full, shapes) in self.shapes_for(name) {
                // The shapes of the other direction go to rest.
                let weight = (value / full).clamp(0.0, 1.0);
                is_shown |= weight > 0.0;
                for shape in shapes {
                    let sum = values.entry(shape).or_insert(0.0);
                    *sum = sum.max(share * weight);
                }
            }
            if !is_shown {
                return false;
            }
        }
        let timings = pose.timings.iter().flat_map(|(index, timing)| {
            let name = self.face.controls()[*index].name.as_str();
            let own = self.controls.index(name).into_iter();
            own.chain(self.shapes_for(name).flat_map(|(_, shapes)| shapes)).map(|here| (here, *timing))
        });
        pose.timings = timings.collect();
        pose.values = values.into_iter().collect();
        true
    }

    /// The shapes that stand for a control in each of its directions, by their controls, and its value where
    /// they are there in full.
    fn shapes_for(&self, control: &str) -> impl Iterator<Item = (f32, Vec<usize>)> {
        let stand_ins = StandIn::all().iter().filter(move |stand_in| stand_in.control == control);
        stand_ins.filter_map(|StandIn { full, ways, .. }| {
            let all = |way: &Vec<&str>| way.iter().map(|shape| self.by_shape.get(shape).copied()).collect();
            Some((*full, ways.iter().find_map(all)?))
        })
    }
}

/// Whether a pose is nothing without this. Heads turn in most of them, and none is about that alone.
fn leads(control: &Control, value: f32) -> bool {
    let limit = if value < 0.0 { control.min } else { control.max };
    ![face::HEAD_TURN, face::HEAD_BOW, face::HEAD_BEND].contains(&control.name.as_str())
        && (value / limit).abs() >= LEADS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_of_the_stand_ins_is_read_and_names_what_there_is() {
        let face = ControlTable::default_face();
        assert_eq!(StandIn::all().len(), 21);
        assert_eq!(lines().count(), 21, "no line is lost");
        for StandIn { control, full, ways } in StandIn::all() {
            let control = &face.controls()[face.index(control).expect(control)];
            assert!((control.min..=control.max).contains(full) && *full != 0.0, "{} {full}", control.name);
            for shape in ways.iter().flatten() {
                assert!(ShapeSet::find(shape).is_some_and(|(_, name)| name == *shape), "{shape}");
            }
        }
    }
}
