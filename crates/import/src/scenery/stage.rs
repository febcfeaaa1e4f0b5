//! State of an import: graphics state of a shape, named definitions, and the conversion report.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use etendue_io::Sandbox;
use etendue_io::named_file::{NamedFile, find_named_file};
use etendue_scene::limits;
use etendue_scene::record::material::{Factor, Sides};
use etendue_scene::record::{Curve, Emission, Level, LightColour, Scene, SurfaceEmission};
use glam::{DAffine3, DMat3};

use super::infinite_light::InfiniteLight;
use super::projection::TextureBase;
use super::texture::{PlacedTexture, TextureTree};
use crate::naming::{UniqueNames, path_between};

/// Placeholder for the material of a surface that only separates two media.
pub(crate) const INTERFACE: &str = "interface/";

/// Homogeneous medium.
#[derive(Clone)]
pub(crate) struct Homogeneous {
    pub(crate) extinction: Curve,
    pub(crate) albedo: Curve,
    pub(crate) g: f64,
}

/// Named definitions.
#[derive(Default)]
pub(crate) struct SceneDefinitions {
    /// Textures of pbrt; those of colours (true) and those of numbers are separate.
    pub(crate) textures: HashMap<(bool, String), Rc<TextureTree>>,
    /// Our textures for those of pbrt, by the tree's address and its use; the tree keeps the address.
    pub(crate) pictures: HashMap<(usize, &'static str), (Rc<TextureTree>, PlacedTexture)>,
    /// Our names of the file's materials; the empty name is the grey one.
    pub(crate) materials: HashMap<String, Rc<str>>,
    /// Sources of the texture coordinates that place the images of our materials, by their names.
    pub(crate) texture_bases: HashMap<Rc<str>, TextureBase>,
    /// Sources of the texture coordinates of the images placed so far, by materials and opacities.
    pub(crate) placed_images: Vec<TextureBase>,
    /// Names of partly transparent copies, by the original and the opacity.
    pub(crate) translucent_copies: HashMap<String, Rc<str>>,
    /// Environment lights of pbrt, which are joined at the end.
    pub(crate) infinite_lights: Vec<InfiniteLight>,
    /// Supported media.
    pub(crate) media: HashMap<String, Homogeneous>,
}

/// Light of the shapes that follow.
#[derive(Clone, Debug)]
pub(crate) struct AreaLight {
    pub(crate) colour: LightColour,
    /// Luminance, cd/m², of shapes without a flux.
    pub(crate) luminance: f64,
    /// Flux of each pbrt shape, a triangle or a sphere, lm.
    pub(crate) flux: Option<f64>,
    pub(crate) two_sided: bool,
}

impl AreaLight {
    /// Emission of an object of `count` pbrt shapes.
    pub(crate) fn emission(&self, count: usize) -> SurfaceEmission {
        let level = match self.flux {
            Some(lm) => Level::LuminousFlux((lm * count as f64).into()),
            None => Level::Luminance(self.luminance.into()),
        };
        let light = Emission { colour: Some(self.colour.clone()), ..Emission::new(level) };
        SurfaceEmission { sides: self.two_sided.then(|| Sides::Both.into()), ..SurfaceEmission::new(light) }
    }

    /// Returns true if each pbrt shape has a flux.
    pub(crate) fn has_flux(&self) -> bool {
        self.flux.is_some()
    }
}

/// Maximum objects of a scene, counting each instance: as text they have about 100 MB.
const MAX_OBJECTS: usize = 1_000_000;

/// Scene under construction.
pub(crate) struct SceneBuilder {
    pub(crate) scene: Scene,
    pub(crate) report: ImportReport,
    pub(crate) file_names: UniqueNames,
    pub(crate) names: UniqueNames,
    /// Rotation from the file's world to ours.
    pub(crate) to_ours: DMat3,
    pub(crate) known: SceneDefinitions,
    /// Folder of the scene file.
    pub(crate) source_folder: PathBuf,
    /// Folder of the written files.
    folder: PathBuf,
    pub(crate) files: Vec<(String, Vec<u8>)>,
    bytes: u64,
}

impl Graphics {
    /// Default graphics state.
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
            texture_base: None,
        }
    }
}

impl SceneBuilder {
    pub(crate) fn new(file: &Path, folder: &Path) -> Self {
        Self {
            scene: Scene::default(),
            report: ImportReport::default(),
            file_names: UniqueNames::default(),
            names: UniqueNames::default(),
            to_ours: DMat3::IDENTITY,
            known: SceneDefinitions::default(),
            source_folder: file.parent().unwrap_or(Path::new("")).to_owned(),
            folder: folder.to_owned(),
            files: Vec::new(),
            bytes: 0,
        }
    }

    /// Adds a file to the written ones; returns its path.
    pub(crate) fn add_file(&mut self, name: String, bytes: Vec<u8>) -> String {
        self.bytes += bytes.len() as u64;
        self.files.push((name.clone(), bytes));
        name
    }

    /// Refuses instances that exceed the limit.
    pub(crate) fn check_size(&self) -> Result<(), String> {
        if self.scene.objects.len() > MAX_OBJECTS {
            return Err(format!(
                "the scene has more than {MAX_OBJECTS} objects, counting each instance; use fewer instances"
            ));
        }
        limits::MESH.check_unpacked(self.bytes).map_err(|problem| problem.words)
    }

    /// Path of a file that the scene names. A path of another machine is searched for beside the scene file, with a note. A missing file has the path that the
    /// scene states.
    pub(crate) fn find_file(&mut self, name: &str) -> PathBuf {
        match find_named_file(&[&self.source_folder], name, &Sandbox::NONE) {
            Ok(NamedFile { path, note, .. }) => {
                note.into_iter().for_each(|note| self.report.note(note));
                path
            }
            Err(_) => self.source_folder.join(name),
        }
    }

    /// Path of a file as in the written scene.
    pub(crate) fn relative_path(&self, file: &Path) -> String {
        path_between(&self.folder, file).to_string_lossy().into_owned()
    }

    /// Notes the unused parameters.
    pub(crate) fn note_unused<'a>(&mut self, subject: &str, unused: impl Iterator<Item = &'a str>) {
        for name in unused {
            self.report.note(format!("{subject}: \"{name}\" is not used"));
        }
    }
}

/// Graphics state of a shape.
#[derive(Clone)]
pub(crate) struct Graphics {
    /// Name of the shape; empty: named by its kind.
    pub(crate) name: Rc<str>,
    /// Transform from the current space to the file's world.
    pub(crate) to_world: DAffine3,
    pub(crate) reverse_orientation: bool,
    pub(crate) material: Rc<str>,
    pub(crate) area_light: Option<Rc<AreaLight>>,
    pub(crate) inside: Rc<str>,
    pub(crate) outside: Rc<str>,
    /// Opacity of the surface; `None` if opaque.
    pub(crate) opacity: Option<Factor>,
    /// Source of the texture coordinates that place its images; `None` without images, and for readers whose shapes have their own.
    pub(crate) texture_base: Option<TextureBase>,
}

/// Notes, in the order of occurrence.
#[derive(Debug, Default)]
pub(crate) struct ImportReport {
    order: Vec<String>,
    counts: HashMap<String, (usize, String)>,
    /// File and line in progress.
    place: String,
}

impl ImportReport {
    /// Sets the place of the notes that follow.
    pub(crate) fn at(&mut self, place: String) {
        self.place = place;
    }

    pub(crate) fn note(&mut self, sentence: impl Into<String>) {
        let (sentence, place) = (sentence.into(), &self.place);
        match self.counts.get_mut(&sentence) {
            Some((count, _)) => *count += 1,
            None => {
                self.order.push(sentence.clone());
                self.counts.insert(sentence, (1, place.clone()));
            }
        }
    }

    pub(crate) fn lines(&self) -> Vec<String> {
        let line = |sentence: &String| {
            let (count, place) = &self.counts[sentence];
            match (count, place.as_str()) {
                (_, "") => sentence.clone(),
                (1, place) => format!("{sentence} ({place})"),
                (count, place) => format!("{sentence} ({count} times, first {place})"),
            }
        };
        self.order.iter().map(line).collect()
    }
}
