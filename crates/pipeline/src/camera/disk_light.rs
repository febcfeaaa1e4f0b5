//! Light of a camera from a film with bands on disk: the same values as from a film in memory, with the memory of a few planes.
//!
//! - Radiance is read from the film on request.
//! - Point spread and glare process band after band; the result is a scratch file of its own.
//! - On the pupil route some bands at a time pass through the lens, as many as [`GROUP_BYTES`] hold.
//! - Electrons are summed some rows at a time.
//! - Ghosts (which search their sources in all bands) and depth of field (whose outlines serve all bands) need all bands at once: they are read into
//!   memory, and processed like a film in memory.
//!
//! Light that neither is delivered nor contributes to a product is not computed.

use crate::camera::behind_lens::{dirt_shades, shaded};
use crate::camera::defocus::available_margin_px;
use crate::camera::effects::{EffectsOutput, apply_to_band, behind, picture};
use crate::camera::light::LightError;
use crate::camera::light::{Light, StoredEstimate};
use crate::camera::plane_cube::PlaneCube;
use crate::camera::stored::StoredRadianceImage;
use crate::plan::film::{needs_all_bands, needs_electrons, needs_irradiance};
use crate::plan::{CameraBody, CameraPlan, Route};
use crate::render::band_views::{BandsOverWeight, CroppedBands};
use crate::render::film::{Estimate, Film, scaled_plane};
use crate::render::pupil_depth::PupilDepth;
use crate::render::tiled_cube::TiledCube;
use etendue_core::quantity::{ElectronRate, Irradiance, Quantity, Radiance, SolidAngle, Variance};
use etendue_core::storage::ScratchStore;
use etendue_core::storage::{BandReader, CubeOnDisk};
use etendue_core::{Bands, Plane, StoredCube};
use etendue_optics::effects::FilmPart;
use etendue_optics::{BandEtendue, DepthOfField, PupilProjection, Resampling};
use std::sync::Arc;

/// Maximum bytes of the bands that pass through the lens together, unless a single band has more.
const GROUP_BYTES: usize = 1 << 29;

/// [`EffectsOutput`], in memory or on disk.
struct ScratchOutput {
    irradiance: StoredCube<Irradiance>,
    variance: Option<StoredCube<Variance>>,
    ghosts: Option<StoredCube<Irradiance>>,
}

impl From<EffectsOutput> for ScratchOutput {
    fn from(EffectsOutput { irradiance, variance, ghosts }: EffectsOutput) -> Self {
        Self {
            irradiance: irradiance.into(),
            variance: variance.map(StoredCube::from),
            ghosts: ghosts.map(StoredCube::from),
        }
    }
}

/// Light of a film with bands in `cube`, with all rows exposed equally.
///
/// # Errors
/// As [`Light::from_film`], and on disk errors.
pub(super) fn light_from_film(
    camera: &CameraPlan,
    film: Film,
    cube: &TiledCube,
    depth: Option<&PupilDepth>,
) -> Result<Light, LightError> {
    let (body, products) = (&camera.body, &camera.products);
    // Unnamed planes are dropped at once.
    let (weight, electron_rate) = (Arc::new(film.weight), film.electron_rate);
    drop((film.watched, film.samples, film.not_finite));
    let radiance = StoredEstimate {
        mean: bands_over_weight(cube, cube.mean(), &weight, |weight| weight),
        variance: bands_over_weight(cube, cube.variance(), &weight, |weight| weight * weight),
    };
    drop(weight);
    match &camera.settings.route {
        Route::Pupil(projection) => {
            let irradiance =
                needs_irradiance(camera).then(|| at_pupil(camera, projection, &radiance.mean, cube, depth));
            Ok(Light { radiance: Some(radiance), ..irradiance.transpose()?.unwrap_or_default() })
        }
        Route::Lens => {
            let StoredEstimate { mean, variance } = radiance;
            let of_image = |mean, variance| StoredEstimate { mean: part(body, mean), variance: part(body, variance) };
            let radiance = products.needs_radiance().then(|| of_image(mean, variance));
            let variance = (products.irradiance && products.variance).then(|| unchanged_bands(cube, cube.variance()));
            let film = unchanged_bands(cube, cube.mean());
            let light = Light { radiance, ..folded(camera, electron_rate) };
            match needs_irradiance(camera) {
                true => with_irradiance(
                    camera,
                    effects_on(body, body.effects.film_part(true), film, variance, cube.store())?,
                    light,
                ),
                false => Ok(light),
            }
        }
    }
}

/// Light behind the lens of a radiance at the pupil (without the radiance itself).
fn at_pupil(
    camera: &CameraPlan,
    projection: &PupilProjection,
    radiance: &StoredCube<Radiance>,
    cube: &TiledCube,
    depth: Option<&PupilDepth>,
) -> Result<Light, LightError> {
    if needs_all_bands(camera).is_some() {
        let radiance = radiance.clone().load().map_err(LightError::Scratch)?;
        let stored =
            StoredRadianceImage { projection, radiance: &radiance, distance: depth.map(|depth| &depth.distance) };
        return Ok(Light::from_stored(&camera.body, &stored, &camera.depth_of_field)?);
    }
    camera.body.check_front_on_picture()?;
    let body = &camera.body;
    let film = through_lens(body, projection, radiance, cube.store())?;
    let output = effects_on(body, body.effects.film_part(false), film, None, cube.store())?;
    with_irradiance(camera, output, Light::default())
}

/// Irradiance on the film of a radiance at the pupil without depth of field, some bands after the other.
fn through_lens(
    body: &CameraBody,
    projection: &PupilProjection,
    radiance: &StoredCube<Radiance>,
    store: &dyn ScratchStore,
) -> Result<StoredCube<Irradiance>, LightError> {
    let (bands, raster) = (radiance.bands(), body.film());
    let margin = body.whole_margin_px(available_margin_px(projection, body, bands, &DepthOfField::None)?);
    let resampling = Resampling::new(*projection, &body.lens, &body.raster, margin, bands)?;
    let etendue = BandEtendue::new(&body.lens, &raster);
    let transmittances = dirt_shades(body);
    let film = PlaneCube::new(store, bands, raster.width(), raster.height()).map_err(LightError::Scratch)?;
    let group = (GROUP_BYTES / (radiance.width() * radiance.height() * size_of::<f32>()).max(1)).max(1);
    for first in (0..bands.count()).step_by(group) {
        let of_group = first..(first + group).min(bands.count());
        let planes = of_group.clone().map(|band| radiance.plane(band).map(std::borrow::Cow::into_owned));
        let planes = planes.collect::<Result<Vec<_>, String>>().map_err(LightError::Scratch)?;
        let transmitted = resampling.apply_to_bands(&planes, |i| bands.centre_nm(first + i))?;
        drop(planes);
        for (band, plane_radiance) in of_group.zip(transmitted) {
            let mut plane = etendue.irradiance(&plane_radiance, bands.centre_nm(band))?;
            transmittances.iter().for_each(|transmittances| shaded(&mut plane, transmittances));
            film.write(band, &plane).map_err(LightError::Scratch)?;
        }
    }
    Ok(film.into_cube())
}

/// Result of a camera's effects on a film.
fn effects_on(
    body: &CameraBody,
    part: FilmPart,
    film: StoredCube<Irradiance>,
    variance: Option<StoredCube<Variance>>,
    store: &dyn ScratchStore,
) -> Result<ScratchOutput, LightError> {
    if body.effects.is_idle() {
        return Ok(ScratchOutput { irradiance: film, variance, ghosts: None });
    }
    if body.effects.ghosts().is_some() {
        let film = film.load().map_err(LightError::Scratch)?;
        let variance = variance.map(StoredCube::load).transpose().map_err(LightError::Scratch)?;
        return Ok(behind(body, part, film, variance).into());
    }
    by_band(body, part, &film, variance.as_ref(), store).map_err(LightError::Scratch)
}

/// Effects that process band after band.
fn by_band(
    body: &CameraBody,
    part: FilmPart,
    film: &StoredCube<Irradiance>,
    variance: Option<&StoredCube<Variance>>,
    store: &dyn ScratchStore,
) -> Result<ScratchOutput, String> {
    let bands = film.bands();
    let prepared = body.effects.prepared(&body.raster, bands.range(), part);
    let room = || PlaneCube::new(store, bands, body.raster.width(), body.raster.height());
    let (means, variances) = (room()?, variance.map(|_| room()).transpose()?);
    for band in 0..bands.count() {
        let of_variance = variance.map(|cube| cube.plane(band)).transpose()?;
        let (mean, of_variance) = apply_to_band(&prepared, bands, band, &*film.plane(band)?, of_variance.as_deref());
        means.write(band, &mean)?;
        if let (Some(to), Some(plane)) = (&variances, &of_variance) {
            to.write(band, plane)?;
        }
    }
    Ok(ScratchOutput { irradiance: means.into_cube(), variance: variances.map(PlaneCube::into_cube), ghosts: None })
}

/// Light with its irradiance, and the electrons computed from it.
fn with_irradiance(camera: &CameraPlan, output: ScratchOutput, light: Light) -> Result<Light, LightError> {
    let ScratchOutput { irradiance, variance, ghosts } = output;
    let (body, products) = (&camera.body, &camera.products);
    let sensor = body.sensor.as_ref().filter(|_| light.electrons.is_none() && needs_electrons(body, products));
    let computed = sensor.map(|sensor| sensor.electrons_of(&irradiance)).transpose().map_err(LightError::Scratch)?;
    let electrons = light.electrons.or(computed);
    Ok(Light { irradiance: Some(irradiance), irradiance_variance: variance, ghosts, electrons, ..light })
}

/// Electrons that pixels accumulated directly, and their variance if it is delivered.
fn folded(camera: &CameraPlan, rate: Option<Estimate<ElectronRate>>) -> Light {
    let Some((sensor, Estimate { mean, variance })) = camera.body.sensor.as_ref().zip(rate) else {
        return Light::default();
    };
    let exposure_s = sensor.parameters().exposure.exposure_s;
    let products = &camera.products;
    let of_variance =
        (products.electrons && products.variance).then(|| scaled_plane(variance, exposure_s * exposure_s));
    Light { electrons: Some(scaled_plane(mean, exposure_s)), electrons_variance: of_variance, ..Light::default() }
}

/// Bands of a film, unchanged.
fn unchanged_bands<Q: Quantity>(cube: &TiledCube, reader: &Arc<dyn BandReader>) -> StoredCube<Q> {
    let (width, height) = cube.size();
    cube_on_disk(cube.bands(), width, height, Arc::clone(reader))
}

fn cube_on_disk<Q: Quantity>(bands: Bands, width: usize, height: usize, reader: Arc<dyn BandReader>) -> StoredCube<Q> {
    StoredCube::Disk(CubeOnDisk::new(bands, width, height, reader))
}

/// Bands of a film divided by the pupil's weight.
fn bands_over_weight<Q: Quantity>(
    cube: &TiledCube,
    reader: &Arc<dyn BandReader>,
    weight: &Arc<Plane<SolidAngle>>,
    divisor: fn(f32) -> f32,
) -> StoredCube<Q> {
    let view = BandsOverWeight { bands: Arc::clone(reader), weight: Arc::clone(weight), divisor };
    let (width, height) = cube.size();
    cube_on_disk(cube.bands(), width, height, Arc::new(view))
}

/// Image part of a film.
fn part<Q: Quantity<Sample = f32>>(body: &CameraBody, film: StoredCube<Q>) -> StoredCube<Q> {
    let (bands, whole_width) = (film.bands(), film.width());
    match film {
        StoredCube::Memory(cube) => picture(body, cube).into(),
        StoredCube::Disk(cube) if body.effects.margin_px() == [0, 0] => StoredCube::Disk(cube),
        StoredCube::Disk(cube) => {
            let (width, height) = (body.raster.width(), body.raster.height());
            let of = Arc::clone(cube.reader());
            let part = CroppedBands { bands: of, full_width: whole_width, first: body.effects.margin_px(), width };
            cube_on_disk(bands, width, height, Arc::new(part))
        }
    }
}
