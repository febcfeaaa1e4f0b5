//! The plan: everything that a rendering needs, resolved and checked. Immutable.

mod annotations;
mod camera;
mod camera_memory;
mod development;
pub mod effects;
mod film_bytes;
mod film_cost;
mod film_limit;
pub(crate) mod film_needs;
pub(crate) mod fingerprint;
mod frame_cost;
mod frame_memory;
mod irradiance_effect;
mod mesh_sizes;
mod mount;
mod passes;
mod path_cost;
mod precipitation;
mod products;
pub mod remark;
mod row_exposure;
mod run_memory;
mod settings;
pub(crate) mod shared_light;
mod source_spectra;
pub mod summary;
mod texture_use;
mod timing;
mod view_memory;
mod warnings;
mod wavelength_sampling;

use crate::plan::remark::Remark;
use etendue_tracer::accel::World;
use etendue_tracer::lights::Sources;
use etendue_tracer::materials::MaterialTable;
use etendue_tracer::media::Medium;
use glam::DMat3;
use std::sync::Arc;

pub use annotations::{Annotations, CorrespondenceFormat, DisparityProduct};
pub use camera::{CameraBody, CameraPlan, LightOwner};
pub use camera_memory::{CameraMemory, ROWS_WAITING_BYTES, StageMemory};
pub use development::{Development, PictureFormat};
pub use film_bytes::FilmBytes;
pub use film_cost::Share;
pub use film_limit::FilmLimit;
pub use frame_cost::FrameCost;
pub use mesh_sizes::{MeshSize, mesh_sizes};
pub use mount::Mount;
pub(crate) use passes::CameraPasses;
pub use passes::{MAX_PASSES, PARTS, Pass, PassAt, Passes};
pub use precipitation::Precipitation;
pub use products::{Products, RawFormat};
pub use row_exposure::{CaptureTiming, RowExposure, RowSkipping};
pub use run_memory::RunMemory;
pub use settings::{AdaptiveSampling, Route, Settings};
pub use source_spectra::SourceSpectra;
pub use timing::{Jitter, TimeDependence, Timing};
pub use wavelength_sampling::{SpectralGain, WavelengthSampling};

/// What a rendering does, for all cameras of a job.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Meshes and instances.
    pub world: Arc<World>,
    /// Materials and textures.
    pub material_table: Arc<MaterialTable>,
    /// What shines but is no surface.
    pub sources: Sources,
    /// The spectra of all light.
    pub source_spectra: SourceSpectra,
    /// What scatters light between surfaces.
    pub media: Vec<Medium>,
    /// Rain or snow, whose medium is one of these.
    pub precipitation: Option<Precipitation>,
    /// What is said of the sky, where the surroundings are one.
    pub sky: Option<SkyFacts>,
    /// The cameras.
    pub cameras: Vec<CameraPlan>,
    /// What the instance ids of the ground truth stand for, from id 1.
    pub identities: Vec<Identity>,
    /// Names of the materials; the ground truth's material id is the place in this list, from 1.
    pub materials: Vec<String>,
    /// Semantic classes: name and id.
    pub classes: Vec<(String, u32)>,
    /// What was read and not used, what was dropped, where tables end.
    pub remarks: Vec<Remark>,
    /// Which keys of the files the command line makes meaningless, in sentences.
    pub notices: Vec<String>,
    /// How much memory the bands of a film may take; `None`: any.
    pub film_limit: Option<FilmLimit>,
    /// Hash of all that decides the result: description, assets by content, version.
    pub hash: [u8; 32],
    /// The same without the passes of cameras that have some.
    pub(crate) described: [u8; 32],
    /// The replicates and passes of all cameras of the job, those included that are not rendered.
    pub(crate) passes: Vec<CameraPasses>,
}

/// A clear sky in figures, for people.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyFacts {
    /// Turbidity.
    pub turbidity: f64,
    /// Height of the sun's centre, degrees.
    pub sun_elevation_deg: f64,
    /// Azimuth of the sun's centre from +x towards +y, degrees.
    pub sun_azimuth_deg: f64,
    /// Illuminance of level ground by the sky, lx.
    pub sky_lx: f64,
    /// Illuminance of level ground by the sky's own sun, lx; 0 where it is left out or down.
    pub sun_lx: f64,
}

/// What an instance id stands for.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Identity {
    /// The instance's name.
    pub name: String,
    /// Its semantic class.
    pub class: Option<String>,
    /// The rotation from the object's axes (x forward, y left, z up) to those of its shape: of a mesh those of its file.
    #[serde(skip_serializing_if = "is_identity")]
    pub axes: DMat3,
}

fn is_identity(axes: &DMat3) -> bool {
    *axes == DMat3::IDENTITY
}

impl Plan {
    /// The object of an identity in the ground truth; `None` of 0, the background.
    #[must_use]
    pub fn identity(&self, id: u32) -> Option<&Identity> {
        self.identities.get((id as usize).checked_sub(1)?)
    }

    /// The camera of a name.
    #[must_use]
    pub fn camera(&self, name: &str) -> Option<&CameraPlan> {
        self.cameras.iter().find(|camera| camera.name == name)
    }

    /// Whether the strength of any light changes over time.
    #[must_use]
    pub fn is_modulated(&self) -> bool {
        self.sources.is_modulated() || self.material_table.is_modulated()
    }

    /// The same with these passes of all cameras, where a time decides them; in `replicates` replicates, where the command line does not say how many.
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
        plan.hash = fingerprint::with_passes(&plan.described, &plan.passes);
        plan
    }

    /// The replicates of each camera of the job.
    pub fn replicates(&self) -> impl Iterator<Item = u32> {
        self.passes.iter().map(|camera| camera.replicates)
    }

    /// The replicates that all cameras of the job have, where the command line does not say how many: a time may allow fewer.
    #[must_use]
    pub fn open_replicates(&self) -> Option<u32> {
        let first = self.passes.first()?.replicates;
        self.passes.iter().all(|camera| camera.is_open && camera.replicates == first).then_some(first)
    }

    /// The hash in hexadecimal.
    #[must_use]
    pub fn hash_text(&self) -> String {
        self.hash.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}
