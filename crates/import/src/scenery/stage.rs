//! What an import makes: the state that holds for a shape, what names stand for, and what became of what.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use etendue_scene::limits;
use etendue_scene::record::material::{Factor, Sides};
use etendue_scene::record::{Curve, Emission, Level, LightColour, Scene, SurfaceEmission};
use glam::{DAffine3, DMat3};

use crate::naming::{Names, path_between};

/// What stands in the place of a material's name where a surface only parts two media.
pub(crate) const INTERFACE: &str = "interface/";

/// What a texture became.
#[derive(Clone)]
pub(crate) enum KnownTexture {
    /// The same everywhere.
    Even([f64; 3]),
    /// A texture of ours, times a number.
    Picture {
        name: String,
        scale: f64,
        /// Whether its number is its opacity, as of pbrt's pictures with one.
        has_alpha: bool,
    },
}

/// A homogeneous medium.
#[derive(Clone)]
pub(crate) struct Homogeneous {
    pub(crate) extinction: Curve,
    pub(crate) albedo: Curve,
    pub(crate) g: f64,
}

/// Names and what they stand for.
#[derive(Default)]
pub(crate) struct Known {
    /// Textures, those of colours (true) and those of numbers apart.
    pub(crate) textures: HashMap<(bool, String), KnownTexture>,
    /// Names of ours of the file's materials; the empty name is that of the grey one.
    pub(crate) materials: HashMap<String, Rc<str>>,
    /// Names of ours of the materials that lay a picture by texture coordinates.
    pub(crate) pictured: HashSet<Rc<str>>,
    /// How often a material has laid a picture so far.
    pub(crate) pictures_laid: usize,
    /// Names of copies of which only a share is there, by what they are copies of and the share.
    pub(crate) thinned: HashMap<String, Rc<str>>,
    /// Media that are understood.
    pub(crate) media: HashMap<String, Homogeneous>,
}

/// The light of the shapes that follow.
#[derive(Clone, Debug)]
pub(crate) struct AreaLight {
    pub(crate) colour: LightColour,
    /// cd/m², of shapes without a flux.
    pub(crate) luminance: f64,
    /// Flux of each of pbrt's shapes, a triangle or a sphere, lm.
    pub(crate) flux: Option<f64>,
    pub(crate) two_sided: bool,
}

impl AreaLight {
    /// The emission of an object that is `count` of pbrt's shapes.
    pub(crate) fn emission(&self, count: usize) -> SurfaceEmission {
        let level = match self.flux {
            Some(lm) => Level::LuminousFlux((lm * count as f64).into()),
            None => Level::Luminance(self.luminance.into()),
        };
        let light = Emission { colour: Some(self.colour.clone()), ..Emission::new(level) };
        SurfaceEmission { sides: self.two_sided.then(|| Sides::Both.into()), ..SurfaceEmission::new(light) }
    }

    /// Whether it gives each of pbrt's shapes a flux.
    pub(crate) fn has_flux(&self) -> bool {
        self.flux.is_some()
    }
}

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

/// Sentences in the order in which they came.
#[derive(Debug, Default)]
pub(crate) struct Report {
    order: Vec<String>,
    counts: HashMap<String, (usize, String)>,
    /// The file and line that is being read.
    place: String,
}

impl Report {
    /// What follows stands here.
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
