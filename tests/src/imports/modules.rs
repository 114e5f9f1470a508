//! The modules of a crate, and what a path in one of them leads to.

use std::collections::BTreeMap;

use super::scan::{Scanned, scan};

/// The files of a crate's `src`: path below it, with `/`, and text.
pub type Files = BTreeMap<String, String>;

/// A module, in a file of its own or in braces.
#[derive(Debug)]
pub(super) struct Module {
    /// Its file, an index into `Modules::files`.
    pub file: usize,
    pub parent: Option<usize>,
    /// In the order of their `mod` lines.
    pub children: Vec<(String, usize)>,
    pub scanned: Scanned,
}

/// All modules of a crate that a root file leads to.
#[derive(Debug, Default)]
pub struct Modules {
    /// Paths below `src`; the root is the first.
    pub(super) files: Vec<String>,
    /// The root is the first.
    pub(super) modules: Vec<Module>,
}

/// What a path leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Module(usize),
    ItemOf(usize),
}

/// Names can be passed on in circles, by `use`; this many steps are followed.
const MAX_STEPS: usize = 32;

impl Modules {
    /// Reads the modules from a root, `lib.rs` or `main.rs`. A submodule without a file is an error that
    /// names it.
    pub fn read(files: &Files, root: &str) -> Result<Modules, String> {
        let mut modules = Modules::default();
        let folder = root.rsplit_once('/').map_or("", |(folder, _)| folder);
        modules.add_file(files, root, folder, None)?;
        Ok(modules)
    }

    fn add_file(
        &mut self,
        files: &Files,
        path: &str,
        folder: &str,
        parent: Option<usize>,
    ) -> Result<usize, String> {
        let source = files.get(path).ok_or_else(|| format!("{path} is missing"))?;
        self.files.push(path.to_owned());
        self.add(files, self.files.len() - 1, folder, parent, scan(source))
    }

    /// Adds a module whose submodules have their files in `folder`.
    fn add(
        &mut self,
        files: &Files,
        file: usize,
        folder: &str,
        parent: Option<usize>,
        mut scanned: Scanned,
    ) -> Result<usize, String> {
        let (inner, declared) = (std::mem::take(&mut scanned.inner), std::mem::take(&mut scanned.files));
        let number = self.modules.len();
        self.modules.push(Module { file, parent, children: Vec::new(), scanned });
        let below = |name: &str| if folder.is_empty() { name.to_owned() } else { format!("{folder}/{name}") };
        for (name, line) in declared {
            let base = below(&name);
            let path = [format!("{base}.rs"), format!("{base}/mod.rs")]
                .into_iter()
                .find(|path| files.contains_key(path));
            let path = path.ok_or_else(|| format!("{}:{line}: no file for mod {name}", self.files[file]))?;
            let child = self.add_file(files, &path, &base, Some(number))?;
            self.modules[number].children.push((name, child));
        }
        for (name, scanned) in inner {
            let child = self.add(files, file, &below(&name), Some(number), scanned)?;
            self.modules[number].children.push((name, child));
        }
        Ok(number)
    }

    /// The file that a path in a module leads to: that of the item itself, however often it is re-exported on
    /// the way. `None` for other crates, and for names of the module's own text.
    pub(super) fn resolve(&self, module: usize, path: &[String]) -> Option<usize> {
        let (Place::Module(found) | Place::ItemOf(found)) = self.follow(module, path, MAX_STEPS)?;
        Some(self.modules[found].file)
    }

    /// The module that a path names, if it is one.
    pub(super) fn module_at(&self, module: usize, path: &[String]) -> Option<usize> {
        match self.follow(module, path, MAX_STEPS)? {
            Place::Module(found) => Some(found),
            Place::ItemOf(_) => None,
        }
    }

    fn follow(&self, module: usize, path: &[String], steps: usize) -> Option<Place> {
        let steps = steps.checked_sub(1)?;
        let (first, mut rest) = path.split_first()?;
        let mut place = match first.as_str() {
            "crate" => Place::Module(0),
            "self" => Place::Module(module),
            "super" => Place::Module(self.modules[module].parent?),
            name => self.lookup(module, name, steps)?,
        };
        while let (Place::Module(inside), Some((name, more))) = (place, rest.split_first()) {
            place = match name.as_str() {
                "super" => Place::Module(self.modules[inside].parent?),
                // What a macro makes, for example, is found in no text: it belongs to the module that was
                // named.
                name => self.lookup(inside, name, steps).unwrap_or(Place::ItemOf(inside)),
            };
            rest = more;
        }
        Some(place)
    }

    /// A name in a module: a submodule, an item, what a `use` brings.
    fn lookup(&self, module: usize, name: &str, steps: usize) -> Option<Place> {
        let steps = steps.checked_sub(1)?;
        let here = &self.modules[module];
        if let Some((_, child)) = here.children.iter().find(|(child, _)| child == name) {
            return Some(Place::Module(*child));
        }
        if here.scanned.items.iter().any(|item| item == name) {
            return Some(Place::ItemOf(module));
        }
        for used in here.scanned.uses.iter().filter(|used| used.name.as_deref() == Some(name)) {
            // `use glam;` names the other crate, not itself.
            if used.path.len() == 1 && used.path[0] == name {
                continue;
            }
            if let Some(place) = self.follow(module, &used.path, steps) {
                return Some(place);
            }
        }
        here.scanned.uses.iter().filter(|used| used.name.is_none()).find_map(|used| {
            let Place::Module(source) = self.follow(module, &used.path, steps)? else { return None };
            if source == module { None } else { self.lookup(source, name, steps) }
        })
    }

    /// The module whose file this is.
    pub(super) fn module_of_file(&self, file: usize) -> Option<usize> {
        self.modules.iter().position(|module| module.file == file)
    }

    /// A file's modules from the root to its own.
    pub(super) fn ancestry(&self, file: usize) -> Vec<usize> {
        let mut chain: Vec<usize> = Vec::new();
        let mut next = self.module_of_file(file);
        while let Some(module) = next {
            chain.push(module);
            next = self.modules[module].parent;
        }
        chain.reverse();
        chain
    }
}
