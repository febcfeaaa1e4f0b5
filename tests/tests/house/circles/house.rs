//! The files of one crate as modules, and the arrows between them.

use std::collections::{BTreeMap, BTreeSet};

use super::source::{Import, Source};

/// A module's path from the root of its crate; the root itself is empty.
type Module = Vec<String>;

/// The names that one file takes from each other one.
pub(crate) type ImportedNames = BTreeMap<String, BTreeMap<String, BTreeSet<String>>>;

/// One crate.
pub(crate) struct House {
    files: BTreeMap<Module, String>,
    sources: BTreeMap<Module, Source>,
}

/// Where a path leads.
enum PathEnd {
    /// To an item that this module's file defines.
    Item(Module),
    Module(Module),
    /// Out of the crate, or to a name that only the compiler knows.
    Elsewhere,
}

impl House {
    /// From the files under a crate's `src/` (paths from there, with their text); what only tests compile is left out.
    pub(crate) fn new(folder: &str, texts: &[(String, String)]) -> Self {
        let mut house = Self { files: BTreeMap::new(), sources: BTreeMap::new() };
        for (path, text) in texts {
            let module = module_of(path);
            house.files.insert(module.clone(), format!("{folder}{path}"));
            house.sources.insert(module, Source::read(text));
        }
        let is_test = |module: &Module| {
            (1..=module.len()).any(|n| {
                let parent = house.sources.get(&module[..n - 1]);
                parent.is_some_and(|parent| parent.tests.contains(&module[n - 1]))
            })
        };
        let tests: Vec<Module> = house.files.keys().filter(|module| is_test(module)).cloned().collect();
        for module in tests {
            house.files.remove(&module);
            house.sources.remove(&module);
        }
        house
    }

    /// Who takes which names from whom.
    pub(crate) fn arrows(&self) -> ImportedNames {
        let mut arrows = ImportedNames::new();
        for (module, source) in &self.sources {
            for (end, name) in self.imported_names(module, source) {
                if end != *module {
                    let to = arrows.entry(self.files[module].clone()).or_default();
                    to.entry(self.files[&end].clone()).or_default().insert(name);
                }
            }
        }
        arrows
    }

    /// Each module whose file a file depends on, with the name that it takes.
    fn imported_names(&self, module: &Module, source: &Source) -> Vec<(Module, String)> {
        let imports = source.imports.iter().flat_map(|import| self.imported(module, source, import));
        let paths = source.paths.iter().filter_map(|path| match self.follow(module, path, &mut Vec::new()) {
            PathEnd::Item(end) => Some((end, path.last().cloned().unwrap_or_default())),
            _ => None,
        });
        imports.chain(paths).collect()
    }

    fn imported(&self, module: &Module, source: &Source, import: &Import) -> Vec<(Module, String)> {
        let item = |name: &String, path: &[String]| match self.follow(module, path, &mut Vec::new()) {
            PathEnd::Item(end) => Some((end, name.clone())),
            _ => None,
        };
        match &import.name {
            Some(name) if import.re_exported && !source.words.contains(name) => Vec::new(),
            Some(name) => item(name, &import.path).into_iter().collect(),
            None => {
                let each = |word: &String| item(word, &[import.path.clone(), vec![word.clone()]].concat());
                let PathEnd::Module(from) = self.follow(module, &import.path, &mut Vec::new()) else {
                    return Vec::new();
                };
                source.words.iter().filter(|word| self.binds(&from, word)).filter_map(each).collect()
            }
        }
    }

    /// Whether a module's file gives a name a meaning.
    fn binds(&self, module: &Module, name: &str) -> bool {
        let source = &self.sources[module];
        source.defines.contains(name) || source.imports.iter().any(|i| i.name.as_deref() == Some(name))
    }

    /// Follows a path that a module's file says to the file that defines its end, through what others hand on.
    fn follow(&self, from: &Module, path: &[String], visited: &mut Vec<(Module, Vec<String>)>) -> PathEnd {
        let step = (from.clone(), path.to_vec());
        if visited.contains(&step) {
            return PathEnd::Elsewhere;
        }
        visited.push(step);
        let mut module = from.clone();
        let mut rest = path;
        while let [first, after @ ..] = rest {
            match first.as_str() {
                "crate" => module.clear(),
                "super" => drop(module.pop()),
                "self" => {}
                _ => break,
            }
            rest = after;
        }
        let named = rest.len() < path.len();
        while let [first, after @ ..] = rest {
            let child = [module.as_slice(), std::slice::from_ref(first)].concat();
            if !self.files.contains_key(&child) {
                return self.item(&module, rest, named || module != *from, visited);
            }
            (module, rest) = (child, after);
        }
        PathEnd::Module(module)
    }

    /// What a name means in a module: an item of its file, or what an import of it binds. Behind a path that names the module it is
    /// the file's in any case (a macro may define it).
    fn item(&self, module: &Module, rest: &[String], named: bool, visited: &mut Vec<(Module, Vec<String>)>) -> PathEnd {
        let Some(source) = self.sources.get(module) else { return PathEnd::Elsewhere };
        if source.defines.contains(&rest[0]) {
            return PathEnd::Item(module.clone());
        }
        for import in &source.imports {
            let path = match &import.name {
                Some(name) if *name == rest[0] => [&import.path, &rest[1..]].concat(),
                None if !import.path.is_empty() => [&import.path, rest].concat(),
                _ => continue,
            };
            let glob = import.name.is_none();
            if glob && !self.glob_binds(module, &import.path, &rest[0], visited) {
                continue;
            }
            return self.follow(module, &path, visited);
        }
        if named { PathEnd::Item(module.clone()) } else { PathEnd::Elsewhere }
    }

    fn glob_binds(
        &self,
        module: &Module,
        path: &[String],
        name: &str,
        visited: &mut Vec<(Module, Vec<String>)>,
    ) -> bool {
        matches!(self.follow(module, path, visited), PathEnd::Module(from) if self.binds(&from, name))
    }
}

/// The module that a file under `src/` is.
fn module_of(path: &str) -> Module {
    let mut names: Module = path.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    let is_root = names.len() == 1 && ["lib", "main"].contains(&names[0].as_str());
    if is_root || names.last().is_some_and(|last| last == "mod") {
        names.pop();
    }
    names
}
