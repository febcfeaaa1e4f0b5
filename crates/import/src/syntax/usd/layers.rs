//! Layers and packages requested by `openusd`: read within limits, and checked before they are parsed.

use std::cell::{Cell, RefCell};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::{io, rc::Rc};

use etendue_io::{Error, Sandbox, source::read_bytes};
use etendue_scene::limits;
use openusd::ar::{
    Asset, DefaultResolver, ResolvedPath, Resolver, is_package_relative_path, split_package_relative_path_outer,
};
use openusd::usdc::CrateData;

use super::package::{Package, packed};
use super::tree::{Arcs, UsdFile};
use super::{crate_bounds::check_crate, text_bounds::check_text};

/// Magic bytes of a crate.
const CRATE: &[u8] = b"PXR-USDC";

/// Files of a scene.
#[derive(Clone)]
pub(super) struct Layers(Rc<SharedLayers>);

struct SharedLayers {
    paths: DefaultResolver,
    sandbox: Sandbox,
    packages: RefCell<HashMap<PathBuf, Rc<Package>>>,
    /// Checked layers, by name.
    read_layers: RefCell<HashSet<String>>,
    bytes: Cell<u64>,
    arcs: RefCell<Arcs>,
    /// First refused file: `openusd` continues without it.
    error: RefCell<Option<Error>>,
}

impl Layers {
    pub(super) fn new(sandbox: &Sandbox) -> Self {
        Self(Rc::new(SharedLayers {
            paths: DefaultResolver::new(),
            sandbox: sandbox.clone(),
            packages: RefCell::default(),
            read_layers: RefCell::default(),
            bytes: Cell::new(0),
            arcs: RefCell::default(),
            error: RefCell::default(),
        }))
    }

    /// First refused file.
    pub(super) fn first_error(&self) -> Option<Error> {
        self.0.error.borrow().clone()
    }

    /// Location of a file that a value names, from its resolved path.
    pub(super) fn file(&self, resolved: &str) -> Option<UsdFile> {
        if !is_package_relative_path(resolved) {
            return Some(UsdFile::Plain(PathBuf::from(resolved)));
        }
        let (package, name) = split_package_relative_path_outer(resolved)?;
        let package = self.package(Path::new(&package)).ok()?;
        packed(&package, &name).map(|bytes| UsdFile::Packed(name, bytes))
    }

    fn read(&self, file: &Path) -> Result<Vec<u8>, Error> {
        self.0.sandbox.check(file).map_err(|problem| Error::new(file, problem))?;
        read_bytes(file, "USD")
    }

    fn package(&self, file: &Path) -> Result<Rc<Package>, Error> {
        if let Some(known) = self.0.packages.borrow().get(file) {
            return Ok(known.clone());
        }
        let package = Package::new(self.read(file)?).map_err(|problem| Error::new(file, problem))?;
        if package.layers().next().is_none() {
            return Err(Error::new(file, format!("the package has no layer; it contains {}", package.shown())));
        }
        let package = Rc::new(package);
        self.0.packages.borrow_mut().insert(file.to_owned(), package.clone());
        Ok(package)
    }

    /// Checked bytes of a layer or package.
    fn opened(&self, resolved: &str) -> Result<Vec<u8>, Error> {
        let (file, bytes) = match split_package_relative_path_outer(resolved) {
            Some((package, name)) if is_package_relative_path(resolved) => {
                let file = PathBuf::from(package);
                let content = self.package(&file)?.file(&name).map(<[u8]>::to_vec);
                let content =
                    content.ok_or_else(|| Error::new(&file, format!("the package has no file \"{name}\"")))?;
                (file, content)
            }
            _ if Path::new(resolved).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("usdz")) => {
                return Ok(self.package(Path::new(resolved))?.layers_only());
            }
            _ => (PathBuf::from(resolved), self.read(Path::new(resolved))?),
        };
        if self.0.read_layers.borrow().contains(resolved) {
            return Ok(bytes);
        }
        self.0.bytes.set(self.0.bytes.get() + bytes.len() as u64);
        limits::MESH.check_unpacked(self.0.bytes.get()).map_err(|problem| Error::new(&file, problem))?;
        let checked = if bytes.starts_with(CRATE) { check_crate(&bytes) } else { check_text(&bytes) };
        let checked = checked.and_then(|()| self.check_arcs(&bytes));
        checked.map_err(|problem| Error::new(&file, format!("damaged, or not a supported scene: {problem}")))?;
        self.0.read_layers.borrow_mut().insert(resolved.to_owned());
        Ok(bytes)
    }
}

impl Layers {
    /// Parses a layer with classes separately, to find circles; the composer reports one that cannot be parsed.
    fn check_arcs(&self, bytes: &[u8]) -> Result<(), String> {
        let is_crate = bytes.starts_with(CRATE);
        let has = |word: &[u8]| bytes.windows(word.len()).any(|window| window == word);
        // Names of a crate's fields are compressed.
        if !is_crate && !has(b"inherit") && !has(b"specializes") {
            return Ok(());
        }
        let mut arcs = self.0.arcs.borrow_mut();
        if is_crate {
            return CrateData::open(io::Cursor::new(bytes), true).map_or(Ok(()), |layer| arcs.add(&layer));
        }
        let Ok(text) = std::str::from_utf8(bytes) else { return Ok(()) };
        openusd::usda::parse(text).map_or(Ok(()), |layer| arcs.add(&layer))
    }
}

impl Resolver for Layers {
    fn create_identifier(&self, asset_path: &str, anchor: Option<&ResolvedPath>) -> String {
        self.0.paths.create_identifier(asset_path, anchor)
    }

    fn resolve(&self, asset_path: &str) -> Option<ResolvedPath> {
        let (file, within) = match split_package_relative_path_outer(asset_path) {
            Some((package, name)) if is_package_relative_path(asset_path) => (PathBuf::from(package), Some(name)),
            _ => (PathBuf::from(asset_path), None),
        };
        self.0.sandbox.check(&file).ok()?;
        if !file.is_absolute() || !file.is_file() {
            return None;
        }
        if let Some(name) = within {
            self.package(&file).ok()?.file(&name)?;
        }
        Some(ResolvedPath::new(asset_path))
    }

    fn resolve_for_new_asset(&self, _asset_path: &str) -> Option<ResolvedPath> {
        None
    }

    fn open_asset(&self, resolved_path: &ResolvedPath) -> io::Result<Box<dyn Asset>> {
        let resolved = resolved_path.to_string_lossy();
        match self.opened(&resolved) {
            Ok(bytes) => Ok(Box::new(io::Cursor::new(bytes))),
            Err(error) => {
                let io_error = io::Error::other(error.to_string());
                self.0.error.borrow_mut().get_or_insert(error);
                Err(io_error)
            }
        }
    }
}
