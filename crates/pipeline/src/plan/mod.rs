//! The plan: all data of a render, resolved and checked. Immutable.

mod camera;
pub(crate) mod camera_body;
pub(crate) mod film;
pub mod note;
mod passes;
pub mod pixel_density;
mod products;
pub mod raw_colour;
pub mod rectified;
mod row_exposure;
mod settings;
mod source_spectra;
mod timing;
mod wavelength_sampling;
mod weather;

use crate::plan::note::Note;
use etendue_core::storage::ScratchStore;
use etendue_tracer::accel::World;
use etendue_tracer::lights::Sources;
use etendue_tracer::materials::MaterialTable;
use etendue_tracer::media::Medium;
use glam::DMat3;
use std::sync::Arc;

pub use crate::sizes::tolerance::AdaptiveSampling;
pub use camera::{CameraPlan, LightOwner, Mount};
pub use camera_body::CameraBody;
pub use film::FilmMemoryLimit;
pub(crate) use passes::{CameraPasses, hash_with_passes};
pub use passes::{MAX_PASSES, NumberedPass, PARTS, Pass, Passes};
pub use products::{
    Annotations, CorrespondenceFormat, Development, DisparityProduct, ListedProduct, PictureFormat, Products,
    default_raw_format, raw_extension,
};
pub use row_exposure::{CaptureTiming, RowExposure, RowSkipping};
pub use settings::{Route, Settings};
pub use source_spectra::SourceSpectra;
pub use timing::{Jitter, TimeDependence, Timing};
pub use wavelength_sampling::{SpectralGain, WavelengthSampling};
pub use weather::{Airlight, Precipitation, PrecipitationExposure, Weather};

/// Data of a render, for all cameras of a job.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Meshes and instances.
    pub world: Arc<World>,
    /// Materials and textures.
    pub material_table: Arc<MaterialTable>,
    /// Light sources that are not surfaces.
    pub sources: Sources,
    /// Spectra of all light sources.
    pub source_spectra: SourceSpectra,
    /// Participating media.
    pub media: Vec<Medium>,
    /// Rain or snow; its medium is one of `media`.
    pub precipitation: Option<Precipitation>,
    /// Facts of the sky, if the surroundings are one.
    pub sky: Option<SkyFacts>,
    pub cameras: Vec<CameraPlan>,
    /// Meaning of the instance ids in the ground truth, from id 1.
    pub identities: Vec<Identity>,
    /// Names of the materials; a material id in the ground truth is the position in this list, from 1.
    pub materials: Vec<String>,
    /// Semantic classes: name and id.
    pub classes: Vec<(String, u32)>,
    /// Notes and warnings: inputs that were read but not used, values that were dropped, ends of tables.
    pub notes: Vec<Note>,
    /// Keys of the files that the command line overrides, as sentences.
    pub overridden_keys: Vec<String>,
    /// Memory limit of film bands; `None`: unlimited.
    pub film_limit: Option<FilmMemoryLimit>,
    /// Hash of everything that determines the result: description, assets by content, version.
    pub hash: [u8; 32],
    /// The same hash without the passes of cameras that have any.
    pub(crate) described: [u8; 32],
    /// Replicates and passes of all cameras of the job, including those that are not rendered.
    pub(crate) passes: Vec<CameraPasses>,
}

/// Parameters of a clear sky, for reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyFacts {
    pub turbidity: f64,
    /// Elevation of the sun's centre, degrees.
    pub sun_elevation_deg: f64,
    /// Azimuth of the sun's centre from +x towards +y, degrees.
    pub sun_azimuth_deg: f64,
    /// Illuminance of horizontal ground by the sky, lx.
    pub sky_lx: f64,
    /// Illuminance of horizontal ground by the sky's sun, lx; 0 if the sun is disabled or below the horizon.
    pub sun_lx: f64,
}

/// Meaning of an instance id.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Identity {
    /// The instance's name.
    pub name: String,
    /// Its semantic class.
    pub class: Option<String>,
    /// Rotation from the object's axes (x forward, y left, z up) to those of its shape; for a mesh those of its file.
    #[serde(skip_serializing_if = "is_identity")]
    pub axes: DMat3,
}

fn is_identity(axes: &DMat3) -> bool {
    *axes == DMat3::IDENTITY
}

impl Plan {
    /// Object of an id in the ground truth; `None` for 0, the background.
    #[must_use]
    pub fn identity(&self, id: u32) -> Option<&Identity> {
        self.identities.get((id as usize).checked_sub(1)?)
    }

    /// Finds a camera by name.
    #[must_use]
    pub fn camera(&self, name: &str) -> Option<&CameraPlan> {
        self.cameras.iter().find(|camera| camera.name == name)
    }

    /// Returns true if the strength of any light varies over time.
    #[must_use]
    pub fn is_modulated(&self) -> bool {
        self.sources.is_modulated() || self.material_table.is_modulated()
    }

    /// Returns the plan with these passes for all cameras, for a run of a given time; with `replicates` replicates unless the command line states them.
    #[must_use]
    pub fn with_passes(&self, passes: &Passes, replicates: Option<u32>) -> Self {
        let mut plan = self.clone();
        for of_camera in &mut plan.passes {
            of_camera.replicates = replicates.filter(|_| of_camera.is_open).unwrap_or(of_camera.replicates);
            of_camera.passes = Some(passes.clone());
        }
        for camera in &mut plan.cameras {
            camera.settings.spp = passes.spp();
            camera.settings.replicates = plan.passes[camera.index as usize].replicates;
            camera.passes = Some(passes.clone());
        }
        plan.hash = hash_with_passes(&plan.described, &plan.passes);
        plan
    }

    /// Cameras grouped by light, each group in the order of the job: one film serves a group.
    #[must_use]
    pub fn by_light(&self) -> Vec<Vec<&CameraPlan>> {
        let mut groups: Vec<Vec<&CameraPlan>> = Vec::new();
        for camera in &self.cameras {
            match groups.iter_mut().find(|group| group[0].light == camera.light) {
                Some(group) => group.push(camera),
                None => groups.push(vec![camera]),
            }
        }
        groups
    }

    /// Storage of the bands of a camera's film that exceed memory; `None` if they do not, or without a limit.
    #[must_use]
    pub fn scratch(&self, camera: &CameraPlan) -> Option<&Arc<dyn ScratchStore>> {
        let limit = self.film_limit.as_ref()?;
        let (width, height) = camera.film_size();
        let bytes = camera.film_layout().cube_bytes(width as usize, height as usize);
        (bytes > limit.bytes as f64).then_some(&limit.store)
    }

    /// The replicates of each camera of the job.
    pub fn replicates(&self) -> impl Iterator<Item = u32> {
        self.passes.iter().map(|camera| camera.replicates)
    }

    /// Replicates common to all cameras of the job, if the command line does not state them: a given time may allow fewer.
    #[must_use]
    pub fn open_replicates(&self) -> Option<u32> {
        let first = self.passes.first()?.replicates;
        self.passes.iter().all(|camera| camera.is_open && camera.replicates == first).then_some(first)
    }

    /// Hash in hexadecimal.
    #[must_use]
    pub fn hash_text(&self) -> String {
        self.hash.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}
