//! The format of `materials.toml`.

use crate::materials::{KINDS, kind_index};
use crate::materials_fields::{FIELDS, Field, IRIS, IRIS_FIELDS, Slot};
use crate::text::{Entry, Text};
use crate::{LookError, Material, Materials};
use avatar_mesh::{FACE_PARTS, PartKind};

pub(crate) fn read(source: &str) -> Result<Materials, LookError> {
    let (text, document) = Text::parse(source)?;
    let entries = text.entries(document.get_ref());
    // "skin" is a kind and a part at once; as a kind it is read before the parts.
    let parts = FACE_PARTS.iter().map(|part| part.name).filter(|name| kind_named(name).is_none());
    let names: Vec<&str> = KINDS.iter().map(|(name, _)| *name).chain(parts).collect();
    for entry in &entries {
        if !names.contains(&entry.name.as_str()) {
            return Err(entry.unknown_name("one of the tables", &names));
        }
    }
    let mut materials = Materials::default();
    for entry in &entries {
        if let Some((index, kind)) = kind_named(&entry.name) {
            read_table(entry, kind, &mut materials.kinds[index])?;
        }
    }
    for (part, material) in FACE_PARTS.iter().zip(&mut materials.parts) {
        *material = materials.kinds[kind_index(part.kind)];
        let own = |entry: &&Entry<'_, '_>| entry.name == part.name && kind_named(&entry.name).is_none();
        if let Some(entry) = entries.iter().find(own) {
            read_table(entry, part.kind, material)?;
        }
    }
    Ok(materials)
}

fn kind_named(name: &str) -> Option<(usize, PartKind)> {
    let index = KINDS.iter().position(|(kind, _)| *kind == name)?;
    Some((index, KINDS[index].1))
}

fn read_table(entry: &Entry<'_, '_>, kind: PartKind, material: &mut Material) -> Result<(), LookError> {
    let has_iris = kind == PartKind::Eyeball;
    for entry in entry.table()? {
        if has_iris && entry.name == IRIS {
            for entry in entry.table()? {
                read_field(&entry, &IRIS_FIELDS, None, material)?;
            }
        } else {
            read_field(&entry, &FIELDS, has_iris.then_some(IRIS), material)?;
        }
    }
    Ok(())
}

/// `other`: what else may stand in the table, for the error.
fn read_field(
    entry: &Entry<'_, '_>,
    fields: &[Field],
    other: Option<&str>,
    material: &mut Material,
) -> Result<(), LookError> {
    let Some(field) = fields.iter().find(|field| field.name == entry.name) else {
        let names: Vec<&str> = fields.iter().map(|field| field.name).chain(other).collect();
        return Err(entry.unknown_name("one of the keys", &names));
    };
    let expected = field.expected();
    let number = |entry: &Entry<'_, '_>| entry.number(field.min, field.max, &expected);
    match field.slot {
        Slot::One(slot) => *slot(material) = number(entry)?,
        Slot::Three(slot) => match &entry.items(&expected)?[..] {
            [r, g, b] => *slot(material) = [number(r)?, number(g)?, number(b)?],
            _ => return Err(entry.error_found(&expected)),
        },
    }
    Ok(())
}

pub(crate) fn write(materials: &Materials) -> String {
    let mut out = String::new();
    for ((name, kind), material) in KINDS.iter().zip(&materials.kinds) {
        write_table(&mut out, name, *kind, material, None);
    }
    for (part, material) in FACE_PARTS.iter().zip(&materials.parts) {
        let kind = &materials.kinds[kind_index(part.kind)];
        write_table(&mut out, part.name, part.kind, material, Some(kind));
    }
    out
}

/// All values, or those that are not as in `base`.
fn write_table(out: &mut String, name: &str, kind: PartKind, material: &Material, base: Option<&Material>) {
    let mut section = |title: String, fields: &[Field]| {
        let differs = |field: &&Field| base.is_none_or(|base| field.values(base) != field.values(material));
        let lines: Vec<String> = fields.iter().filter(differs).map(|field| line(field, material)).collect();
        if !lines.is_empty() {
            let gap = if out.is_empty() { "" } else { "\n" };
            *out += &format!("{gap}[{title}]\n{}", lines.concat());
        }
    };
    section(name.to_owned(), &FIELDS);
    if kind == PartKind::Eyeball {
        section(format!("{name}.{IRIS}"), &IRIS_FIELDS);
    }
}

fn line(field: &Field, material: &Material) -> String {
    // Debug keeps the point of whole numbers and all digits that matter.
    match (field.slot, &field.values(material)[..]) {
        (Slot::One(_), [value]) => format!("{} = {value:?}\n", field.name),
        (_, values) => format!("{} = {values:?}\n", field.name),
    }
}
