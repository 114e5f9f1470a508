use crate::{ApplyError, BindError, Control, ControlTable, Coupling, Drive, JointMotion};
use glam::{Affine3A, Vec3};
use rig_core::{Elementary, JointId, Locals, Rig};
use std::collections::HashMap;
use std::ops::Range;

/// A [`ControlTable`] bound to the joints of a rig and to a list of blend shapes.
#[derive(Clone, Debug)]
pub struct Binding {
    pub(crate) controls: Vec<Control>,
    pub(crate) couplings: Vec<Coupling>,
    /// The joints that controls drive, each with its range in `factors`.
    pub(crate) joints: Vec<(JointId, Range<usize>)>,
    pub(crate) factors: Vec<Factor>,
    /// Control and index of the weight that it sets.
    pub(crate) shapes: Vec<(usize, usize)>,
    pub(crate) joint_count: usize,
    pub(crate) shape_count: usize,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Factor {
    pub(crate) control: usize,
    pub(crate) axis: Vec3,
    pub(crate) kind: JointMotion,
}

impl ControlTable {
    /// Finds the joints and shapes that the controls name. `shapes` are the names of the weights, in their
    /// order.
    ///
    /// # Errors
    /// A control names a joint or a shape that does not exist.
    pub fn bind(&self, rig: &Rig, shapes: &[&str]) -> Result<Binding, BindError> {
        let mut by_joint: Vec<(JointId, Vec<Factor>)> = Vec::new();
        let mut places: HashMap<JointId, usize> = HashMap::new();
        let mut shape_places: HashMap<&str, Vec<usize>> = HashMap::new();
        shapes.iter().enumerate().for_each(|(at, name)| shape_places.entry(name).or_default().push(at));
        let mut bound_shapes = Vec::new();
        for (index, control) in self.controls().iter().enumerate() {
            match &control.drives {
                Drive::Joint { joint, axis, kind } => {
                    let id = rig.joint(joint).ok_or_else(|| BindError::UnknownJoint {
                        control: control.name.clone(),
                        joint: joint.clone(),
                        nearest: placed_toml::nearest(joint, rig.names().iter().map(String::as_str))
                            .map(str::to_owned),
                    })?;
                    let factor = Factor { control: index, axis: *axis, kind: *kind };
                    let place = *places.entry(id).or_insert(by_joint.len());
                    match by_joint.get_mut(place) {
                        Some((_, factors)) => factors.push(factor),
                        None => by_joint.push((id, vec![factor])),
                    }
                }
                Drive::Shape { shape } => {
                    // Parts may have shapes of one name, which move as one.
                    let named = shape_places.get(shape.as_str()).ok_or_else(|| BindError::UnknownShape {
                        control: control.name.clone(),
                        shape: shape.clone(),
                        nearest: placed_toml::nearest(shape, shapes.iter().copied()).map(str::to_owned),
                    })?;
                    bound_shapes.extend(named.iter().map(|at| (index, *at)));
                }
            }
        }
        let mut binding = Binding {
            controls: self.controls().to_vec(),
            couplings: self.couplings().to_vec(),
            joints: Vec::with_capacity(by_joint.len()),
            factors: Vec::new(),
            shapes: bound_shapes,
            joint_count: rig.len(),
            shape_count: shapes.len(),
        };
        for (joint, factors) in by_joint {
            let start = binding.factors.len();
            binding.factors.extend(factors);
            binding.joints.push((joint, start..binding.factors.len()));
        }
        Ok(binding)
    }
}

impl Binding {
    /// Lets controls follow others: writes the effective values to `out`. Without couplings, they are a copy
    /// of `values`. Allocates nothing.
    ///
    /// For every coupling in order, with the raw values `v` of both controls, `d` their defaults:
    ///
    /// ```text
    /// out[to] = clamp(out[to] + factor · (v[from] − d[from]) · fade(v[to]))
    /// fade(x) = 1 − r(u)        u = (x − d[to]) / (end − d[to]),  end = max if x ≥ d[to], else min
    /// r(u)    = 10u³ − 15u⁴ + 6u⁵
    /// ```
    ///
    /// The follower follows fully at its default and not at all at either end of its range: closed lids stay
    /// closed wherever the eyes look. `r` is the minimum-jerk step, so the fade has no kink at the default
    /// nor at the ends (a straight line would have both, and a lid that passes its default while the eye
    /// looks up would jerk): if the values are C², so is the sum, up to the clamp. The fade does not depend
    /// on the sign of the offset, or the lid would jerk as the eye passes the middle. The raw values are
    /// read, never the effective ones, so couplings cannot feed back.
    ///
    /// Values beyond the slices' common length are left alone.
    pub fn couple(&self, values: &[f32], out: &mut [f32]) {
        for (slot, value) in out.iter_mut().zip(values) {
            *slot = *value;
        }
        for coupling in &self.couplings {
            let (Some(from), Some(to)) = (values.get(coupling.from), values.get(coupling.to)) else {
                continue;
            };
            let (Some(leader), Some(follower)) =
                (self.controls.get(coupling.from), self.controls.get(coupling.to))
            else {
                continue;
            };
            let Some(slot) = out.get_mut(coupling.to) else { continue };
            let offset = coupling.factor * (from - leader.default);
            let coupled = *slot + offset * fade(*to, follower);
            // A NaN goes through to where it is reported; max and min would hide it.
            *slot = if coupled.is_nan() { coupled } else { coupled.max(follower.min).min(follower.max) };
        }
    }

    /// Sets the local transforms of all driven joints and the weights of all driven shapes; other joints and
    /// shapes stay as they are. Allocates nothing.
    ///
    /// `values` are one per control, in degrees, units of the rig or weights. They are taken as they are:
    /// ranges bind poses and players, but a caller may go beyond them. Where several controls drive one
    /// shape, the last one wins.
    ///
    /// # Errors
    /// A slice of another length than bound, or a value that is not finite; then nothing has been changed.
    pub fn apply(&self, values: &[f32], locals: &mut Locals, weights: &mut [f32]) -> Result<(), ApplyError> {
        let lengths = [
            ("control values", self.controls.len(), values.len()),
            ("local transforms", self.joint_count, locals.as_slice().len()),
            ("shape weights", self.shape_count, weights.len()),
        ];
        for (what, expected, found) in lengths {
            if expected != found {
                return Err(ApplyError::Length { what, expected, found });
            }
        }
        if let Some(control) = values.iter().position(|value| !value.is_finite()) {
            return Err(ApplyError::NotFinite { control, value: values[control] });
        }
        for (joint, range) in &self.joints {
            let factors = self.factors[range.clone()].iter();
            let local = factors.fold(Affine3A::IDENTITY, |left, factor| left * factor.matrix(values));
            locals.as_mut_slice()[joint.index()] = local;
        }
        for (control, shape) in &self.shapes {
            weights[*shape] = values[*control];
        }
        Ok(())
    }

    /// The elementary transformations of one control's joint at this value, with the joint; `None` for a
    /// shape.
    pub fn elementary(&self, control: usize, value: f32) -> Option<(JointId, Elementary)> {
        let (joint, factor) = self.joints.iter().find_map(|(joint, range)| {
            let factor = self.factors[range.clone()].iter().find(|factor| factor.control == control)?;
            Some((*joint, factor))
        })?;
        Some((joint, factor.elementary(value)))
    }
}

impl Factor {
    fn elementary(&self, value: f32) -> Elementary {
        match self.kind {
            JointMotion::Rotation => Elementary::Rotation { axis: self.axis, angle_rad: value.to_radians() },
            JointMotion::Translation => Elementary::Translation(self.axis * value),
        }
    }

    fn matrix(&self, values: &[f32]) -> Affine3A {
        self.elementary(values[self.control]).matrix()
    }
}

/// How much of a coupling acts on a follower at this value, 0 to 1.
fn fade(value: f32, follower: &Control) -> f32 {
    let end = if value >= follower.default { follower.max } else { follower.min };
    let way = end - follower.default;
    if way == 0.0 {
        // The default is an end of the range: at it, the follower is free.
        return 1.0;
    }
    let u = ((value - follower.default) / way).clamp(0.0, 1.0);
    1.0 - u * u * u * (10.0 + u * (6.0 * u - 15.0))
}
