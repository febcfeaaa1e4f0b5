//! What is made, and the state that directives change.

use super::area_light::AreaLight;
use super::known::Known;
use super::parameters::Parameters;
use super::report::Report;
use crate::import::naming::{Names, path_between};
use etendue_scene::limits;
use etendue_scene::record::Scene;
use glam::{DAffine3, DMat3};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// The scene as far as it is made.
pub(super) struct Scenery {
    pub(super) scene: Scene,
    pub(super) report: Report,
    pub(super) file_names: Names,
    pub(super) names: Names,
    /// From pbrt's world to ours.
    pub(super) to_ours: DMat3,
    pub(super) known: Known,
    /// The folder of the scene file.
    pub(super) source_folder: PathBuf,
    /// The folder of what is written.
    folder: PathBuf,
    pub(super) files: Vec<(String, Vec<u8>)>,
    bytes: u64,
}

impl Scenery {
    pub(super) fn new(file: &Path, folder: &Path) -> Self {
        Self {
            scene: Scene::default(),
            report: Report::default(),
            file_names: Names::default(),
            names: Names::default(),
            to_ours: DMat3::IDENTITY,
            known: Known::default(),
            source_folder: file.parent().unwrap_or(Path::new("")).to_owned(),
            folder: folder.to_owned(),
            files: Vec::new(),
            bytes: 0,
        }
    }

    /// Adds a file to what is written; its path.
    pub(super) fn add_file(&mut self, name: String, bytes: Vec<u8>) -> String {
        self.bytes += bytes.len() as u64;
        self.files.push((name.clone(), bytes));
        name
    }

    /// Refuses what instances would multiply beyond the limit.
    pub(super) fn check_size(&self) -> Result<(), String> {
        limits::MESH.check_unpacked(self.bytes)
    }

    /// The path, as the written scene names it, of a file that the scene file names.
    pub(super) fn path_of(&self, name: &str) -> String {
        path_between(&self.folder, &self.source_folder.join(name)).to_string_lossy().into_owned()
    }

    /// Notes the parameters that nobody has asked for.
    pub(super) fn note_unused(&mut self, of: &str, parameters: Parameters<'_>) {
        for name in parameters.unused() {
            self.report.note(format!("{of}: \"{name}\" is not used"));
        }
    }
}

/// What a block keeps and gives back at its end.
#[derive(Clone)]
pub(super) struct Graphics {
    /// From the space of what follows to pbrt's world.
    pub(super) to_world: DAffine3,
    pub(super) reverse_orientation: bool,
    pub(super) material: Rc<str>,
    pub(super) area_light: Option<Rc<AreaLight>>,
    pub(super) inside: Rc<str>,
    pub(super) outside: Rc<str>,
}
