//! A camera of a plan.

use super::development::{Development, PictureFormat};
use super::mount::Mount;
use super::passes::{PassAt, Passes};
use super::products::Products;
use super::row_exposure::RowExposure;
use super::settings::{Route, Settings};
use super::timing::{TimeDependence, Timing};
use super::wavelength_sampling::SpectralGain;
use etendue_core::{CameraPath, CameraPose};
use etendue_optics::{DepthOfField, Effects, Front, FrontRay, Lens};
use etendue_projection::Raster;
use etendue_scene::Place;
use etendue_sensor::Sensor;
use glam::DVec2;

/// One camera of a plan.
#[derive(Clone, Debug)]
pub struct CameraPlan {
    /// Its name, part of file names.
    pub name: String,
    /// Its place in the job, part of the random addresses of its noise.
    pub index: u32,
    /// Whose light it sees: its own, or that of the first camera of the job whose light is equal.
    pub light: LightOwner,
    /// Where it stands, at every time.
    pub path: CameraPath,
    /// The frame that carries it, and where it is fixed there.
    pub mount: Mount,
    /// When its frames and rows are exposed.
    pub timing: Timing,
    /// Whether its light depends on that.
    pub time: TimeDependence,
    /// Everything behind the scene.
    pub body: CameraBody,
    /// How its light is found.
    pub settings: Settings,
    /// What the spectra of the light's sources in the density of wavelengths are foretold to save; `None` where no electrons are summed or
    /// no source gives any.
    pub spectral_gain: Option<SpectralGain>,
    /// The passes that its samples come in; `None`: all in one.
    pub passes: Option<Passes>,
    /// How things out of focus are blurred at the pupil; none through the lens, whose rays do it.
    pub depth_of_field: DepthOfField,
    /// What it delivers.
    pub products: Products,
}

impl CameraPlan {
    /// In how many passes its samples come.
    #[must_use]
    pub fn pass_count(&self) -> usize {
        self.passes.as_ref().map_or(1, |passes| passes.list().len())
    }

    /// One of these.
    #[must_use]
    pub fn pass(&self, number: usize) -> PassAt {
        self.passes.as_ref().map_or(PassAt::only(self.settings.spp), |passes| passes.at(number))
    }

    /// Where this camera and another are fixed in the frame that carries both; `None` where none does, so that they may come apart.
    #[must_use]
    pub fn fixed_pair(&self, other: &Self) -> Option<[CameraPose; 2]> {
        let fixed = self.mount.pose.zip(other.mount.pose).filter(|_| self.mount.frame == other.mount.frame);
        fixed.map(|(own, others)| [own, others])
    }

    /// The times, s, at which two cameras that nothing joins are compared: the middle of the first row's exposure in frame 0, and all their keys and half-way between.
    #[must_use]
    pub fn times_beside_s(&self, other: &Self) -> Vec<f64> {
        let mut keys_s = self.path.key_times_s();
        keys_s.extend(other.path.key_times_s());
        keys_s.sort_by(f64::total_cmp);
        let between_s = keys_s.windows(2).map(|pair| pair[0] + 0.5 * (pair[1] - pair[0]));
        let first_s = self.timing.row(0, 0, 0).middle_s();
        [first_s].into_iter().chain(between_s).chain(keys_s.iter().copied()).collect()
    }
}

/// The camera that a film is rendered for; others of equal light use it too.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightOwner {
    /// Its name.
    pub camera: String,
    /// Its place in the job, part of the random addresses of the light.
    pub index: u32,
}

/// A camera wherever it stands: lens, effects, sensor, processing.
#[derive(Clone, Debug)]
pub struct CameraBody {
    /// Where the description says how large the picture is.
    pub place: Place,
    /// The pixel grid.
    pub raster: Raster,
    /// Number of pixels of the described sensor in a row and in a column of one pixel: 4 for the scale 1/4.
    pub scale: u64,
    /// The lens.
    pub lens: Lens,
    /// What stands in front of it; `None` where nothing does.
    pub front: Option<Front>,
    /// What becomes of the irradiance behind the lens.
    pub effects: Effects,
    /// Side of the photosensitive area, in pixels.
    pub aperture_px: f64,
    /// When its rows are exposed.
    pub exposure: RowExposure,
    /// The electronics; `None` where no electrons are wanted.
    pub sensor: Option<Sensor>,
    /// How raw becomes a picture; `None` where none is wanted.
    pub development: Option<Development>,
}

impl CameraBody {
    /// How its pictures are written.
    #[must_use]
    pub fn picture_format(&self) -> PictureFormat {
        self.development.as_ref().map_or(PictureFormat::Png { bits: 8 }, |development| development.format)
    }
}

impl CameraBody {
    /// The pixels that are rendered: the picture's, and those beyond it that the effects need.
    #[must_use]
    pub fn film(&self) -> Raster {
        self.effects.film(&self.raster)
    }

    /// The ray by which ground truth looks from a point of the picture (px), and whether it is off the pupil's centre;
    /// `None` where no light comes.
    #[must_use]
    pub fn truth_ray(&self, raster_px: DVec2) -> Option<(FrontRay, bool)> {
        let sensor_mm = self.raster.sensor_mm(raster_px);
        match &self.front {
            Some(front) => front.truth_ray(&self.lens, sensor_mm),
            None => self.lens.truth_ray(sensor_mm).map(|truth| (FrontRay::bare(truth.ray), truth.off_centre)),
        }
    }

    /// Whether a ray or its weight depends on the wavelength.
    #[must_use]
    pub fn disperses(&self) -> bool {
        self.lens.disperses() || self.front.as_ref().is_some_and(Front::disperses)
    }
}

impl CameraPlan {
    /// Whether no camera before it in the job has the same light.
    #[must_use]
    pub fn owns_light(&self) -> bool {
        self.light.index == self.index
    }

    /// The sensor whose electrons its light is summed into, or watched for their noise.
    #[must_use]
    pub fn summing_sensor(&self) -> Option<&Sensor> {
        let Settings { folded, adaptive, route, .. } = &self.settings;
        self.body.sensor.as_ref().filter(|_| *folded || adaptive.is_some() && *route == Route::Lens)
    }

    /// Columns and rows of the film: of the picture with its margin, or of the stored radiance.
    #[must_use]
    pub fn film_size(&self) -> (u32, u32) {
        match &self.settings.route {
            Route::Lens => (self.body.film().width() as u32, self.body.film().height() as u32),
            Route::Pupil(projection) => (projection.width() as u32, projection.height() as u32),
        }
    }
}
