//! The entries of a file, `[[pose]]` after `[[pose]]`, as a list that can be put in another order.

use toml_edit::{ArrayOfTables, DocumentMut, Item, Table};

/// Takes the entries called `key` out of a document, with the lines before the first one that are about the
/// whole file.
pub(crate) fn take(document: &mut DocumentMut, key: &str) -> (String, Vec<Table>) {
    let entries = match document.remove(key) {
        // An array of inline tables becomes one of tables, which has room for comments.
        Some(item) => item.into_array_of_tables().unwrap_or_default(),
        None => ArrayOfTables::new(),
    };
    let mut entries: Vec<Table> = entries.into_iter().collect();
    let head = match entries.first_mut() {
        None => String::new(),
        Some(first) => {
            let above = above(first);
            // Lines that touch the entry are its own.
            let own = above.rfind("\n\n").map_or(0, |blank| blank + 2);
            let own = if own == 0 && above.starts_with('\n') { 1 } else { own };
            first.decor_mut().set_prefix(&above[own..]);
            above[..own].to_owned()
        }
    };
    (head, entries)
}

/// Puts the entries back in this order, a blank line before each that does not touch the file's head.
pub(crate) fn put(document: &mut DocumentMut, key: &str, head: &str, mut entries: Vec<Table>) {
    let mut position = 0;
    for (index, entry) in entries.iter_mut().enumerate() {
        let own = above(entry);
        let own = own.trim_start_matches(['\n', '\r']);
        let prefix = match index {
            0 => format!("{head}{own}"),
            _ => format!("\n{own}"),
        };
        entry.decor_mut().set_prefix(prefix);
        number(entry, &mut position);
    }
    if entries.is_empty() {
        // Comments about the whole file are kept when the last entry is removed.
        let trailing = format!("{head}{}", document.trailing().as_str().unwrap_or_default());
        document.set_trailing(trailing);
        return;
    }
    document.insert(key, Item::ArrayOfTables(entries.into_iter().collect()));
}

fn above(table: &Table) -> String {
    let prefix = table.decor().prefix().and_then(|prefix| prefix.as_str());
    // Both kinds of line ends count; the writer knows only one.
    prefix.unwrap_or_default().replace("\r\n", "\n")
}

/// Tables are written in the order of their positions: their own, then those within.
fn number(table: &mut Table, position: &mut isize) {
    table.set_position(Some(*position));
    *position += 1;
    let mut within: Vec<&mut Table> = table.iter_mut().filter_map(|(_, item)| item.as_table_mut()).collect();
    within.sort_by_key(|table| table.position().unwrap_or(isize::MAX));
    for table in within {
        number(table, position);
    }
}

/// A text after a change of its entries.
pub(crate) fn edited(text: &str, key: &str, change: impl FnOnce(&mut Vec<Table>)) -> String {
    // A book's text is valid. If it were not, the caller would refuse what comes out of an empty document.
    let mut document: DocumentMut = text.parse().unwrap_or_default();
    let (head, mut entries) = take(&mut document, key);
    change(&mut entries);
    put(&mut document, key, &head, entries);
    document.to_string()
}
