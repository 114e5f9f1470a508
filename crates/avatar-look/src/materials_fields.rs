//! What a `materials.toml` may hold, stated once for the reader and the writer.

use crate::Material;

/// One key of a table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    pub(crate) name: &'static str,
    pub(crate) slot: Slot,
    pub(crate) min: f32,
    pub(crate) max: f32,
}

/// Where its value belongs.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Slot {
    One(fn(&mut Material) -> &mut f32),
    Three(fn(&mut Material) -> &mut [f32; 3]),
}

impl Field {
    /// What would be right there.
    pub(crate) fn expected(&self) -> String {
        let what = match self.slot {
            Slot::One(_) => "a number",
            Slot::Three(_) => "an array of three numbers",
        };
        format!("{what} from {} to {}", self.min, self.max)
    }

    /// Its numbers in this material: one or three.
    pub(crate) fn values(&self, material: &Material) -> Vec<f32> {
        let mut copy = *material;
        match self.slot {
            Slot::One(slot) => vec![*slot(&mut copy)],
            Slot::Three(slot) => slot(&mut copy).to_vec(),
        }
    }
}

const fn one(name: &'static str, max: f32, slot: fn(&mut Material) -> &mut f32) -> Field {
    Field { name, slot: Slot::One(slot), min: 0.0, max }
}

const fn three(name: &'static str, slot: fn(&mut Material) -> &mut [f32; 3]) -> Field {
    Field { name, slot: Slot::Three(slot), min: 0.0, max: 1.0 }
}

/// The keys of all tables, in the order in which they are written.
pub(crate) const FIELDS: [Field; 17] = [
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
    one("wetness", 1.0, |m| &mut m.wetness),
    one("film_roughness", 1.0, |m| &mut m.film_roughness),
    one("back_light", 1.0, |m| &mut m.back_light),
];

/// The table of [`IRIS_FIELDS`]; eyeballs only.
pub(crate) const IRIS: &str = "iris";

/// The keys of an `iris` table.
pub(crate) const IRIS_FIELDS: [Field; 7] = [
    Field { min: 1.0, ..one("refractive_index", 3.0, |m| &mut m.iris.refractive_index) },
    one("depth", 1.0, |m| &mut m.iris.depth),
    one("pupil", 1.0, |m| &mut m.iris.pupil),
    one("painted_pupil", 1.0, |m| &mut m.iris.painted_pupil),
    one("radius", 1.0, |m| &mut m.iris.radius),
    one("limbal_width", 1.0, |m| &mut m.iris.limbal_width),
    one("limbal_darkness", 1.0, |m| &mut m.iris.limbal_darkness),
];
