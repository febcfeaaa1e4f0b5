//! Conversion of elements to a scene.

use std::path::{Path, PathBuf};
use std::{collections::HashMap, rc::Rc};

use etendue_io::named_file::find_named_file;
use etendue_io::{Error, Sandbox};
use etendue_scene::record::Transform;
use etendue_scene::record::medium::{MediumShape, UnboundedRegion};

use super::{access::all, camera, transform::TextureUsage};
use crate::scenery::{Graphics, KnownTexture, SceneBuilder};
use crate::syntax::mitsuba::{MitsubaElement, MitsubaScene};
use crate::written::{ImportFiles, ImportedCamera, import_files};

/// Maximum depth of nested references and surfaces.
pub(super) const MAX_DEPTH: usize = 32;

/// Scene under construction, and the conversions of the file's elements.
pub(super) struct Importer<'a> {
    pub(super) scenery: SceneBuilder,
    /// Elements by id.
    ids: HashMap<&'a str, &'a MitsubaElement>,
    /// Our names of surfaces, by the numbers of their elements.
    pub(super) surfaces: HashMap<usize, Rc<str>>,
    /// Our names of surfaces with a normal map, with the name of the version whose green points down, if one exists.
    pub(super) normal_mapped: HashMap<Rc<str>, Option<Rc<str>>>,
    /// Converted textures, by the numbers of their elements and their use.
    pub(super) textures: HashMap<(usize, TextureUsage), KnownTexture>,
    /// True for shapes and surfaces with images, by the numbers of their elements.
    pub(super) has_image: HashMap<usize, bool>,
    /// Names of media, by the numbers of their elements; empty for unsupported ones.
    pub(super) media: HashMap<usize, Rc<str>>,
    cameras: Vec<ImportedCamera>,
    /// Search folders for files, in order.
    folders: &'a [PathBuf],
}

impl<'a> Importer<'a> {
    pub(super) fn new(file: &Path, folder: &Path, scene: &'a MitsubaScene) -> Result<Self, Error> {
        let root = &scene.root;
        let mut importer = Self {
            scenery: SceneBuilder::new(file, folder),
            ids: HashMap::new(),
            surfaces: HashMap::new(),
            normal_mapped: HashMap::new(),
            textures: HashMap::new(),
            has_image: HashMap::new(),
            media: HashMap::new(),
            cameras: Vec::new(),
            folders: &scene.folders,
        };
        importer.collect(root)?;
        importer.aliases(root)?;
        importer.take_cameras(root)?;
        for element in &root.children {
            importer.top(element)?;
        }
        Ok(importer)
    }

    /// Sets the place for later notes to that of an element.
    pub(super) fn at(&mut self, element: &MitsubaElement) {
        let file = element.place.file.file_name().unwrap_or_default().to_string_lossy();
        self.scenery.report.at(format!("{file}:{}", element.place.line));
    }

    fn collect(&mut self, element: &'a MitsubaElement) -> Result<(), Error> {
        if let Some(id) = element.attribute("id")
            && element.tag != "ref"
            && element.tag != "alias"
            && self.ids.insert(id, element).is_some()
        {
            return Err(element.error(format!("duplicate id \"{id}\"; give each element its own id")));
        }
        element.children.iter().try_for_each(|child| self.collect(child))
    }

    fn aliases(&mut self, root: &'a MitsubaElement) -> Result<(), Error> {
        for alias in all(root, "alias") {
            let (Some(id), Some(name)) = (alias.attribute("id"), alias.attribute("as")) else {
                return Err(alias.error("<alias> lacks \"id\" or \"as\""));
            };
            let known = self.ids.get(id).copied();
            self.ids.insert(name, known.ok_or_else(|| alias.error(format!("no element has the id \"{id}\"")))?);
        }
        Ok(())
    }

    /// Element, or the target of a reference.
    pub(super) fn resolve(&self, element: &'a MitsubaElement) -> Result<&'a MitsubaElement, Error> {
        if element.tag != "ref" {
            return Ok(element);
        }
        let id = element.attribute("id").ok_or_else(|| element.error("<ref> has no \"id\""))?;
        let target = self.ids.get(id).copied();
        let target = target.ok_or_else(|| element.error(format!("no element has the id \"{id}\"; check the id")))?;
        element.used.set(true);
        target.used.set(true);
        Ok(target)
    }

    /// Elements of a kind within another, directly or by reference, whatever their names.
    pub(super) fn within(&self, element: &'a MitsubaElement, tag: &str) -> Result<Vec<&'a MitsubaElement>, Error> {
        let mut matching = Vec::new();
        for child in element.children.iter().filter(|child| matches!(child.tag, "ref") || child.tag == tag) {
            let was_used = child.used.get();
            let target = self.resolve(child)?;
            if target.tag == tag {
                target.used.set(true);
                matching.push(target);
            } else {
                child.used.set(was_used);
            }
        }
        Ok(matching)
    }

    /// Path of a file that the scene file names.
    pub(super) fn file(&self, name: &str) -> PathBuf {
        let existing = self.folders.iter().map(|folder| folder.join(name)).find(|path| path.is_file());
        let folders: Vec<&Path> = self.folders.iter().map(PathBuf::as_path).collect();
        let beside = || find_named_file(&folders, name, &Sandbox::NONE).ok().filter(|file| file.exists);
        existing.or_else(|| Some(beside()?.path)).unwrap_or_else(|| self.scenery.source_folder.join(name))
    }

    /// The same; a file at another path than the stated one is noted.
    pub(super) fn noted_file(&mut self, name: &str) -> PathBuf {
        let file = self.file(name);
        if file.is_file() && !self.folders.iter().any(|folder| folder.join(name).is_file()) {
            self.scenery.report.note(format!("`{name}` is read from `{}`", self.scenery.relative_path(&file)));
        }
        file
    }

    /// The path of a file as the written scene names it.
    pub(super) fn path(&mut self, name: &str) -> String {
        let file = self.noted_file(name);
        self.scenery.relative_path(&file)
    }

    /// Notes the unused parameters of an element.
    pub(super) fn note_unused(&mut self, element: &MitsubaElement) {
        self.at(element);
        for child in element.children.iter().filter(|child| !child.used.get()) {
            let what = match (child.name(), child.tag, child.kind()) {
                ("", tag, "") => format!("<{tag}>"),
                ("", tag, kind) => format!("<{tag} type=\"{kind}\">"),
                (name, ..) => format!("\"{name}\""),
            };
            self.scenery.report.note(format!("{} \"{}\": {what} is not used", element.tag, element.kind()));
        }
    }

    /// Reads cameras first: the first one defines the up direction.
    fn take_cameras(&mut self, root: &'a MitsubaElement) -> Result<(), Error> {
        let sensors: Vec<&MitsubaElement> = all(root, "sensor").collect();
        let mut read = Vec::new();
        for sensor in sensors {
            self.at(sensor);
            let media = self.within(sensor, "medium")?;
            if let Some(camera) = camera::read(sensor, &mut self.scenery.report)? {
                read.push((sensor, camera, media));
            }
        }
        let first = read.first().map(|(_, camera, _)| camera.to_ours());
        self.scenery.to_ours = first.unwrap_or_else(|| camera::MitsubaCamera::at_origin().to_ours());
        if read.is_empty() {
            self.scenery.report.at(String::new());
            self.scenery.report.note("it has no supported camera: one at the origin that looks along z is added");
            let camera = camera::MitsubaCamera::at_origin();
            let imported = camera.into_imported("camera", self.scenery.to_ours, &mut self.scenery.report);
            self.cameras.push(imported);
        }
        for (sensor, camera, media) in read {
            self.at(sensor);
            let name = self.scenery.names.take(sensor.attribute("id").unwrap_or("camera"), "camera");
            let imported = camera.into_imported(&name, self.scenery.to_ours, &mut self.scenery.report);
            self.cameras.push(imported);
            for medium in media {
                let name = self.medium(medium)?;
                self.scenery
                    .report
                    .note("the medium of a camera fills the whole scene and adds to the media of shapes in it");
                self.scenery.fill(&name, MediumShape::Everywhere(UnboundedRegion::default()), Transform::default());
            }
            self.note_unused(sensor);
        }
        Ok(())
    }

    /// Converts an element at the top level of the scene.
    fn top(&mut self, element: &'a MitsubaElement) -> Result<(), Error> {
        self.at(element);
        let kind = element.kind();
        match element.tag {
            "shape" => self.shape(element, &Graphics::plain(), 0)?,
            "emitter" => self.emitter(element)?,
            "integrator" | "sampler" => {
                let message = format!("{} \"{kind}\" is not used: the job has its own settings", element.tag);
                self.scenery.report.note(message);
            }
            // Cameras are already read; elements with an id are used by reference.
            "sensor" | "alias" | "bsdf" | "texture" | "spectrum" | "medium" | "volume" | "phase" | "film"
            | "rfilter" | "rgb" => {}
            // Parameters, such as <default> of other versions.
            tag => self.scenery.report.note(format!("<{tag}> at the top level of the scene is not used")),
        }
        Ok(())
    }

    /// Files of the scene.
    pub(super) fn finish(self, file: &Path) -> Result<ImportFiles, Error> {
        let SceneBuilder { scene, mut report, files, .. } = self.scenery;
        report.at(String::new());
        let counts =
            [scene.objects.len(), scene.materials.len(), scene.textures.len(), scene.lights.len(), scene.media.len()];
        let [objects, materials, textures, lights, media] = counts;
        report.note(format!(
            "written: objects {objects}, materials {materials}, textures {textures}, lights {lights}, media {media}"
        ));
        let mut result = import_files(file, &scene, &self.cameras, report.lines());
        result.files.extend(files);
        Ok(result)
    }
}
