//! Other people made of an avatar, told as the command line tells them.

use crate::WebError;
use avatar_pack::{IdentityError, Pack};

/// The avatar as the person that a text tells: `seed:7`, or values of axes as `jaw=0.5`, one after the other
/// with spaces or commas between. The empty text is the avatar itself, and `None`.
///
/// # Errors
/// An avatar without axes, an axis that does not exist, a value beyond −1 to 1.
pub(crate) fn person(pack: &Pack, text: &str) -> Result<Option<Pack>, WebError> {
    let words = text.split([' ', ',']).map(str::trim).filter(|word| !word.is_empty());
    let words: Vec<&str> = words.collect();
    if words.is_empty() {
        return Ok(None);
    }
    let identity = pack.identity().ok_or(IdentityError::NoAxes)?;
    let form = |found: &str| WebError::number("identity", "AXIS=VALUE or seed:NUMBER", found);
    let mut values = vec![0.0; identity.axes.len()];
    let mut drawn = None;
    for word in words {
        if let Some(seed) = word.strip_prefix("seed:") {
            let seed = seed.parse().map_err(|_| form(word))?;
            values = identity.draw(seed);
            drawn = Some(seed);
            continue;
        }
        let (name, value) = word.rsplit_once('=').ok_or_else(|| form(word))?;
        let names: Vec<&str> = identity.names().collect();
        let axis = identity.index(name).ok_or_else(|| WebError::word("identity", name, names, ""))?;
        let value = value.parse().ok().filter(|value| (-1.0..=1.0).contains(value));
        let value = value.ok_or_else(|| WebError::number(name, "a number from -1 to 1", word))?;
        if let Some(slot) = values.get_mut(axis) {
            *slot = value;
        }
    }
    let mut person = pack.with_identity(&values)?;
    drawn.into_iter().for_each(|seed| person.draw_colors(seed));
    Ok(Some(person))
}
