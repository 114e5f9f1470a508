//! Single values, written the way a person would.

use pose_anim::Easing;
use toml_edit::{Array, Item, Value};

/// A number: whole ones without a point, others with as few digits as say it.
pub(crate) fn number(value: f32) -> Value {
    // Beyond 2²⁴ not every whole number is one, so the digits would claim too much.
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

/// Puts a value in the place of another, whose surroundings (a comment behind it) stay.
pub(crate) fn put(item: &mut Item, mut value: Value) {
    if let Some(old) = item.as_value() {
        if same(old, &value) {
            return;
        }
        *value.decor_mut() = old.decor().clone();
    }
    *item = Item::Value(value);
}

/// Whether both are the same number or string, however spelt.
fn same(a: &Value, b: &Value) -> bool {
    let number = |value: &Value| value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64));
    match (number(a), number(b)) {
        (Some(a), Some(b)) => a as f32 == b as f32,
        _ => a.as_str().is_some() && a.as_str() == b.as_str(),
    }
}
