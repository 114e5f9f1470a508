//! Numbers of accessors: glTF 2.0, sections 3.6.2.2 and 3.11 (normalised integers).

use gltf::json::accessor::ComponentType;

/// One component as f32. Normalised integers are divided by their largest value and do not fall below −1;
/// others are taken as they are. `bytes` has the component's size.
pub(super) fn float(kind: ComponentType, normalized: bool, bytes: &[u8]) -> f32 {
    let (value, largest) = match (kind, bytes) {
        (ComponentType::I8, &[a]) => (f32::from(i8::from_le_bytes([a])), f32::from(i8::MAX)),
        (ComponentType::U8, &[a]) => (f32::from(a), f32::from(u8::MAX)),
        (ComponentType::I16, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])), f32::from(i16::MAX)),
        (ComponentType::U16, &[a, b]) => (f32::from(u16::from_le_bytes([a, b])), f32::from(u16::MAX)),
        (ComponentType::U32, &[a, b, c, d]) => {
            let value = u32::from_le_bytes([a, b, c, d]);
            // The quotient is taken in f64, where both numbers are exact.
            return if normalized { (f64::from(value) / f64::from(u32::MAX)) as f32 } else { value as f32 };
        }
        (ComponentType::F32, &[a, b, c, d]) => return f32::from_le_bytes([a, b, c, d]),
        _ => return 0.0,
    };
    if normalized { (value / largest).max(-1.0) } else { value }
}

/// One component as a whole number; `None` for kinds with a sign or a fraction.
pub(super) fn whole(kind: ComponentType, bytes: &[u8]) -> Option<u32> {
    match (kind, bytes) {
        (ComponentType::U8, &[a]) => Some(a.into()),
        (ComponentType::U16, &[a, b]) => Some(u16::from_le_bytes([a, b]).into()),
        (ComponentType::U32, &[a, b, c, d]) => Some(u32::from_le_bytes([a, b, c, d])),
        _ => None,
    }
}
