//! From the path of a job to its records: reading files, overrides, checks.

mod base;
mod check;
mod edit;
mod files;
pub mod named_files;
mod names;
mod read_text;
mod usage;

use std::path::{Path, PathBuf};

use crate::asset::AssetRequest;
use crate::document::Node;
pub use edit::edit;
use named_files::requests;
pub use read_text::ReadText;
pub use usage::UnusedNames;

use crate::fault::DescriptionErrors;
use crate::overrides::Overrides;
use crate::preset;
use crate::reader::{Record as _, Rule as _, record};
use crate::record::job::CameraSource;
use crate::record::render::{check_merged, check_path_keys};
use crate::record::variations::Variations;
use crate::record::weather::Weather;
use crate::record::{Camera, CameraEntry, DataSheet, Job, Laboratory, Output, Pose, Render, Scene, Sequence};
use crate::written::Table;

/// A job with its scene and cameras, checked.
#[derive(Clone, Debug)]
pub struct Description {
    /// File of the job.
    pub file: PathBuf,
    pub scene: Scene,
    /// Times of the frames; `None`: frame 0 at 0 s.
    pub sequence: Option<Sequence>,
    /// Cameras, one or more, with unique names.
    pub cameras: Vec<CameraSetup>,
    /// Parts of the scene that are not used.
    pub unused: UnusedNames,
    /// Keys that the command line makes meaningless, in sentences.
    pub overridden_keys: Vec<String>,
}

/// A camera of a job.
#[derive(Clone, Debug)]
pub struct CameraSetup {
    /// Name of the camera.
    pub name: crate::Placed<String>,
    /// Lens, sensor, processing.
    pub camera: Camera,
    pub pose: Pose,
    /// Start of its frames relative to the sequence.
    pub trigger: Trigger,
    /// Render settings: the camera's, completed by the job's.
    pub render: Render,
    /// Outputs: the camera's, completed by the job's.
    pub output: Output,
}

/// Start of a camera's frames relative to the sequence of its job.
#[derive(Clone, Debug, Default)]
pub struct Trigger {
    /// Delay, s; `None`: 0.
    pub offset_s: Option<crate::Placed<f64>>,
    /// Greatest random deviation, s; `None`: 0.
    pub jitter_s: Option<crate::Placed<f64>>,
}

impl Description {
    /// Reads the job in `file` and all files that it names except the assets, applies `overrides` and checks.
    ///
    /// # Errors
    /// All errors of all files.
    pub fn load(file: &Path, read: &ReadText<'_>, overrides: &Overrides) -> Result<Self, DescriptionErrors> {
        let mut errors = DescriptionErrors::none();
        let mut job = files::job(file, read, overrides, &mut errors);
        job.iter_mut().for_each(|document| preset::expand(document, &mut errors));
        let description = job.and_then(|document| Self::read(file, &document, &mut errors));
        errors.into_result(description)
    }

    fn read(file: &Path, document: &Node, errors: &mut DescriptionErrors) -> Option<Self> {
        let job = record::<Job>().read(document, errors);
        names::check(document, errors);
        let uses = check::references(document, errors);
        let Job { scene, cameras, sequence, render, output, .. } = job?;
        let setup = |entry| CameraSetup::new(entry, render.as_ref(), output.as_ref());
        let cameras: Vec<_> = cameras.into_iter().map(setup).collect();
        cameras.iter().for_each(|c| check_merged(&c.render, errors));
        // A camera with errors of its own is missing here, and it may be the one that traces paths.
        let camera_count =
            document.as_table().and_then(|job| job.get("cameras")).map_or(0, |list| list.as_list().len());
        if cameras.len() == camera_count {
            check_path_keys(cameras.iter().map(|c| &c.render), errors);
        }
        Some(Self {
            file: file.to_owned(),
            unused: UnusedNames::new(&scene, &uses),
            scene,
            sequence,
            cameras,
            overridden_keys: errors.notices(),
        })
    }

    /// Returns the job with scene and cameras instead of the names of their files: one table, one file.
    #[must_use]
    pub fn to_table(&self) -> Table {
        let cameras: Vec<_> = self.cameras.iter().map(CameraSetup::to_table).collect();
        let table = Table::new().with("scene", self.scene.to_table()).with("cameras", cameras);
        match &self.sequence {
            Some(sequence) => table.with("sequence", sequence.to_table()),
            None => table,
        }
    }

    /// Returns every used file that the description names, except text files of its own format, each once.
    #[must_use]
    pub fn assets(&self) -> Vec<AssetRequest> {
        requests(&self.scene, &self.unused, self.cameras.iter().map(|entry| (&entry.camera, &entry.pose)))
    }
}

impl CameraSetup {
    fn new(entry: CameraEntry, render: Option<&Render>, output: Option<&Output>) -> Self {
        let CameraEntry {
            name,
            camera: CameraSource(camera),
            pose,
            trigger_offset_s,
            trigger_jitter_s,
            render: own_render,
            output: own_output,
            place,
        } = entry;
        let trigger = Trigger { offset_s: trigger_offset_s, jitter_s: trigger_jitter_s };
        let own_render = own_render.unwrap_or_else(|| Render { place: place.clone(), ..Render::default() });
        let own_output = own_output.unwrap_or_else(|| Output { place, ..Output::default() });
        let render = render.map_or(own_render.clone(), |base| own_render.over(base));
        let output = output.map_or(own_output.clone(), |base| own_output.over(base));
        Self { name, camera, pose, trigger, render, output }
    }

    /// Returns the job's keys of the camera, with the render and output settings that the job states for all cameras; these may include keys without
    /// effect on this camera.
    #[must_use]
    pub fn to_table(&self) -> Table {
        let named = Table::new().with("name", self.name.clone());
        let placed = named.and(self.camera.to_table()).and(self.pose.to_table()).and(self.trigger.to_table());
        placed.with("render", self.render.to_table()).with("output", self.output.to_table())
    }
}

impl Trigger {
    fn to_table(&self) -> Table {
        let keys = [("trigger_offset_s", &self.offset_s), ("trigger_jitter_s", &self.jitter_s)];
        keys.into_iter().fold(Table::new(), |table, (key, value)| match value {
            Some(value) => table.with(key, value.clone()),
            None => table,
        })
    }
}

/// Reads a camera file by itself, applies `overrides` (keys of the camera file) and checks.
///
/// # Errors
/// All errors of the file.
pub fn load_camera(file: &Path, read: &ReadText<'_>, overrides: &Overrides) -> Result<Camera, DescriptionErrors> {
    let mut errors = DescriptionErrors::none();
    let mut document =
        files::document(file, files::FileKind::Camera, read, &crate::Place::file_head(file), &mut errors);
    if let Some(document) = &mut document {
        overrides.apply(document, true, &mut errors);
        overrides.apply(document, false, &mut errors);
    }
    let camera = document.and_then(|d| record::<Camera>().read(&d, &mut errors));
    errors.into_result(camera)
}

/// Reads a weather file.
///
/// # Errors
/// All errors of the file.
pub fn load_weather(file: &Path, read: &ReadText<'_>) -> Result<Weather, DescriptionErrors> {
    let mut errors = DescriptionErrors::none();
    let document = files::single(file, read, &mut errors);
    let weather = document.and_then(|d| record::<Weather>().read(&d, &mut errors));
    errors.into_result(weather)
}

/// Reads a variations file.
///
/// # Errors
/// All errors of the file.
pub fn load_variations(file: &Path, read: &ReadText<'_>) -> Result<Variations, DescriptionErrors> {
    let mut errors = DescriptionErrors::none();
    let document = files::single(file, read, &mut errors);
    let variations = document.and_then(|d| record::<Variations>().read(&d, &mut errors));
    errors.into_result(variations)
}

/// Reads an EMVA 1288 data sheet.
///
/// # Errors
/// All errors of the file.
pub fn load_datasheet(file: &Path, read: &ReadText<'_>) -> Result<DataSheet, DescriptionErrors> {
    let mut errors = DescriptionErrors::none();
    let document = files::single(file, read, &mut errors);
    let sheet = document.and_then(|d| record::<DataSheet>().read(&d, &mut errors));
    errors.into_result(sheet)
}

/// Reads a laboratory file.
///
/// # Errors
/// All errors of the file.
pub fn load_laboratory(file: &Path, read: &ReadText<'_>) -> Result<Laboratory, DescriptionErrors> {
    let mut errors = DescriptionErrors::none();
    let document = files::single(file, read, &mut errors);
    let laboratory = document.and_then(|d| record::<Laboratory>().read(&d, &mut errors));
    errors.into_result(laboratory)
}

/// Returns the keys of `[render]` that the job in `file` states, for all cameras or for `camera`, as dotted keys of the job: `render.spp`,
/// `cameras.front.render.spp`. An unreadable file gives none; [`Description::load`] reports the cause.
#[must_use]
pub fn stated_render_keys(file: &Path, camera: &str, read: &ReadText<'_>) -> Vec<String> {
    let Some(job) = files::job(file, read, &Overrides::default(), &mut DescriptionErrors::none()) else {
        return Vec::new();
    };
    let keys = |node: &Node, prefix: &str| -> Vec<String> {
        let render = node.as_table().and_then(|table| table.get("render")).and_then(Node::as_table);
        let keys = render.map(|render| render.entries.iter().map(|entry| format!("{prefix}render.{}", entry.key)));
        keys.into_iter().flatten().collect()
    };
    let cameras = job.as_table().and_then(|table| table.get("cameras")).map_or(&[][..], Node::as_list);
    let own = cameras.iter().find(|entry| entry.name() == Some(camera));
    [keys(&job, ""), own.map_or_else(Vec::new, |entry| keys(entry, &format!("cameras.{camera}.")))].concat()
}
