//! The poses that an imported face begins with.

use super::shape_sets::ShapeSet;
use pose_anim::{Control, ControlTable, Drive, Pace, Pose, PoseSet, face};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::OnceLock;

/// How much of its range a control moves at least where a pose may be nothing without it.
const COUNTS: f32 = 1.0 / 3.0;
/// The share of the furthest move from which on a control leads: the pose is nothing without it.
const LEADS: f32 = 0.5;
/// The share of all moves that count which a face may lack, where none of them leads.
const SMALL: f32 = 1.0 / 3.0;

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

    /// Those of a control: one for each direction.
    fn of(control: &str) -> impl Iterator<Item = &'static Self> {
        Self::all().iter().filter(move |stand_in| stand_in.control == control)
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
/// one pose for each shape. `neutral` puts everything to rest. `known` says what the names of shapes mean.
pub(super) fn poses(controls: &ControlTable, known: &HashMap<String, (ShapeSet, &'static str)>) -> PoseSet {
    let translation = Translation::new(controls, known);
    let plain = PoseSet::default_face(&translation.nine_joints);
    let mut set = PoseSet::default_face(&translation.face);
    set.poses.retain_mut(|pose| {
        if !translation.has_shapes(pose) {
            let Some(plain) = plain.get(&pose.name) else { return false };
            pose.clone_from(plain);
        }
        translation.apply(pose)
    });
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

/// From poses of the nine-joint face, and of one that has the shapes of ARKit as well, to those of another.
struct Translation<'a> {
    nine_joints: ControlTable,
    /// The same controls, and behind them one for each shape of ARKit that has a name of its own.
    face: ControlTable,
    controls: &'a ControlTable,
    /// The controls of each shape that is known by its name: several, where nodes have it that differ.
    by_shape: HashMap<&'static str, Vec<usize>>,
}

impl<'a> Translation<'a> {
    fn new(controls: &'a ControlTable, known: &HashMap<String, (ShapeSet, &'static str)>) -> Self {
        let mut by_shape: HashMap<_, Vec<usize>> = HashMap::new();
        for (index, control) in controls.controls().iter().enumerate() {
            if let Drive::Shape { shape } = &control.drives
                && let Some((_, name)) = known.get(shape)
            {
                by_shape.entry(*name).or_default().push(index);
            }
        }
        let nine_joints = ControlTable::default_face();
        let shapes = ShapeSet::ArKit.names().iter().map(|name| {
            let drives = Drive::Shape { shape: (*name).to_owned() };
            let pace = Pace::named(name, &drives);
            Control { name: (*name).to_owned(), drives, min: 0.0, max: 1.0, default: 0.0, pace, group: None }
        });
        // No name is in both, which a test holds.
        let all = nine_joints.controls().iter().cloned().chain(shapes).collect();
        let face = ControlTable::new(all).unwrap_or_else(|_| nine_joints.clone());
        Self { nine_joints, face, controls, by_shape }
    }

    /// Whether the face has all shapes of ARKit that a pose moves.
    fn has_shapes(&self, pose: &Pose) -> bool {
        let further =
            pose.values.iter().filter(|(index, value)| *index >= self.nine_joints.len() && *value != 0.0);
        let mut names = further.filter_map(|(index, _)| self.face.controls().get(*index));
        names.all(|control| self.by_shape.contains_key(control.name.as_str()))
    }

    /// Says a pose in the controls of the other face; `false` where that cannot show it: where it lacks a
    /// control that leads, or more than a small share of what the pose does. What moves little, or not at
    /// all, takes no pose away.
    fn apply(&self, pose: &mut Pose) -> bool {
        let moves = self.moves(pose);
        let most = moves.iter().map(|one| one.amount).fold(0.0, f32::max);
        let counts = |one: &Move<'_>| one.amount >= COUNTS;
        let all: f32 = moves.iter().filter(|one| counts(one)).map(|one| one.amount).sum();
        let (mut missing, mut values) = (0.0, BTreeMap::new());
        for one in &moves {
            let is_shown = self.show(one, &mut values);
            if is_shown || !counts(one) {
                continue;
            }
            if one.amount >= LEADS * most {
                return false;
            }
            missing += one.amount;
        }
        if missing > SMALL * all {
            return false;
        }
        let timings = pose.timings.iter().flat_map(|(index, timing)| {
            let name = self.face.controls()[*index].name.as_str();
            let own = self.controls.index(name).into_iter();
            let shapes = StandIn::of(name).filter_map(|stand_in| self.shapes_of(stand_in)).flatten();
            own.chain(shapes).map(|here| (here, *timing))
        });
        pose.timings = timings.collect();
        pose.values = values.into_iter().collect();
        true
    }

    /// What the pose asks of each control of the nine-joint face.
    fn moves(&self, pose: &Pose) -> Vec<Move<'_>> {
        let value_of = |name: &str| self.face.index(name).and_then(|index| pose.value(index)).unwrap_or(0.0);
        // Shapes that close an eye close it by both lids.
        let open = |lid: &str| (1.0 - value_of(lid) / 45.0).clamp(0.0, 1.0);
        let of_control = |(index, value): &(usize, f32)| {
            let control = &self.face.controls()[*index];
            let share = match control.name.as_str() {
                face::LID_LEFT_LOWER => open(face::LID_LEFT_UPPER),
                face::LID_RIGHT_LOWER => open(face::LID_RIGHT_UPPER),
                _ => 1.0,
            };
            let limit = if *value < 0.0 { control.min } else { control.max };
            let is_by_the_way = match control.name.as_str() {
                // Heads turn in most poses, and none is about that alone.
                face::HEAD_TURN | face::HEAD_BOW | face::HEAD_BEND => true,
                face::LID_LEFT_UPPER => follows_gaze(*value, value_of(face::EYE_LEFT_UD)),
                face::LID_RIGHT_UPPER => follows_gaze(*value, value_of(face::EYE_RIGHT_UD)),
                _ => false,
            };
            let is_moved = *value != control.default && limit != 0.0;
            let amount = if is_moved && !is_by_the_way { share * (value / limit).abs() } else { 0.0 };
            Move { name: &control.name, value: *value, share, amount }
        };
        pose.values.iter().map(of_control).collect()
    }

    /// Shows a move by the control of its name, or by shapes that mean the same; `false` where the face has
    /// neither.
    fn show(&self, one: &Move<'_>, values: &mut BTreeMap<usize, f32>) -> bool {
        // What joints of the nine-joint face do, the face may do by this shape as well.
        if let Some(shapes) = self.by_shape.get(one.name) {
            for shape in shapes {
                let sum = values.entry(*shape).or_insert(0.0);
                *sum = sum.max(one.value);
            }
            return true;
        }
        if let Some(here) = self.controls.index(one.name) {
            let range = &self.controls.controls()[here];
            values.insert(here, one.value.max(range.min).min(range.max));
            return true;
        }
        let mut is_shown = false;
        for stand_in in StandIn::of(one.name) {
            // The shapes of the other direction go to rest.
            let weight = (one.value / stand_in.full).clamp(0.0, 1.0);
            match self.shapes_of(stand_in) {
                Some(shapes) => {
                    is_shown |= weight > 0.0;
                    for shape in shapes {
                        let sum = values.entry(shape).or_insert(0.0);
                        *sum = sum.max(one.share * weight);
                    }
                }
                // Half of a frown shows nothing, but must not stay from the pose before.
                None => {
                    let there = stand_in.ways.iter().flatten().filter_map(|shape| self.by_shape.get(shape));
                    for shape in there.flatten() {
                        values.entry(*shape).or_insert(0.0);
                    }
                }
            }
        }
        is_shown
    }

    /// The shapes that show what a stand-in is for, by their controls: the first way that the face has all
    /// shapes of.
    fn shapes_of(&self, stand_in: &StandIn) -> Option<Vec<usize>> {
        let mut ways = stand_in.ways.iter();
        let found: Vec<&Vec<usize>> =
            ways.find_map(|way| way.iter().map(|shape| self.by_shape.get(shape)).collect())?;
        Some(found.into_iter().flatten().copied().collect())
    }
}

/// What a pose asks of one control of the nine-joint face.
struct Move<'a> {
    name: &'a str,
    value: f32,
    /// How much of the value is left to shapes; what closes the eye from above leaves less to the lower lid.
    share: f32,
    /// How much of its range the control moves, `share` included; 0 for what every face can do without.
    amount: f32,
}

/// Whether an upper lid only goes along with its eye: the same way, and no further. Both in degrees; a lid
/// shuts with positive values, an eye looks up with them.
fn follows_gaze(lid: f32, eye_up: f32) -> bool {
    lid * eye_up < 0.0 && lid.abs() <= eye_up.abs()
}

#[cfg(test)]
mod tests {
    use super::super::spellings;
    use super::*;

    #[test]
    fn all_shapes_of_arkit_stand_behind_the_controls_of_the_nine_joint_face() {
        let translation = Translation::new(&ControlTable::default(), &HashMap::new()).face;
        assert_eq!(translation.len(), 15 + 52);
    }

    #[test]
    fn every_line_of_the_stand_ins_is_read_and_names_what_there_is() {
        let face = ControlTable::default_face();
        assert_eq!(StandIn::all().len(), 21);
        assert_eq!(lines().count(), 21, "no line is lost");
        for StandIn { control, full, ways } in StandIn::all() {
            let control = &face.controls()[face.index(control).expect(control)];
            assert!((control.min..=control.max).contains(full) && *full != 0.0, "{} {full}", control.name);
            for shape in ways.iter().flatten() {
                assert!(spellings::find(shape).is_some_and(|(_, name)| name == *shape), "{shape}");
            }
        }
    }
}
