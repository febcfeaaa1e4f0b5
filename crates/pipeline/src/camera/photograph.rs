//! From light to frames: irradiance, electrons, raw, image.

use crate::camera::behind_lens::electrons;
use crate::camera::disk_light;
use crate::camera::effects::{EffectsOutput, behind, picture};
pub use crate::camera::light::LightError;
pub use crate::camera::light::{Light, StoredEstimate};
use crate::camera::stored::StoredRadianceImage;
use crate::plan::{CameraBody, CameraPlan, Development, Route, RowExposure};
use crate::render::film::{CubeEstimate, Film, FilmCube};
use crate::render::pupil_depth::PupilDepth;
use etendue_core::quantity::MeanElectrons;
use etendue_core::random::FrameAddress;
use etendue_core::{Plane, StoredCube};
pub use etendue_isp::{DevelopError, DevelopmentResult};
use etendue_isp::{RawImage, develop};
use etendue_optics::{DepthOfField, OpticsError};
use etendue_sensor::{CaptureLight, Raw, SensorState, SignalBreakdown};

impl Light {
    /// Light of a camera's film; at the pupil with the distances of its pixels, which its depth of field needs. Runs on the caller's pool.
    ///
    /// # Errors
    /// Depth of field meets a radiance that is not finite (a compiled plan contains its own image), or a scratch file fails.
    pub fn from_film(camera: &CameraPlan, film: Film, depth: Option<&PupilDepth>) -> Result<Self, LightError> {
        Self::light_from_film(camera, film, depth)
            .map(|light| light.with_row_exposures(&camera.body.exposure, Vec::new()))
    }

    /// Light of a camera whose captures see different light: films of the distinct captures ([`RowExposure::distinct_captures`]) in order, or a single one
    /// for all of them.
    ///
    /// # Errors
    /// As [`Light::from_film`].
    pub fn from_captures(
        camera: &CameraPlan,
        films: Vec<Film>,
        depth: Option<&PupilDepth>,
    ) -> Result<Self, LightError> {
        let rows = &camera.body.exposure;
        let mut lights =
            films.into_iter().map(|film| Self::light_from_film(camera, film, depth)).collect::<Result<Vec<_>, _>>()?;
        let further = if lights.len() > 1 { further_electrons(rows, &lights) } else { Vec::new() };
        Ok(lights.swap_remove(0).with_row_exposures(rows, further))
    }

    /// Light of a film, with all rows exposed equally.
    fn light_from_film(camera: &CameraPlan, film: Film, depth: Option<&PupilDepth>) -> Result<Self, LightError> {
        if let Some(cube) = film.disk().cloned() {
            return disk_light::light_from_film(camera, film, &cube, depth);
        }
        match &camera.settings.route {
            Route::Lens => Ok(Self::through_lens(camera, film)),
            Route::Pupil(projection) => {
                let radiance = film.radiance().expect("the route at the pupil keeps a cube");
                drop(film);
                let distance = depth.map(|depth| &depth.distance);
                let stored = StoredRadianceImage { projection, radiance: &radiance.mean, distance };
                let light = Self::from_stored(&camera.body, &stored, &camera.depth_of_field)?;
                Ok(Self { radiance: Some(radiance.into()), ..light })
            }
        }
    }

    fn through_lens(camera: &CameraPlan, film: Film) -> Self {
        let body = &camera.body;
        let radiance = if camera.products.needs_radiance() { film.radiance() } else { None };
        let radiance = radiance.map(|CubeEstimate { mean, variance }| CubeEstimate {
            mean: picture(body, mean),
            variance: picture(body, variance),
        });
        let part = body.effects.film_part(true);
        let behind = film.cube.and_then(FilmCube::into_memory).map(|c| behind(body, part, c.mean, Some(c.variance)));
        let (irradiance, irradiance_variance, ghosts) = match behind {
            Some(EffectsOutput { irradiance, variance, ghosts }) => (Some(irradiance), variance, ghosts),
            None => (None, None, None),
        };
        let exposure_s = body.sensor.as_ref().map(|sensor| sensor.parameters().exposure.exposure_s);
        let exposed = film.electron_rate.zip(exposure_s).map(|(rate, exposure_s)| rate.electrons(exposure_s));
        let (accumulates_electrons, electrons_variance) = exposed.map(|e| (e.mean, e.variance)).unzip();
        let electrons = accumulates_electrons.or_else(|| electrons(body, irradiance.as_ref()?));
        let further_electrons = Vec::new();
        Self {
            radiance: radiance.map(StoredEstimate::from),
            irradiance: irradiance.map(StoredCube::from),
            irradiance_variance: irradiance_variance.map(StoredCube::from),
            ghosts: ghosts.map(StoredCube::from),
            electrons,
            further_electrons,
            electrons_variance,
        }
    }

    /// Light behind a lens of a stored radiance image (without the radiance itself).
    ///
    /// # Errors
    /// The image does not contain directions that the camera needs, or the radiance is not finite.
    pub fn at_pupil(
        body: &CameraBody,
        stored: &StoredRadianceImage<'_>,
        depth_of_field: &DepthOfField,
    ) -> Result<Self, OpticsError> {
        Self::from_stored(body, stored, depth_of_field)
            .map(|light| light.with_row_exposures(&body.exposure, Vec::new()))
    }
}

/// Electrons of the captures after the first, from the lights of the distinct ones.
fn further_electrons(rows: &RowExposure, lights: &[Light]) -> Vec<Plane<MeanElectrons>> {
    let distinct = rows.distinct_captures();
    let same = |capture: usize| distinct.iter().position(|d| rows.captures[*d] == rows.captures[capture]);
    (1..rows.captures.len()).filter_map(|capture| lights[same(capture)?].electrons.clone()).collect()
}

/// One raw frame, and its developed image.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Digital numbers.
    pub raw: Raw,
    /// Components of the digital numbers, if requested.
    pub signal_breakdown: Option<SignalBreakdown>,
    /// Developed image, if the camera has processing.
    pub picture: Option<DevelopmentResult>,
}

/// Develops the part of a raw that receives light, from linear digital numbers, with the processing of a camera. Runs on the caller's pool.
///
/// # Errors
/// The raw is not of the camera's sensor.
pub fn developed(
    development: &Development,
    raw: &Raw,
    address: FrameAddress,
) -> Result<DevelopmentResult, DevelopError> {
    let linear = raw.linear();
    let image = RawImage {
        plane: &linear.plane,
        black_level_dn: linear.black_level_dn,
        white_level_dn: linear.white_level_dn,
        mosaic: &development.mosaic,
        optical_black: linear.optical_black.as_ref(),
    };
    develop(&image, &development.processing, address)
}

/// Developed image of a frame of the camera's own, if it has processing.
fn developed_image(body: &CameraBody, raw: &Raw, address: FrameAddress) -> Option<DevelopmentResult> {
    let development = body.development.as_ref()?;
    Some(developed(development, raw, address).expect("a compiled plan's processing fits its sensor"))
}

/// Captures one frame of `light`; the state is passed from frame to frame. `None` for a camera without electronics.
#[must_use]
pub fn capture(
    body: &CameraBody,
    state: SensorState,
    light: CaptureLight<'_>,
    address: FrameAddress,
) -> Option<(SensorState, Frame)> {
    let (state, raw) = body.sensor.as_ref()?.step_captures(state, light, address);
    let image = developed_image(body, &raw, address);
    Some((state, Frame { raw, signal_breakdown: None, picture: image }))
}

/// Captures the same frame, with the components of each pixel's digital number.
#[must_use]
pub fn capture_with_breakdown(
    body: &CameraBody,
    state: SensorState,
    light: CaptureLight<'_>,
    address: FrameAddress,
) -> Option<(SensorState, Frame)> {
    let (state, raw, signal_breakdown) = body.sensor.as_ref()?.step_captures_with_breakdown(state, light, address);
    let image = developed_image(body, &raw, address);
    Some((state, Frame { raw, signal_breakdown: Some(signal_breakdown), picture: image }))
}
