//! The format of `materials.toml`.

use super::fields::{FIELDS, own_table};
use super::{KINDS, kind_index};
use crate::{LookError, Material, Materials};
use avatar_mesh::{FACE_PARTS, PartKind};
use placed_toml::{Document, Entry, Field, read_field, read_fields};

pub(crate) fn read(source: &str) -> Result<Materials, LookError> {
    let document = Document::parse(source)?;
    let root = document.root();
    let entries = root.entries();
    // "skin" is a kind and a part at once; as a kind it is read before the parts.
    let parts = FACE_PARTS.iter().map(|part| part.name).filter(|name| kind_named(name).is_none());
    let names: Vec<&str> = KINDS.iter().map(|(name, _)| *name).chain(parts).collect();
    for entry in entries {
        if !names.contains(&entry.name()) {
            return Err(entry.unknown_name(entry.name(), "one of the tables", names));
        }
    }
    let mut materials = Materials::default();
    for entry in entries {
        if let Some((index, kind)) = kind_named(entry.name()) {
            read_table(entry, kind, &mut materials.kinds[index])?;
        }
    }
    for (part, material) in FACE_PARTS.iter().zip(&mut materials.parts) {
        *material = materials.kinds[kind_index(part.kind)];
        let own = |entry: &&Entry<'_, '_>| entry.name() == part.name && kind_named(entry.name()).is_none();
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
    let own = own_table(kind);
    // What else may stand in the table, for the error.
    let others: Vec<&str> = own.iter().map(|(name, _)| *name).collect();
    for entry in entry.table()?.rest() {
        match own {
            Some((name, fields)) if entry.name() == name => read_fields(entry.table()?, fields, material)?,
            _ => read_field(&entry, &FIELDS, &others, material)?,
        }
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
    let mut section = |title: String, fields: &[Field<Material>]| {
        let differs =
            |field: &&Field<Material>| base.is_none_or(|base| field.values(base) != field.values(material));
        let lines: Vec<String> = fields.iter().filter(differs).map(|field| field.line(material)).collect();
        if !lines.is_empty() {
            let gap = if out.is_empty() { "" } else { "\n" };
            *out += &format!("{gap}[{title}]\n{}", lines.concat());
        }
    };
    section(name.to_owned(), &FIELDS);
    if let Some((own, fields)) = own_table(kind) {
        section(format!("{name}.{own}"), fields);
    }
}
