//! From light to photographs: irradiance, electrons, raw, picture.

use crate::camera::defocus;
use crate::camera::effects::{EffectsOutput, behind, picture};
use crate::camera::stored::Stored;
use crate::plan::{CameraBody, CameraPlan, Development, Route, RowExposure};
use crate::render::film::{CubeEstimate, Film};
use crate::render::pupil_depth::PupilDepth;
use etendue_core::quantity::{Irradiance, MeanElectrons, Quantity, Radiance, Variance};
use etendue_core::random::FrameAddress;
use etendue_core::{Plane, SpectralCube};
pub use etendue_isp::{DevelopError, Developed};
use etendue_isp::{RawPicture, develop};
use etendue_optics::front::{Dirt, Front};
use etendue_optics::{DepthOfField, OpticsError, irradiance};
use etendue_sensor::{CaptureLight, Raw, SensorState, SignalBreakdown};
use glam::DVec2;
use rayon::prelude::*;

/// A camera's light, sorted by what it is.
#[derive(Clone, Debug)]
pub struct Light {
    /// Spectral radiance: through the lens, the mean over each pixel's pupil; at the pupil, as seen from its centre
    /// in the stored geometry.
    pub radiance: Option<CubeEstimate<Radiance>>,
    /// Spectral irradiance on the sensor plane.
    pub irradiance: Option<SpectralCube<Irradiance>>,
    /// Its variance; `None` on the route at the pupil, where only the radiance's is known.
    pub irradiance_variance: Option<SpectralCube<Variance>>,
    /// The part of the irradiance that is ghosts, where the camera has them.
    pub ghosts: Option<SpectralCube<Irradiance>>,
    /// Mean electrons of each pixel in the first capture.
    pub electrons: Option<Plane<MeanElectrons>>,
    /// Those of the captures after it, each in the exposure of the first; empty where all captures see the same light.
    pub further_electrons: Vec<Plane<MeanElectrons>>,
    /// Their variance; `None` where they come from a cube.
    pub electrons_variance: Option<Plane<Variance>>,
}

impl Light {
    /// The light of a camera's film; at the pupil with the distances of its pixels, which its depth of field needs. Runs on
    /// the caller's pool.
    ///
    /// # Errors
    /// Where depth of field meets a radiance that is no finite number. (A compiled plan covers its own picture.)
    pub fn of_film(camera: &CameraPlan, film: Film, depth: Option<&PupilDepth>) -> Result<Self, OpticsError> {
        Self::seen(camera, film, depth).map(|light| light.exposed(&camera.body.exposure, Vec::new()))
    }

    /// The light of a camera whose captures see different light: films of the distinct captures
    /// ([`RowExposure::distinct_captures`]) in their order, or one that all of them see.
    ///
    /// # Errors
    /// As [`Light::of_film`].
    pub fn of_captures(camera: &CameraPlan, films: Vec<Film>, depth: Option<&PupilDepth>) -> Result<Self, OpticsError> {
        let rows = &camera.body.exposure;
        let mut lights =
            films.into_iter().map(|film| Self::seen(camera, film, depth)).collect::<Result<Vec<_>, _>>()?;
        let further = if lights.len() > 1 { further_electrons(rows, &lights) } else { Vec::new() };
        Ok(lights.swap_remove(0).exposed(rows, further))
    }

    /// The light of a film, rows exposed alike.
    fn seen(camera: &CameraPlan, film: Film, depth: Option<&PupilDepth>) -> Result<Self, OpticsError> {
        match &camera.settings.route {
            Route::Lens => Ok(Self::through_lens(&camera.body, film)),
            Route::Pupil(projection) => {
                let radiance = film.radiance().expect("the route at the pupil keeps a cube");
                let distance = depth.map(|depth| &depth.distance);
                let stored = Stored { projection, radiance: &radiance.mean, distance };
                let light = Self::of_stored(&camera.body, &stored, &camera.depth_of_field)?;
                Ok(Self { radiance: Some(radiance), ..light })
            }
        }
    }

    fn through_lens(body: &CameraBody, film: Film) -> Self {
        let radiance = film.radiance().map(|CubeEstimate { mean, variance }| CubeEstimate {
            mean: picture(body, mean),
            variance: picture(body, variance),
        });
        let behind = film.cube.map(|c| behind(body, c.mean, Some(c.variance)));
        let (irradiance, irradiance_variance, ghosts) = match behind {
            Some(EffectsOutput { irradiance, variance, ghosts }) => (Some(irradiance), variance, ghosts),
            None => (None, None, None),
        };
        let exposure_s = body.sensor.as_ref().map(|sensor| sensor.parameters().exposure.exposure_s);
        let exposed = film.electron_rate.zip(exposure_s).map(|(rate, exposure_s)| rate.exposed(exposure_s));
        let (folded, electrons_variance) = exposed.map(|e| (e.mean, e.variance)).unzip();
        let electrons = folded.or_else(|| electrons(body, irradiance.as_ref()?));
        let further_electrons = Vec::new();
        Self { radiance, irradiance, irradiance_variance, ghosts, electrons, further_electrons, electrons_variance }
    }

    /// The same with each row's own exposure, and with the electrons of `further` captures of rows exposed alike; where there are none, all see
    /// the light of the first.
    fn exposed(mut self, rows: &RowExposure, mut further: Vec<Plane<MeanElectrons>>) -> Self {
        if !rows.is_even() {
            let Some(first) = &mut self.electrons else { return self };
            if further.is_empty() {
                further = vec![first.clone(); rows.captures.len() - 1];
            }
            scale_rows(first, |row| rows.exposure_ratio(0, row));
            if let Some(variance) = &mut self.electrons_variance {
                scale_rows(variance, |row| rows.exposure_ratio(0, row) * rows.exposure_ratio(0, row));
            }
            for (i, plane) in further.iter_mut().enumerate() {
                scale_rows(plane, |row| rows.exposure_ratio(i + 1, row));
            }
        }
        Self { further_electrons: further, ..self }
    }

    /// What the captures of a frame see; `None` where the camera has no electronics.
    #[must_use]
    pub fn captures(&self) -> Option<CaptureLight<'_>> {
        self.electrons.as_ref().map(|first| CaptureLight { first, further: &self.further_electrons })
    }

    /// The light behind a lens of a stored radiance image (its radiance itself is not repeated).
    ///
    /// # Errors
    /// Where the picture needs directions that the image does not hold, or the radiance is no finite number.
    pub fn at_pupil(
        body: &CameraBody,
        stored: &Stored<'_>,
        depth_of_field: &DepthOfField,
    ) -> Result<Self, OpticsError> {
        Self::of_stored(body, stored, depth_of_field).map(|light| light.exposed(&body.exposure, Vec::new()))
    }

    fn of_stored(body: &CameraBody, stored: &Stored<'_>, depth_of_field: &DepthOfField) -> Result<Self, OpticsError> {
        front_on_picture(body)?;
        let seen = defocus::seen(stored, body, depth_of_field)?;
        let mut irradiance = irradiance(&seen, &body.lens, &body.film())?;
        if let Some(dirt) = body.front.as_ref().and_then(Front::dirt) {
            apply_dirt(&mut irradiance, dirt, body);
        }
        let EffectsOutput { irradiance, ghosts, .. } = behind(body, irradiance, None);
        Ok(Self {
            radiance: None,
            electrons: electrons(body, &irradiance),
            irradiance: Some(irradiance),
            irradiance_variance: None,
            ghosts,
            further_electrons: Vec::new(),
            electrons_variance: None,
        })
    }
}

/// Electrons of the captures after the first, of the lights of the distinct ones.
fn further_electrons(rows: &RowExposure, lights: &[Light]) -> Vec<Plane<MeanElectrons>> {
    let distinct = rows.distinct_captures();
    let same = |capture: usize| distinct.iter().position(|d| rows.captures[*d] == rows.captures[capture]);
    (1..rows.captures.len()).filter_map(|capture| lights[same(capture)?].electrons.clone()).collect()
}

/// Multiplies each row.
fn scale_rows<Q: Quantity<Sample = f32>>(plane: &mut Plane<Q>, by: impl Fn(usize) -> f64) {
    let width = plane.width();
    for (row, values) in plane.samples_mut().chunks_mut(width).enumerate() {
        let by = by(row);
        values.iter_mut().for_each(|value| *value = (f64::from(*value) * by) as f32);
    }
}

/// Each pixel by the mean of the dirt over its footprint.
fn apply_dirt(irradiance: &mut SpectralCube<Irradiance>, dirt: &Dirt, body: &CameraBody) {
    let (width, raster) = (irradiance.width(), body.film());
    let centre = |i: usize| raster.sensor_mm(DVec2::new((i % width) as f64, (i / width) as f64) + 0.5);
    let pixels = (0..width * irradiance.height()).into_par_iter();
    let shades: Vec<f64> = pixels.map(|i| dirt.shade(&body.lens, centre(i))).collect();
    for plane in irradiance.planes_mut() {
        plane.samples_mut().iter_mut().zip(&shades).for_each(|(e, shade)| *e = (f64::from(*e) * shade) as f32);
    }
}

/// Refuses what cannot be put on a stored radiance image: what bends rays in front of the lens.
pub(crate) fn front_on_picture(body: &CameraBody) -> Result<(), OpticsError> {
    match body.front.as_ref().and_then(|front| front.optic()) {
        None => Ok(()),
        Some(optic) => Err(OpticsError::FrontNeedsLens { what: optic.name() }),
    }
}

fn electrons(body: &CameraBody, irradiance: &SpectralCube<Irradiance>) -> Option<Plane<MeanElectrons>> {
    body.sensor.as_ref().map(|sensor| sensor.electrons(irradiance))
}

/// One frame out of the converter, and its picture.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Digital numbers.
    pub raw: Raw,
    /// What they are made of, where that was asked for.
    pub signal_breakdown: Option<SignalBreakdown>,
    /// The picture, where the camera makes one.
    pub picture: Option<Developed>,
}

/// The picture of the part of a raw that light reached, of numbers that are proportional to the reading, by the processing of
/// a camera. Runs on the caller's pool.
///
/// # Errors
/// Where the raw is not one of the camera's sensor.
pub fn developed(development: &Development, raw: &Raw, address: FrameAddress) -> Result<Developed, DevelopError> {
    let linear = raw.linear();
    let picture = RawPicture {
        plane: &linear.plane,
        black_level_dn: linear.black_level_dn,
        white_level_dn: linear.white_level_dn,
        mosaic: &development.mosaic,
        optical_black: linear.optical_black.as_ref(),
    };
    develop(&picture, &development.processing, address)
}

/// The picture of a frame of the camera's own, where it makes one.
fn own_picture(body: &CameraBody, raw: &Raw, address: FrameAddress) -> Option<Developed> {
    let development = body.development.as_ref()?;
    Some(developed(development, raw, address).expect("a compiled plan's processing fits its sensor"))
}

/// Takes one frame of `light`; the state is passed from frame to frame. `None` where the camera has no
/// electronics.
#[must_use]
pub fn take(
    body: &CameraBody,
    state: SensorState,
    light: CaptureLight<'_>,
    address: FrameAddress,
) -> Option<(SensorState, Frame)> {
    let (state, raw) = body.sensor.as_ref()?.step_captures(state, light, address);
    let picture = own_picture(body, &raw, address);
    Some((state, Frame { raw, signal_breakdown: None, picture }))
}

/// The same frame, with what each pixel's digital number is made of.
#[must_use]
pub fn take_with_breakdown(
    body: &CameraBody,
    state: SensorState,
    light: CaptureLight<'_>,
    address: FrameAddress,
) -> Option<(SensorState, Frame)> {
    let (state, raw, signal_breakdown) = body.sensor.as_ref()?.step_captures_with_breakdown(state, light, address);
    let picture = own_picture(body, &raw, address);
    Some((state, Frame { raw, signal_breakdown: Some(signal_breakdown), picture }))
}
