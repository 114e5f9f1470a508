use crate::{Entry, Table, TomlError};

/// A key whose value is a number, or three, of a `T`: stated once for the reader and the writer.
#[derive(Clone, Copy, Debug)]
pub struct Field<T> {
    /// The key.
    pub name: &'static str,
    /// Where its value belongs.
    pub slot: Slot<T>,
    /// Least number, included.
    pub min: f32,
    /// Largest number, included.
    pub max: f32,
}

/// Where the value of a [`Field`] belongs.
#[derive(Clone, Copy, Debug)]
pub enum Slot<T> {
    /// A number.
    One(fn(&mut T) -> &mut f32),
    /// Three numbers, such as a colour.
    Three(fn(&mut T) -> &mut [f32; 3]),
}

impl<T> Field<T> {
    /// A key of one number.
    pub const fn one(name: &'static str, min: f32, max: f32, slot: fn(&mut T) -> &mut f32) -> Self {
        Self { name, slot: Slot::One(slot), min, max }
    }

    /// A key of three numbers.
    pub const fn three(name: &'static str, min: f32, max: f32, slot: fn(&mut T) -> &mut [f32; 3]) -> Self {
        Self { name, slot: Slot::Three(slot), min, max }
    }

    /// What would be right there, for errors.
    pub fn expected(&self) -> String {
        let what = match self.slot {
            Slot::One(_) => "a number",
            Slot::Three(_) => "an array of three numbers",
        };
        format!("{what} from {} to {}", self.min, self.max)
    }

    /// Its numbers in a `T`: one or three.
    pub fn values(&self, of: &T) -> Vec<f32>
    where
        T: Clone,
    {
        let mut copy = of.clone();
        match self.slot {
            Slot::One(slot) => vec![*slot(&mut copy)],
            Slot::Three(slot) => slot(&mut copy).to_vec(),
        }
    }

    /// Its line in a TOML text, with all digits that matter.
    pub fn line(&self, of: &T) -> String
    where
        T: Clone,
    {
        // Debug keeps the point of whole numbers.
        match (&self.slot, &self.values(of)[..]) {
            (Slot::One(_), [value]) => format!("{} = {value:?}\n", self.name),
            (_, values) => format!("{} = {values:?}\n", self.name),
        }
    }

    fn read(&self, entry: &Entry<'_, '_>, into: &mut T) -> Result<(), TomlError> {
        let expected = self.expected();
        let number = |entry: &Entry<'_, '_>| entry.number_within(self.min..=self.max, &expected);
        match self.slot {
            Slot::One(slot) => *slot(into) = number(entry)?,
            Slot::Three(slot) => match entry.as_array().as_deref() {
                Some([r, g, b]) => *slot(into) = [number(r)?, number(g)?, number(b)?],
                _ => return Err(entry.error_found(&expected)),
            },
        }
        Ok(())
    }
}

/// Reads one entry as one of the fields. `others` are keys that may stand beside them, for the error.
///
/// # Errors
/// A key that is not a field, a value of another type or out of range.
pub fn read_field<T>(
    entry: &Entry<'_, '_>,
    fields: &[Field<T>],
    others: &[&str],
    into: &mut T,
) -> Result<(), TomlError> {
    match fields.iter().find(|field| field.name == entry.name()) {
        Some(field) => field.read(entry, into),
        None => {
            let names = fields.iter().map(|field| field.name).chain(others.iter().copied());
            Err(entry.unknown_name(entry.name(), "one of the keys", names))
        }
    }
}

/// Reads a table that has nothing but fields.
///
/// # Errors
/// As [`read_field`], of the first entry that is wrong.
pub fn read_fields<T>(table: Table<'_, '_>, fields: &[Field<T>], into: &mut T) -> Result<(), TomlError> {
    table.rest().try_for_each(|entry| read_field(&entry, fields, &[], into))
}
