//! A chart before a camera of a job, as the job's files and changes of keys describe it: measures the effect of a change.

use super::camera::ChartCamera;
use super::{ChartRequest, make};
use crate::job_request::JobRequest;
use crate::job_request::RenderOptions;
use crate::memory::MemoryFiles;
use crate::result_files::write_file;
use etendue_core::Integrator;
use etendue_core::observer::Observer;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::{ExistingFiles, Sandbox};
use etendue_scene::CameraSetup;
use etendue_scene::record::paths::PathKeys;
use etendue_scene::record::samples::SampleKeys;
use etendue_scene::record::{Camera, Output, Render};
use etendue_scene::written::File;
use etendue_scene::{Description, Overrides};
use std::path::{Path, PathBuf};

/// Distance of a chart before a lens that is focused at infinity, m: its blur there equals that at infinity.
const FAR_M: f64 = 1000.0;
const CAMERA: &str = "job-camera.toml";
const JOB: &str = "job.toml";
const CHANGED_CAMERA: &str = "changed.toml";
const PHOTOGRAPHS: &str = "photographs";

/// A chart in a folder, made for a camera of a job. Exposure and distance are those that the job states for the camera.
#[derive(Clone, Debug)]
pub struct ChartForCamera {
    folder: PathBuf,
    camera: String,
}

impl ChartForCamera {
    /// Makes the chart of `request` before a camera of a job. The request's own camera is ignored. Without a stated distance the chart stands at the focus
    /// distance of the job's camera, at most 1 km away. The folder must hold nothing else.
    ///
    /// # Errors
    /// The job is invalid or has no such camera, the chart does not fit the camera, or the folder cannot be written.
    pub fn make(request: &ChartRequest, job: &JobRequest, camera: &str, folder: &Path) -> Result<Self, Error> {
        let setup = setup(job, camera)?;
        let failed = |error| Error::run(format!("{}: {error}", folder.display()));
        std::fs::create_dir_all(folder).map_err(failed)?;
        // An absolute path, because written files name other files by absolute paths.
        let folder = &folder.canonicalize().map_err(failed)?;
        let file = folder.join(CAMERA);
        write(&file, &File::new(without_exposure_control(setup.camera).to_table()))?;
        let camera_file = file.to_string_lossy().into_owned();
        let focus_m = ChartCamera::load(&camera_file, &[])?.body.lens.focus_distance_m();
        let distant_m = focus_m.filter(|m| !(m.is_finite() && *m < FAR_M)).map(|_| FAR_M);
        let request =
            ChartRequest { camera: camera_file, distance_m: request.distance_m.or(distant_m), ..request.clone() };
        make(&request, folder, ExistingFiles::Refuse)?;
        Ok(Self { folder: folder.to_owned(), camera: camera.to_owned() })
    }

    /// Path of the reference data of the chart (kind and position), for a measurement.
    #[must_use]
    pub fn truth(&self) -> PathBuf {
        self.folder.join("truth.json")
    }

    /// Captures the chart by the camera as `job` now describes it, with direct light only and `spp` samples per pixel. Returns the path of the developed
    /// image, or of the raw image of a camera without processing. Changes of the scene, of poses and of samples have no effect. A further capture replaces
    /// the one before. Runs on the caller's thread pool.
    ///
    /// # Errors
    /// The job is invalid, the camera makes no such image, the observer cancels, or the folder cannot be written.
    pub fn capture(
        &self,
        job: &JobRequest,
        spp: u32,
        options: &RenderOptions,
        observer: &dyn Observer,
    ) -> Result<PathBuf, Error> {
        let changed = setup(job, &self.camera)?;
        let mut chart = load(&self.folder.join(JOB), &Sandbox::NONE, &Overrides::default())?;
        let mut station = chart.cameras.swap_remove(0);
        station.camera = without_exposure_control(changed.camera);
        station.render = without_indirect_light(changed.render, spp);
        let makes_image = station.camera.isp.is_some();
        let no = || Some(false.into());
        station.output =
            Output { picture: Some(makes_image.into()), ground_truth: no(), radiance: no(), ..station.output };
        chart.cameras = vec![station];
        let file = self.folder.join(CHANGED_CAMERA);
        write(&file, &File::new(chart.to_table()))?;
        let request = JobRequest { films: job.films.clone(), textures: job.textures.clone(), ..JobRequest::new(file) };
        let folder = self.folder.join(PHOTOGRAPHS);
        let written = request.open()?.save(options, &folder, ExistingFiles::Replace, observer)?;
        let start = if makes_image { "picture." } else { "raw." };
        let is_image = |path: &&PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(start));
        let none = || {
            Error::coded(
                ErrorCode::UnavailableOutput,
                format!("camera {}: it produces no image to measure", self.camera),
            )
        };
        written.iter().find(is_image).cloned().ok_or_else(none)
    }
}

fn load(file: &Path, sandbox: &Sandbox, overrides: &Overrides) -> Result<Description, Error> {
    let files = MemoryFiles::new();
    let description = Description::load(file, &|path| files.read(path, sandbox), overrides);
    description.map_err(|errors| Error::inputs(errors.as_slice()))
}

/// A camera of a job, with absolute paths of its files.
fn setup(job: &JobRequest, camera: &str) -> Result<CameraSetup, Error> {
    let message = |error| Error::coded(ErrorCode::UnsuitableFile, format!("{}: {error}", job.job.display()));
    // Canonicalises the folder only: relative names start from the folder of a link, not from that of its target.
    let parent = job.job.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let file = parent.canonicalize().map_err(message)?.join(job.job.file_name().unwrap_or_default());
    let description = load(&file, &job.folders()?, &job.overrides())?;
    let setup = description.cameras.into_iter().find(|setup| setup.name.value == camera);
    setup.ok_or_else(|| Error::coded(ErrorCode::UnknownName, format!("{}: no camera {camera}", job.job.display())))
}

/// Removes what changes the exposure from frame to frame (it follows the job's scene, not the chart).
fn without_exposure_control(mut camera: Camera) -> Camera {
    if let Some(electronics) = &mut camera.sensor.electronics {
        electronics.auto_exposure = None;
    }
    camera
}

/// Flat sheets light only the camera: no indirect light.
fn without_indirect_light(render: Render, spp: u32) -> Render {
    let samples = SampleKeys { spp: Some(u64::from(spp).into()), replicates: Some(1.into()), ..SampleKeys::default() };
    Render { samples, integrator: Some(Integrator::Direct.into()), paths: PathKeys::default(), ..render }
}

fn write(path: &Path, file: &File) -> Result<(), Error> {
    write_file(path, file.to_string().as_bytes(), ExistingFiles::Replace)
}
