//! Tables `wrinkle` of `shapes.toml`.

use super::WrinklePlace;
use avatar_look::Wrinkle;
use placed_toml::{Table, TomlError};

const POINT: &str = "an array of three numbers up to 1e9";
const RADIUS: &str = "a number above 0 and up to 1e9";
const GAIN: &str = "a number from 0 to 10";

/// Reads the place of this number; `is_shape` tells whether there is a shape of this name, and `shapes` lists
/// all.
pub(super) fn read<'n>(
    number: usize,
    mut table: Table<'_, '_>,
    is_shape: impl Fn(&str) -> bool,
    shapes: impl Fn() -> Vec<&'n str>,
) -> Result<WrinklePlace, TomlError> {
    let (center, radius) = (table.require("center", POINT)?, table.require("radius", RADIUS)?);
    if number >= Wrinkle::MOST {
        return Err(center.error(format!("at most {} tables wrinkle", Wrinkle::MOST), "another one"));
    }
    let of = table.require("of", "a table of shapes and how strongly each wrinkles the place")?;
    table.finish(&["center", "radius", "of"])?;
    let point = center.array()?.iter().map(|number| number.number(POINT)).collect::<Result<Vec<_>, _>>()?;
    let point = point.try_into().map_err(|_| center.error_found(POINT))?;
    let reach = Some(radius.number(RADIUS)?).filter(|reach| *reach > 0.0);
    let reach = reach.ok_or_else(|| radius.error_found(RADIUS))?;
    let mut shaped = Vec::new();
    for entry in of.table()?.rest() {
        if !is_shape(entry.name()) {
            return Err(entry.unknown_name(entry.name(), "a shape, of", shapes()));
        }
        shaped.push((entry.name().to_owned(), entry.number_within(0.0..=10.0, GAIN)?));
    }
    Ok(WrinklePlace { center: point, radius: reach, of: shaped })
}
