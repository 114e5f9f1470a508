//! When the curves of a take have to be evaluated, so that straight lines between these times are what the
//! file says: at all keys, on both sides of jumps, and at the file's own frames where a curve is not
//! straight.

use crate::build::budget::{Budget, Exceeded};
use std::collections::{HashMap, HashSet};

/// Frames between two keys at most; where there are more, only every second one is sampled, or every fourth.
pub(super) const MAX_FRAMES_BETWEEN: f64 = 16384.0;
/// Repetitions of a curve beyond its keys at most.
pub(super) const MAX_CYCLES: f64 = 4096.0;

/// A time, and from which side of a jump it is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moment {
    /// In the file's time, in seconds.
    pub(super) time: f64,
    side: Side,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Side {
    Before,
    At,
    After,
}

impl Moment {
    pub(super) fn at(time: f64) -> Self {
        Self { time, side: Side::At }
    }

    /// The time to ask the library for.
    pub(super) fn asked(self) -> f64 {
        match self.side {
            Side::Before => self.time.next_down(),
            Side::At => self.time,
            Side::After => self.time.next_up(),
        }
    }
}

/// A property, and whether straight lines of it make none of what depends on it.
pub(super) type Source<'a> = (u32, &'a str, bool);

/// The curves of a take by the properties that they move.
pub(super) struct Curves<'a> {
    of_property: HashMap<(u32, &'a str), Vec<(&'a ufbx::AnimLayer, &'a ufbx::AnimValue)>>,
    /// Which property of which element a property of another one is read from.
    connections: &'a HashMap<(u32, &'a str), (u32, &'a str)>,
    /// Frames in a second.
    rate: f64,
    /// From and to when the take lasts; nothing if the file does not say.
    range: Option<(f64, f64)>,
    used: HashSet<(u32, &'a str)>,
    /// Curves that go on beyond their keys.
    pub(super) going_on: HashSet<u32>,
    /// Whether some frames were passed over, since there are too many.
    pub(super) is_thinned: bool,
    /// Whether some repetitions were left out, since there are too many.
    pub(super) has_fewer_cycles: bool,
    /// Whether some keys lie outside the take.
    pub(super) is_cut: bool,
}

/// Properties that are read from properties of other elements, as weights of shapes in old files are.
pub(super) fn connections(fbx: &ufbx::Scene) -> HashMap<(u32, &str), (u32, &str)> {
    let mut found = HashMap::new();
    for connection in fbx.connections_dst.iter().filter(|it| !it.src_prop.is_empty()) {
        let from = (connection.src.element_id, &*connection.src_prop);
        found.entry((connection.dst.element_id, &*connection.dst_prop)).or_insert(from);
    }
    found
}

impl<'a> Curves<'a> {
    pub(super) fn new(
        anim: &'a ufbx::Anim,
        connections: &'a HashMap<(u32, &'a str), (u32, &'a str)>,
        rate: f64,
        range: Option<(f64, f64)>,
    ) -> Self {
        let mut of_property: HashMap<_, Vec<_>> = HashMap::new();
        for layer in &anim.layers {
            let layer: &ufbx::AnimLayer = layer;
            for property in &layer.anim_props {
                let key = (property.element.element_id, &*property.prop_name);
                of_property.entry(key).or_default().push((layer, &*property.anim_value));
            }
        }
        Self {
            of_property,
            connections,
            rate,
            range,
            used: HashSet::new(),
            going_on: HashSet::new(),
            is_thinned: false,
            has_fewer_cycles: false,
            is_cut: false,
        }
    }

    /// When to evaluate what depends on these properties, in order; nothing where the take moves none of
    /// them.
    pub(super) fn moments(
        &mut self,
        sources: &[Source<'a>],
        budget: &mut Budget,
    ) -> Result<Option<Vec<Moment>>, Exceeded> {
        let mut moments = Vec::new();
        let mut is_moved = false;
        let mut weights = HashSet::new();
        for &(element, name, bends) in sources {
            let key = self.origin(element, name);
            let Some(values) = self.of_property.get(&key) else { continue };
            is_moved = true;
            self.used.insert(key);
            // Layers multiply, and turn what the ones below have turned.
            let bends = bends || values.len() > 1;
            let mut curves: Vec<(&ufbx::AnimCurve, bool)> = Vec::new();
            for (layer, value) in values {
                curves.extend(value.curves.iter().flatten().map(|curve| (&**curve, bends)));
                let weight = (layer.element.element_id, "Weight");
                if layer.weight_is_animated && weights.insert(weight.0) {
                    self.used.insert(weight);
                    let values = self.of_property.get(&weight).into_iter().flatten();
                    let of_weight = values.flat_map(|(_, value)| value.curves.iter().flatten());
                    curves.extend(of_weight.map(|curve| (&**curve, true)));
                }
            }
            for (curve, bends) in curves {
                if goes_on(curve) {
                    self.going_on.insert(curve.element.element_id);
                }
                self.curve(curve, bends, &mut moments, budget)?;
            }
        }
        if !is_moved {
            return Ok(None);
        }
        moments.retain(|moment| moment.time.is_finite());
        moments.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.side.cmp(&b.side)));
        moments.dedup();
        if let Some((begin, end)) = self.range {
            self.is_cut |= cut(&mut moments, begin, end);
        }
        if moments.is_empty() {
            moments.push(Moment::at(self.range.map_or(0.0, |range| range.0)));
        }
        // A key of what depends on them for each. Many curves share most of their moments, so these are
        // counted here, and not where they are gathered.
        budget.take(moments.len(), 1)?;
        Ok(Some(moments))
    }

    /// Names of properties that the take moves and nobody asked for.
    pub(super) fn unused(&self) -> Vec<&'a str> {
        let has_keys =
            |value: &ufbx::AnimValue| value.curves.iter().flatten().any(|curve| curve.keyframes.len() > 1);
        let unused = self.of_property.iter().filter(|(key, values)| {
            !self.used.contains(*key) && values.iter().any(|(_, value)| has_keys(value))
        });
        let mut names: Vec<&str> = unused.map(|((_, name), _)| *name).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// Where a property comes from, through connections.
    fn origin(&self, element: u32, name: &'a str) -> (u32, &'a str) {
        const MAX_STEPS: usize = 1000;
        let mut key = (element, name);
        for _ in 0..MAX_STEPS {
            match self.connections.get(&key) {
                Some(next) => key = *next,
                None => return key,
            }
        }
        (element, name)
    }

    fn curve(
        &mut self,
        curve: &ufbx::AnimCurve,
        bends: bool,
        moments: &mut Vec<Moment>,
        budget: &mut Budget,
    ) -> Result<(), Exceeded> {
        let first_moment = moments.len();
        budget.check(moments.len() + 2 * curve.keyframes.len())?;
        budget.look_at_keys(curve.keyframes.len())?;
        for key in &curve.keyframes {
            moments.push(Moment::at(key.time));
        }
        for (a, b) in curve.keyframes.iter().zip(curve.keyframes.iter().skip(1)) {
            if a.value == b.value && a.right.dy == 0.0 && b.left.dy == 0.0 {
                continue;
            }
            match a.interpolation {
                ufbx::Interpolation::ConstantPrev => {
                    moments.push(Moment { time: b.time, side: Side::Before });
                }
                ufbx::Interpolation::ConstantNext => {
                    moments.push(Moment { time: a.time, side: Side::After });
                }
                ufbx::Interpolation::Linear if !bends => {}
                _ => self.frames(a.time, b.time, moments, budget)?,
            }
        }
        let own: Vec<Moment> = match goes_on(curve) {
            true => moments[first_moment..].to_vec(),
            false => return Ok(()),
        };
        let Some((begin, end)) = self.range else { return Ok(()) };
        let (first, last) = (curve.min_time, curve.max_time);
        if is_going(&curve.pre_extrapolation) && begin < first {
            self.frames(begin, first, moments, budget)?;
            self.cycles(&curve.pre_extrapolation, &own, (first, last), first - begin, true, moments, budget)?;
            moments.push(Moment::at(begin));
        }
        if is_going(&curve.post_extrapolation) && end > last {
            self.frames(last, end, moments, budget)?;
            self.cycles(&curve.post_extrapolation, &own, (first, last), end - last, false, moments, budget)?;
            moments.push(Moment::at(end));
        }
        Ok(())
    }

    /// The keys of a curve's repetitions before or after it.
    #[allow(clippy::too_many_arguments, reason = "a helper of one caller")]
    fn cycles(
        &mut self,
        way: &ufbx::Extrapolation,
        own: &[Moment],
        (first, last): (f64, f64),
        length: f64,
        before: bool,
        moments: &mut Vec<Moment>,
        budget: &mut Budget,
    ) -> Result<(), Exceeded> {
        let duration = last - first;
        if way.mode == ufbx::ExtrapolationMode::Slope || duration <= 0.0 {
            return Ok(());
        }
        let told = if way.repeat_count > 0 { f64::from(way.repeat_count) } else { f64::INFINITY };
        let all = (length / duration).ceil().min(told);
        self.has_fewer_cycles |= all > MAX_CYCLES;
        for cycle in 1..=all.min(MAX_CYCLES) as u32 {
            budget.check(moments.len() + own.len() + 2)?;
            budget.look_at_keys(own.len() + 2)?;
            let start = if before {
                first - f64::from(cycle) * duration
            } else {
                last + f64::from(cycle - 1) * duration
            };
            let mirrored = way.mode == ufbx::ExtrapolationMode::Mirror && cycle % 2 == 1;
            moments.extend(own.iter().map(|moment| match (mirrored, moment.side) {
                (false, side) => Moment { time: start + (moment.time - first), side },
                (true, Side::At) => Moment::at(start + (last - moment.time)),
                (true, side) => {
                    let side = if side == Side::Before { Side::After } else { Side::Before };
                    Moment { time: start + (last - moment.time), side }
                }
            }));
            // Where the end of one meets the beginning of the next, there may be a jump.
            let seam = if before { start + duration } else { start };
            moments.extend([Side::Before, Side::After].map(|side| Moment { time: seam, side }));
        }
        Ok(())
    }

    /// All frames between two times, without these.
    fn frames(
        &mut self,
        from: f64,
        to: f64,
        moments: &mut Vec<Moment>,
        budget: &mut Budget,
    ) -> Result<(), Exceeded> {
        let (first, last) = ((from * self.rate).floor() + 1.0, (to * self.rate).ceil() - 1.0);
        let mut step = 1.0;
        while (last - first) / step > MAX_FRAMES_BETWEEN {
            step *= 2.0;
            self.is_thinned = true;
        }
        let count = ((last - first) / step).floor() + 1.0;
        if count.is_nan() || count < 1.0 {
            return Ok(());
        }
        budget.check(moments.len() + count as usize)?;
        budget.look_at_keys(count as usize)?;
        let time = |frame: u32| (first + f64::from(frame) * step) / self.rate;
        moments.extend((0..count as u32).map(time).filter(|time| from < *time && *time < to).map(Moment::at));
        Ok(())
    }
}

/// Removes moments outside a take. Where there were some, the take's begin or end is a moment instead, so
/// that the value there is kept. Returns whether any was removed.
fn cut(moments: &mut Vec<Moment>, begin: f64, end: f64) -> bool {
    let all = moments.len();
    let is_before = |it: &Moment| it.time < begin || (it.time == begin && it.side == Side::Before);
    moments.drain(..moments.partition_point(is_before));
    let from_begin = moments.len();
    if from_begin < all && moments.first().is_none_or(|first| *first != Moment::at(begin)) {
        moments.insert(0, Moment::at(begin));
    }
    let up_to_end = |it: &Moment| it.time < end || (it.time == end && it.side != Side::After);
    let kept = moments.partition_point(up_to_end);
    let goes_beyond = kept < moments.len();
    moments.truncate(kept);
    if goes_beyond && moments.last().is_none_or(|last| last.time < end) {
        moments.push(Moment::at(end));
    }
    from_begin < all || goes_beyond
}

fn goes_on(curve: &ufbx::AnimCurve) -> bool {
    curve.keyframes.len() > 1 && (is_going(&curve.pre_extrapolation) || is_going(&curve.post_extrapolation))
}

fn is_going(way: &ufbx::Extrapolation) -> bool {
    match way.mode {
        ufbx::ExtrapolationMode::Constant => false,
        ufbx::ExtrapolationMode::Slope => true,
        _ => way.repeat_count != 0,
    }
}
