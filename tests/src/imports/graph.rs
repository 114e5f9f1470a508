//! The graph of a crate's files.

use std::collections::BTreeMap;

use super::modules::{Files, Modules};

/// Where and how one file first names another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Import {
    /// The line in the importing file, from 1.
    pub line: usize,
    /// The path as it is written there; `mod x` where a module declares its submodule.
    pub path: String,
}

/// Which file of a crate imports which.
#[derive(Debug)]
pub struct Graph {
    /// The crate's modules.
    pub modules: Modules,
    /// Indices of files (see [`Graph::name`]): importing, imported.
    pub imports: BTreeMap<(usize, usize), Import>,
}

impl Graph {
    /// Reads the files that a root, `lib.rs` or `main.rs`, leads to.
    ///
    /// # Errors
    ///
    /// A submodule that has no file, with the place of its `mod`.
    pub fn read(files: &Files, root: &str) -> Result<Graph, String> {
        let modules = Modules::read(files, root)?;
        let mut imports = BTreeMap::new();
        for (number, module) in modules.modules.iter().enumerate() {
            let from = module.file;
            let mut add = |to: Option<usize>, line: usize, path: String| {
                if let Some(to) = to.filter(|&to| to != from) {
                    imports.entry((from, to)).or_insert(Import { line, path });
                }
            };
            for used in &module.scanned.uses {
                let path = used.path.join("::");
                match &used.name {
                    Some(_) => add(modules.resolve(number, &used.path), used.line, path),
                    None => {
                        let Some(source) = modules.module_at(number, &used.path) else { continue };
                        add(Some(modules.modules[source].file), used.line, format!("{path}::*"));
                        // What it passes on counts where it is named.
                        for (word, line) in &module.scanned.words {
                            let passed_on = modules.resolve(source, std::slice::from_ref(word));
                            add(passed_on, *line, format!("{path}::{word}"));
                        }
                    }
                }
            }
            for path in &module.scanned.paths {
                add(modules.resolve(number, &path.segments), path.line, path.segments.join("::"));
            }
            for (name, child) in &module.children {
                add(Some(modules.modules[*child].file), 0, format!("mod {name}"));
            }
        }
        Ok(Graph { modules, imports })
    }

    /// A file's path below `src`.
    pub fn name(&self, file: usize) -> &str {
        &self.modules.files[file]
    }

    /// The number of files; their indices are below it.
    pub fn file_count(&self) -> usize {
        self.modules.files.len()
    }

    /// The files that a file imports, in order of their indices.
    pub fn imported_by(&self, file: usize) -> impl Iterator<Item = usize> + '_ {
        self.imports.range((file, 0)..(file + 1, 0)).map(|(&(_, to), _)| to)
    }
}
