//! What a `materials.toml` may hold, stated once for the reader and the writer.

use crate::Material;
use avatar_mesh::PartKind;
use placed_toml::{Field, Slot};

const fn one(name: &'static str, max: f32, slot: fn(&mut Material) -> &mut f32) -> Field<Material> {
    Field::one(name, 0.0, max, slot)
}

const fn three(name: &'static str, slot: fn(&mut Material) -> &mut [f32; 3]) -> Field<Material> {
    Field::three(name, 0.0, 1.0, slot)
}

/// The keys of all tables, in the order in which they are written.
pub(crate) const FIELDS: [Field<Material>; 18] = [
    three("color", |m| &mut m.color),
    one("opacity", 1.0, |m| &mut m.opacity),
    one("reflectance", 1.0, |m| &mut m.reflectance),
    one("roughness_matte", 1.0, |m| &mut m.roughness_matte),
    one("roughness_glossy", 1.0, |m| &mut m.roughness_glossy),
    one("normal_strength", 10.0, |m| &mut m.normal_strength),
    three("wrap", |m| &mut m.wrap),
    three("scatter", |m| &mut m.scatter),
    one("sharp_share", 1.0, |m| &mut m.sharp_share),
    one("sharp_roughness", 1.0, |m| &mut m.sharp_roughness),
    one("transmission", 10.0, |m| &mut m.transmission),
    one("thickness", 1.0, |m| &mut m.thickness),
    one("pore_strength", 10.0, |m| &mut m.pore_strength),
    one("pore_density", 10_000.0, |m| &mut m.pore_density),
    one("wrinkle_depth", 1.0, |m| &mut m.wrinkle_depth),
    one("wetness", 1.0, |m| &mut m.wetness),
    one("film_roughness", 1.0, |m| &mut m.film_roughness),
    one("back_light", 1.0, |m| &mut m.back_light),
];

/// The table of [`TONE_FIELDS`]; skins only.
const TONE: &str = "tone";

/// The keys of a `tone` table.
const TONE_FIELDS: [Field<Material>; 2] =
    [three("color", |m| &mut m.tone.color), three("painted", |m| &mut m.tone.painted)];

/// The table of [`IRIS_FIELDS`]; eyeballs only.
const IRIS: &str = "iris";

/// The keys of an `iris` table.
const IRIS_FIELDS: [Field<Material>; 9] = [
    Field::one("refractive_index", 1.0, 3.0, |m| &mut m.iris.refractive_index),
    one("depth", 1.0, |m| &mut m.iris.depth),
    one("pupil", 1.0, |m| &mut m.iris.pupil),
    one("painted_pupil", 1.0, |m| &mut m.iris.painted_pupil),
    one("radius", 1.0, |m| &mut m.iris.radius),
    one("limbal_width", 1.0, |m| &mut m.iris.limbal_width),
    one("limbal_darkness", 1.0, |m| &mut m.iris.limbal_darkness),
    three("color", |m| &mut m.iris.color),
    three("painted_color", |m| &mut m.iris.painted_color),
];

/// The table that parts of this kind have within their own, and its keys.
pub(crate) fn own_table(kind: PartKind) -> Option<(&'static str, &'static [Field<Material>])> {
    match kind {
        PartKind::Skin => Some((TONE, &TONE_FIELDS)),
        PartKind::Eyeball => Some((IRIS, &IRIS_FIELDS)),
        PartKind::Surface | PartKind::Cornea => None,
    }
}

/// The material with each number between the least and the largest that a file may hold; NaN becomes the
/// least.
pub(crate) fn in_range(mut material: Material) -> Material {
    for field in FIELDS.iter().chain(&TONE_FIELDS).chain(&IRIS_FIELDS) {
        let within = |value: &mut f32| *value = value.max(field.min).min(field.max);
        match field.slot {
            Slot::One(slot) => within(slot(&mut material)),
            Slot::Three(slot) => slot(&mut material).iter_mut().for_each(within),
        }
    }
    material
}
