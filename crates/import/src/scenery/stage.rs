//! What is made, and the state that holds for a shape.

use super::area_light::AreaLight;
use super::known::Known;
use super::report::Report;
use crate::naming::{Names, path_between};
use etendue_scene::limits;
use etendue_scene::record::Scene;
use etendue_scene::record::material::Factor;
use glam::{DAffine3, DMat3};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Objects of a scene, instances counted each: as text they have about 100 MB.
const MAX_OBJECTS: usize = 1_000_000;

/// The scene as far as it is made.
pub(crate) struct Scenery {
    pub(crate) scene: Scene,
    pub(crate) report: Report,
    pub(crate) file_names: Names,
    pub(crate) names: Names,
    /// From the file's world to ours.
    pub(crate) to_ours: DMat3,
    pub(crate) known: Known,
    /// The folder of the scene file.
    pub(crate) source_folder: PathBuf,
    /// The folder of what is written.
    folder: PathBuf,
    pub(crate) files: Vec<(String, Vec<u8>)>,
    bytes: u64,
}

impl Graphics {
    /// What holds where nothing is said.
    pub(crate) fn plain() -> Self {
        let none: Rc<str> = Rc::from("");
        Self {
            name: none.clone(),
            to_world: DAffine3::IDENTITY,
            reverse_orientation: false,
            material: none.clone(),
            area_light: None,
            inside: none.clone(),
            outside: none,
            opacity: None,
        }
    }
}

impl Scenery {
    pub(crate) fn new(file: &Path, folder: &Path) -> Self {
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
    pub(crate) fn add_file(&mut self, name: String, bytes: Vec<u8>) -> String {
        self.bytes += bytes.len() as u64;
        self.files.push((name.clone(), bytes));
        name
    }

    /// Refuses what instances would multiply beyond the limit.
    pub(crate) fn check_size(&self) -> Result<(), String> {
        if self.scene.objects.len() > MAX_OBJECTS {
            return Err(format!("the scene has more than {MAX_OBJECTS} objects with all instances; instance less"));
        }
        limits::MESH.check_unpacked(self.bytes).map_err(|problem| problem.words)
    }

    /// The path, as the written scene names it, of a file that the scene file names.
    pub(crate) fn path_of(&self, name: &str) -> String {
        self.way_to(&self.source_folder.join(name))
    }

    /// The path of a file as the written scene names it.
    pub(crate) fn way_to(&self, file: &Path) -> String {
        path_between(&self.folder, file).to_string_lossy().into_owned()
    }

    /// Notes the parameters that nobody has asked for.
    pub(crate) fn note_unused<'a>(&mut self, of: &str, unused: impl Iterator<Item = &'a str>) {
        for name in unused {
            self.report.note(format!("{of}: \"{name}\" is not used"));
        }
    }
}

/// What holds for a shape.
#[derive(Clone)]
pub(crate) struct Graphics {
    /// What the shape is called; empty: by its kind.
    pub(crate) name: Rc<str>,
    /// From the space of what follows to the file's world.
    pub(crate) to_world: DAffine3,
    pub(crate) reverse_orientation: bool,
    pub(crate) material: Rc<str>,
    pub(crate) area_light: Option<Rc<AreaLight>>,
    pub(crate) inside: Rc<str>,
    pub(crate) outside: Rc<str>,
    /// Share of the surface that is there; `None` for all.
    pub(crate) opacity: Option<Factor>,
}
