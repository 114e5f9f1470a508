//! Changes JSON as JSON: blind changes of its text mostly end in a text that is no JSON any more.

use crate::packed::{SEPARATOR, text_and_bytes};
use serde_json::Value;

/// SplitMix64 (Steele, Lea and Flood, 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }
}

/// A mutator of libFuzzer for JSON, [`SEPARATOR`], bytes: `data[..size]` becomes another input of at most
/// `max_size` bytes, whose length is returned. `blind` changes bytes without knowing what they are; it has
/// libFuzzer's dictionary. One change in four is blind, and every change of what is no JSON.
pub fn mutate_json(
    data: &mut [u8],
    size: usize,
    max_size: usize,
    seed: u32,
    blind: impl Fn(&mut [u8], usize, usize) -> usize,
) -> usize {
    let mut random = Random(u64::from(seed));
    let (json, bytes) = text_and_bytes(&data[..size]);
    let kind = random.below(8);
    let Some(mut root) = serde_json::from_slice::<Value>(json).ok().filter(|_| kind != 0) else {
        return blind(data, size, max_size);
    };
    let mut bytes = bytes.to_vec();
    if kind == 1 {
        let length = bytes.len();
        bytes.resize((length + 64).min(max_size), 0);
        let room = bytes.len();
        let length = blind(&mut bytes, length.min(room), room);
        bytes.truncate(length);
    } else {
        for _ in 0..=random.below(3) {
            change(&mut root, &mut random);
        }
    }
    let mut out = root.to_string().into_bytes();
    out.push(SEPARATOR);
    out.extend(&bytes);
    if out.len() > max_size {
        return blind(data, size, max_size);
    }
    data[..out.len()].copy_from_slice(&out);
    out.len()
}

/// How many values a tree has, itself included.
fn count(value: &Value) -> usize {
    1 + match value {
        Value::Array(list) => list.iter().map(count).sum(),
        Value::Object(map) => map.values().map(count).sum(),
        _ => 0,
    }
}

/// The value of this number in a tree, counted from its root.
fn find<'a>(value: &'a mut Value, number: &mut usize) -> Option<&'a mut Value> {
    if *number == 0 {
        return Some(value);
    }
    *number -= 1;
    match value {
        Value::Array(list) => list.iter_mut().find_map(|child| find(child, number)),
        Value::Object(map) => map.values_mut().find_map(|child| find(child, number)),
        _ => None,
    }
}

fn any<'a>(root: &'a mut Value, random: &mut Random) -> Option<&'a mut Value> {
    let mut number = random.below(count(root));
    find(root, &mut number)
}

/// Numbers that files lie with.
const NUMBERS: [f64; 16] = [
    0.0,
    1.0,
    2.0,
    3.0,
    4.0,
    -1.0,
    0.5,
    255.0,
    256.0,
    65_535.0,
    65_536.0,
    2_147_483_648.0,
    4_294_967_295.0,
    1e18,
    1e39,
    1e-40,
];

fn change(root: &mut Value, random: &mut Random) {
    let copy = any(root, random).cloned();
    let Some(place) = any(root, random) else { return };
    match (random.below(6), place) {
        (0, place) => {
            if let Some(copy) = copy {
                *place = copy;
            }
        }
        (_, Value::Number(number)) => {
            let old = number.as_f64().unwrap_or(0.0);
            let new = match random.below(5) {
                0 => old + 1.0,
                1 => old - 1.0,
                2 => old * 2.0,
                _ => NUMBERS[random.below(NUMBERS.len())],
            };
            let is_whole = new == new.trunc() && new.abs() < 1e15;
            let text = if is_whole { format!("{}", new as i64) } else { format!("{new:e}") };
            *number = serde_json::from_str(&text).unwrap_or_else(|_| 0.into());
        }
        (1, Value::Array(list)) if !list.is_empty() => {
            list.remove(random.below(list.len()));
        }
        (2, Value::Array(list)) if list.len() > 1 => {
            let (a, b) = (random.below(list.len()), random.below(list.len()));
            list.swap(a, b);
        }
        (_, Value::Array(list)) => {
            let twice = list.get(random.below(list.len())).cloned();
            list.extend(twice.or(copy));
        }
        (1, Value::Object(map)) if !map.is_empty() => {
            let key = map.keys().nth(random.below(map.len())).cloned().unwrap_or_default();
            map.shift_remove(&key);
        }
        (2, Value::Object(map)) if !map.is_empty() => {
            // Another member gets this one's value.
            let key = map.keys().nth(random.below(map.len())).cloned().unwrap_or_default();
            map.insert(key, copy.unwrap_or(Value::Null));
        }
        (_, Value::Object(map)) => {
            if let Some(Value::Object(other)) = copy {
                map.extend(other);
            }
        }
        (_, Value::Bool(value)) => *value = !*value,
        (_, place @ Value::Null) => *place = copy.unwrap_or(Value::Bool(true)),
        (1, Value::String(text)) => text.clear(),
        (2, Value::String(text)) => text.push('~'),
        (_, place @ Value::String(_)) => {
            if let Some(copy @ Value::String(_)) = copy {
                *place = copy;
            }
        }
    }
}
