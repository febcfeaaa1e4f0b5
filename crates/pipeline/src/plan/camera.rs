//! A camera of a plan.

use super::camera_body::CameraBody;
use super::passes::{NumberedPass, Passes};
use super::products::Products;
use super::settings::{Route, Settings};
use super::timing::{TimeDependence, Timing};
use crate::sizes::film::FilmLayout;
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
    /// Index of the camera in the job, part of the random addresses of its noise.
    pub index: u32,
    /// Owner of its light: the camera itself, or the first camera of the job with equal light.
    pub light: LightOwner,
    /// Pose of the camera over time.
    pub path: CameraPath,
    /// Frame that carries the camera, and its pose there.
    pub mount: Mount,
    /// Exposure times of its frames and rows.
    pub timing: Timing,
    /// Dependence of its light on time.
    pub time: TimeDependence,
    /// Lens, sensor and processing.
    pub body: CameraBody,
    /// Render settings.
    pub settings: Settings,
    /// Passes of its samples; `None`: a single pass.
    pub passes: Option<Passes>,
    /// Method of blurring objects out of focus, for the pupil route; none through the lens, whose rays model it.
    pub depth_of_field: DepthOfField,
    /// Products that it delivers.
    pub products: Products,
}

impl CameraPlan {
    /// Number of passes of its samples.
    #[must_use]
    pub fn pass_count(&self) -> usize {
        self.passes.as_ref().map_or(1, |passes| passes.list().len())
    }

    /// Pass of a given index.
    #[must_use]
    pub fn pass(&self, number: usize) -> NumberedPass {
        self.passes.as_ref().map_or(NumberedPass::only(self.settings.spp), |passes| passes.at(number))
    }

    /// Poses of this camera and another in the frame that carries both rigidly; `None` if there is none, so that they may move apart.
    #[must_use]
    pub fn fixed_pair(&self, other: &Self) -> Option<[CameraPose; 2]> {
        let fixed = self.mount.pose.zip(other.mount.pose).filter(|_| self.mount.frame == other.mount.frame);
        fixed.map(|(own, others)| [own, others])
    }

    /// Times, s, at which two independently moving cameras are compared: the middle of the first row's exposure in frame 0, and all their keys and the times
    /// half-way between.
    #[must_use]
    pub fn comparison_times_s(&self, other: &Self) -> Vec<f64> {
        let mut keys_s = self.path.key_times_s();
        keys_s.extend(other.path.key_times_s());
        keys_s.sort_by(f64::total_cmp);
        let between_s = keys_s.windows(2).map(|pair| pair[0] + 0.5 * (pair[1] - pair[0]));
        let first_s = self.timing.row(0, 0, 0).middle_s();
        [first_s].into_iter().chain(between_s).chain(keys_s.iter().copied()).collect()
    }

    /// Returns true if the rays through the lens, or their weights, depend on wavelength, so that a path carries a single one.
    #[must_use]
    pub fn disperses(&self) -> bool {
        self.settings.route == Route::Lens && self.body.disperses()
    }

    /// Returns true if no earlier camera of the job has the same light.
    #[must_use]
    pub fn is_first_with_light(&self) -> bool {
        self.light.index == self.index
    }

    /// Sensor for which the film accumulates electrons, or monitors their noise.
    #[must_use]
    pub fn summing_sensor(&self) -> Option<&Sensor> {
        let Settings { accumulates_electrons, adaptive, route, .. } = &self.settings;
        self.body.sensor.as_ref().filter(|_| *accumulates_electrons || adaptive.is_some() && *route == Route::Lens)
    }

    /// Columns and rows of the film: of the image with its margin, or of the stored radiance.
    #[must_use]
    pub fn film_size(&self) -> (u32, u32) {
        match &self.settings.route {
            Route::Lens => (self.body.film().width() as u32, self.body.film().height() as u32),
            Route::Pupil(projection) => (projection.width() as u32, projection.height() as u32),
        }
    }

    /// Returns the planes of its film.
    #[must_use]
    pub fn film_layout(&self) -> FilmLayout {
        let Settings { bands, accumulates_electrons, adaptive, .. } = self.settings;
        FilmLayout { bands, accumulates_electrons, watched: adaptive.is_some() }
    }

    /// Returns the scheme that spreads the wavelengths of its samples.
    #[must_use]
    pub fn spectrum_spread(&self) -> SpectrumSpread {
        match (self.settings.bands, self.products.variance) {
            (None, _) => SpectrumSpread::Drawn,
            (Some(_), _) if self.settings.adaptive.is_some() => SpectrumSpread::Open,
            (Some(_), true) => SpectrumSpread::EachReplicate,
            (Some(_), false) => SpectrumSpread::AllReplicates,
        }
    }

    /// Returns its tolerance; `None` unless sampling is noise-limited.
    #[must_use]
    pub fn tolerance(&self) -> Option<Tolerance> {
        let limit = self.settings.adaptive?;
        let sensor = self.body.sensor.as_ref().filter(|_| self.settings.route == Route::Lens);
        let noise = sensor.map(|sensor| match self.stays_in_pixel(sensor) {
            true => sensor.temporal_noise(),
            false => sensor.temporal_noise().without_saturation(),
        });
        Some(Tolerance::new(limit, noise))
    }

    /// Returns true if light beyond white affects only the pixel's own number: no effect spreads it, no charge overflows to neighbours, and no spectrum is
    /// stored.
    fn stays_in_pixel(&self, sensor: &Sensor) -> bool {
        self.body.effects.is_idle() && self.settings.bands.is_none() && !sensor.has_spatial_coupling()
    }
}

/// The frame that carries a camera, and its pose there.
#[derive(Clone, Debug, PartialEq)]
pub struct Mount {
    /// Frame of the scene; `None` is the world.
    pub frame: Option<String>,
    /// Transform from the camera frame (x right, y down, z forward; origin at the centre of the entrance pupil) to that frame, m; `None` if the camera moves
    /// in it.
    pub pose: Option<CameraPose>,
}

/// Camera for which a film is rendered; others of equal light share it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightOwner {
    /// Its name.
    pub camera: String,
    /// Index of the camera in the job, part of the random addresses of the light.
    pub index: u32,
}
