//! A camera of a plan.

use super::camera_body::CameraBody;
use super::passes::{PassAt, Passes};
use super::products::Products;
use super::settings::{Route, Settings};
use super::timing::{TimeDependence, Timing};
use crate::sizes::film::Layout;
use crate::sizes::spectrum_spread::SpectrumSpread;
use crate::sizes::tolerance::Tolerance;
use etendue_core::{CameraPath, CameraPose};
use etendue_optics::DepthOfField;
use etendue_sensor::Sensor;

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

    /// Whether each ray through the lens, or its weight, depends on its wavelength, so that a path carries one.
    #[must_use]
    pub fn disperses(&self) -> bool {
        self.settings.route == Route::Lens && self.body.disperses()
    }

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

    /// Returns the planes of its film.
    #[must_use]
    pub fn film_layout(&self) -> Layout {
        let Settings { bands, folded, adaptive, .. } = self.settings;
        Layout { bands, folded, watched: adaptive.is_some() }
    }

    /// Returns over what the wavelengths of its samples are spread.
    #[must_use]
    pub fn spectrum_spread(&self) -> SpectrumSpread {
        match (self.settings.bands, self.products.variance) {
            (None, _) => SpectrumSpread::Drawn,
            (Some(_), _) if self.settings.adaptive.is_some() => SpectrumSpread::Open,
            (Some(_), true) => SpectrumSpread::EachReplicate,
            (Some(_), false) => SpectrumSpread::AllReplicates,
        }
    }

    /// Returns its tolerance; `None` unless noise decides its samples.
    #[must_use]
    pub fn tolerance(&self) -> Option<Tolerance> {
        let limit = self.settings.adaptive?;
        let sensor = self.body.sensor.as_ref().filter(|_| self.settings.route == Route::Lens);
        let noise = sensor.map(|sensor| match self.light_stays(sensor) {
            true => sensor.temporal_noise(),
            false => sensor.temporal_noise().never_white(),
        });
        Some(Tolerance::new(limit, noise))
    }

    /// Whether nothing but a pixel's own number shows how bright it is beyond white: no effect spreads its light, no charge flows over, and
    /// no spectrum is kept.
    fn light_stays(&self, sensor: &Sensor) -> bool {
        self.body.effects.is_idle() && self.settings.bands.is_none() && !sensor.spills()
    }
}

/// The frame that carries a camera, and its pose there.
#[derive(Clone, Debug, PartialEq)]
pub struct Mount {
    /// The frame of the scene; `None` is the world.
    pub frame: Option<String>,
    /// From the camera frame (x right, y down, z forward; origin at the centre of the entrance pupil) to that frame, m; `None` where the
    /// camera moves in it.
    pub pose: Option<CameraPose>,
}

/// The camera that a film is rendered for; others of equal light use it too.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightOwner {
    /// Its name.
    pub camera: String,
    /// Its place in the job, part of the random addresses of the light.
    pub index: u32,
}
