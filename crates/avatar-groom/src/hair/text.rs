//! The format of `hair.toml`.

use crate::{Hair, RegionStyle, Style};
use placed_toml::{Document, Field, TomlError, read_fields};

/// The keys of the tables of regions.
pub(crate) const FIELDS: &[Field<RegionStyle>] = &[
    Field::one("density", 0.0, 100.0, |style| &mut style.density),
    Field::one("length", 0.0, 3.0, |style| &mut style.length),
    Field::one("length_variation", 0.0, 1.0, |style| &mut style.length_variation),
    Field::one("root_radius", 0.0, 0.1, |style| &mut style.root_radius),
    Field::one("tip_radius", 0.0, 0.1, |style| &mut style.tip_radius),
    Field::three("root_color", 0.0, 1.0, |style| &mut style.root_color),
    Field::three("tip_color", 0.0, 1.0, |style| &mut style.tip_color),
    Field::one("color_variation", 0.0, 1.0, |style| &mut style.color_variation),
    Field::one("bend", 0.0, 10.0, |style| &mut style.bend),
    Field::one("gravity", -10.0, 10.0, |style| &mut style.gravity),
    Field::three("comb", -10.0, 10.0, |style| &mut style.comb),
    Field::three("edge", -10.0, 10.0, |style| &mut style.edge),
    Field::one("tuck", -10.0, 10.0, |style| &mut style.tuck),
    Field::one("hold", 0.0, 1.0, |style| &mut style.hold),
    Field::one("volume", 0.0, 1.0, |style| &mut style.volume),
    Field::one("cut", -10.0, 10.0, |style| &mut style.cut),
    Field::one("parting", -1.0, 1.0, |style| &mut style.parting),
    Field::one("strip", 0.0, 1.0, |style| &mut style.strip),
    Field::one("curl_radius", 0.0, 1.0, |style| &mut style.curl_radius),
    Field::one("curl_turns", 0.0, 100.0, |style| &mut style.curl_turns),
    Field::one("clump", 0.0, 1.0, |style| &mut style.clump),
    Field::one("noise", 0.0, 10.0, |style| &mut style.noise),
    Field::one("swing", 0.0, 60.0, |style| &mut style.swing),
];

type OfRegion = fn(&mut Style) -> &mut RegionStyle;

/// The tables, by region.
const REGIONS: [(&str, OfRegion); 3] = [
    ("scalp", |style| &mut style.scalp),
    ("brows", |style| &mut style.brows),
    ("lashes", |style| &mut style.lashes),
];

const PRESET: &str = "the name of a preset";
const SEED: &str = "a whole number from 0";

pub(crate) fn read(source: &str) -> Result<Hair, TomlError> {
    let mut hair = Hair::default();
    let document = Document::parse(source)?;
    let mut root = document.root();
    if let Some(entry) = root.take("preset") {
        let name = entry.string(PRESET)?;
        let names = || Style::PRESETS.map(|(name, _)| name);
        let unknown = || entry.unknown_value(name, "one of the presets", names());
        hair.style = Style::preset(name).ok_or_else(unknown)?;
    }
    if let Some(entry) = root.take("density") {
        let max = Hair::MAX_DENSITY;
        hair.density = entry.number_within(0.0..=max, &format!("a number from 0 to {max}"))?;
    }
    if let Some(entry) = root.take("seed") {
        hair.seed = entry.natural(SEED)?;
    }
    for (name, region) in REGIONS {
        if let Some(entry) = root.take(name) {
            read_fields(entry.table()?, FIELDS, region(&mut hair.style))?;
        }
    }
    root.finish(&["preset", "density", "seed", "scalp", "brows", "lashes"])?;
    Ok(hair)
}

/// All values of all regions, so that the text does not depend on what presets become.
pub(crate) fn write(hair: &Hair) -> String {
    let mut style = hair.style;
    let mut out = format!("density = {:?}\nseed = {}\n", hair.density, hair.seed);
    for (name, region) in REGIONS {
        out += &format!("\n[{name}]\n");
        out.extend(FIELDS.iter().map(|field| field.line(region(&mut style))));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The names of the fields that Debug prints: all there are.
    fn declared() -> Vec<String> {
        let printed = format!("{:#?}", Style::SHORT.scalp);
        let name = |line: &str| line.strip_prefix("    ")?.split_once(':').map(|(name, _)| name.to_owned());
        printed.lines().filter_map(name).collect()
    }

    #[test]
    fn every_value_of_a_style_is_a_key_and_the_example_tells_of_it() {
        let keys: Vec<_> = FIELDS.iter().map(|field| field.name.to_owned()).collect();
        assert_eq!(keys, declared());
        let document = Document::parse(Hair::EXAMPLE).expect("the example");
        let table = document.root().require("scalp", "a table").expect("it").table().expect("a table");
        let told: Vec<_> = table.entries().iter().map(|entry| entry.name().to_owned()).collect();
        assert_eq!(told, keys);
    }

    #[test]
    fn the_presets_are_in_range() {
        for (name, mut style) in Style::PRESETS {
            for (region, of) in REGIONS {
                for field in FIELDS {
                    let values = field.values(of(&mut style));
                    let inside = values.iter().all(|value| (field.min..=field.max).contains(value));
                    assert!(inside, "{name}, {region}: {} = {values:?}", field.name);
                }
            }
        }
    }
}
