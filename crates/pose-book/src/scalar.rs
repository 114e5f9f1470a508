//! Single values, written the way a person would.

use pose_anim::Easing;
use toml_edit::{Array, Item, Value};

/// A number: whole ones without a point, others with as few digits as identify it.
pub(crate) fn number(value: f32) -> Value {
    // Beyond 2²⁴ an f32 does not hold every whole number, so the digits would claim too much.
    if value.fract() == 0.0 && value.abs() < 16_777_216.0 {
        // Also takes the sign from zero.
        Value::from(value as i64)
    } else {
        // The shortest decimal that is this number at 32 bits, not the longer one at 64.
        Value::from(value.to_string().parse().unwrap_or(f64::from(value)))
    }
}

/// A number in full precision.
pub(crate) fn precise(value: f64) -> Value {
    if value.fract() == 0.0 && value.abs() < 1e9 { Value::from(value as i64) } else { Value::from(value) }
}

pub(crate) fn easing(easing: Easing) -> Value {
    match (easing.name(), easing) {
        (Some(name), _) => Value::from(name),
        (None, Easing::Bezier(handles)) => Value::from(handles.into_iter().map(precise).collect::<Array>()),
        // Every other function has a name.
        (None, _) => Value::from("linear"),
    }
}

/// Replaces a text or a number that is read at 32 bits; what stands around it, such as a comment behind it,
/// stays. A value that already says the same keeps its spelling.
pub(crate) fn put(item: &mut Item, value: Value) {
    replace(item, value, |old, new| old as f32 == new as f32);
}

/// As [`put`], for a number that is read in full precision.
pub(crate) fn put_precise(item: &mut Item, value: Value) {
    replace(item, value, |old, new| old == new);
}

fn replace(item: &mut Item, mut value: Value, same: impl FnOnce(f64, f64) -> bool) {
    if let Some(old) = item.as_value() {
        let is_same = match (as_number(old), as_number(&value)) {
            (Some(old), Some(new)) => same(old, new),
            _ => old.as_str().is_some() && old.as_str() == value.as_str(),
        };
        if is_same {
            return;
        }
        *value.decor_mut() = old.decor().clone();
    }
    *item = Item::Value(value);
}

fn as_number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}
