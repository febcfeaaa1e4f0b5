//! Weather applied to stored radiance.

use crate::expose::StoredRadiance;
use crate::results::metadata;
use clap::Args;
use etendue_core::quantity::Variance;
use etendue_core::{CameraPose, Plane, SpectralCube, TimeInterval};
use etendue_io::exr::{EncodeError, LengthPlanes, encode_plane, encode_radiance, encode_spectral};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::source::read_text;
use etendue_io::{ExistingFiles, OutputFolder, load_assets};
use etendue_pipeline::compile_weather;
use etendue_pipeline::plan::Weather;
use etendue_pipeline::stored::StoredRadianceImage;
use etendue_pipeline::weather::WeatheredImage;
use etendue_scene::{load_weather, named_files};
use std::path::{Path, PathBuf};

/// A stored radiance image and the weather to apply.
#[derive(Args, Clone, Debug)]
pub struct WeatherRequest {
    /// A spectral radiance image rendered with route = "pupil"
    #[arg(value_name = "RADIANCE.exr")]
    pub radiance: PathBuf,
    /// The weather file (TOML): fog, rain or snow, and the radiance of the air
    #[arg(long, value_name = "WEATHER.toml")]
    pub weather: PathBuf,
}

/// Radiance as seen through the weather, which can be exposed.
const RADIANCE: &str = "radiance.exr";
/// Fraction of the scene's light that is transmitted.
const TRANSMITTANCE: &str = "transmittance.exr";
/// The radiance that the weather adds.
const AIRLIGHT: &str = "airlight.exr";

/// Fraction of each pixel and of the exposure that near drops or flakes cover.
const COVER: &str = "cover.exr";

/// Applies fog and streaks of rain or snow to a stored radiance image by its distances. Writes radiance, transmittance and airlight, and cover if there is
/// precipitation, into a folder and returns their paths. Runs on the caller's thread pool.
///
/// # Errors
/// The image or the weather cannot be used, or the folder cannot be written.
pub fn weather(request: &WeatherRequest, folder: &Path, existing: ExistingFiles) -> Result<Vec<PathBuf>, Error> {
    let weather = open(&request.weather)?;
    let mut stored = StoredRadiance::open(&request.radiance)?;
    expose(&weather, &mut stored, request)?;
    let mut folder = OutputFolder::open(folder, existing).map_err(Error::input)?;
    folder.claim([RADIANCE, TRANSMITTANCE, AIRLIGHT]).map_err(Error::input)?;
    if weather.falling.is_some() {
        folder.claim([COVER]).map_err(Error::input)?;
    }
    let weathered = apply_weather(&weather, &stored, &request.radiance)?;
    for (name, bytes) in files(&weathered, &stored) {
        let bytes = bytes.map_err(|error| Error::Run(format!("{name}: {error}")))?;
        folder.write(name, &bytes).map_err(Error::run)?;
    }
    folder.commit().map_err(Error::run)
}

/// Records the exposure of streaks in the image, as for time-dependent light. If the image states an exposure, it must be equal.
fn expose(weather: &Weather, stored: &mut StoredRadiance, request: &WeatherRequest) -> Result<(), Error> {
    let Some(falling) = &weather.falling else { return Ok(()) };
    let exposure_s = falling.exposure_s;
    if let Some(stored_s) = stored.exposure_s().filter(|stored_s| *stored_s != exposure_s) {
        return Err(Error::coded(
            ErrorCode::Contradiction,
            format!(
                "{}: \"exposure_s\" is {exposure_s} s, but the light of {} is the mean over {stored_s} s; give {stored_s}, or an image of light that \
             does not depend on time",
                request.weather.display(),
                request.radiance.display()
            ),
        ));
    }
    stored.provenance.further.insert(metadata::EXPOSURE_S.to_owned(), exposure_s.to_string());
    Ok(())
}

fn open(file: &Path) -> Result<Weather, Error> {
    let record = load_weather(file, &read_text).map_err(|f| Error::inputs(f.as_slice()))?;
    let assets = load_assets(&named_files::weather_files(&record)).map_err(Error::inputs)?;
    compile_weather(&record, &assets).map_err(Error::inputs)
}

fn apply_weather(weather: &Weather, stored: &StoredRadiance, file: &Path) -> Result<WeatheredImage, Error> {
    let refuse = |why: &str| Error::coded(ErrorCode::UnsuitableFile, format!("{}: {why}", file.display()));
    let pose = stored.provenance.camera_to_world.as_ref().map(CameraPose::from_rows).ok_or_else(|| {
        refuse("it does not state the position of its camera, which the weather needs; render it with a camera that does not move")
    })?;
    let moment = TimeInterval::at(stored.provenance.time_s)
        .ok_or_else(|| refuse("its time is not finite; expected radiance that etendue rendered"))?;
    let image = StoredRadianceImage {
        projection: &stored.projection,
        radiance: &stored.radiance,
        distance: stored.distance.as_ref(),
    };
    weather.apply(&image, &pose, moment).map_err(|why| refuse(&why.to_string()))
}

fn files(weathered: &WeatheredImage, stored: &StoredRadiance) -> Vec<(&'static str, Result<Vec<u8>, EncodeError>)> {
    let facts = &stored.provenance;
    let variance = stored.variance.as_ref().map(|variance| attenuated_variance(variance, weathered));
    let lengths = stored.distance.as_ref().map(|distance| LengthPlanes { distance, depth: &weathered.depth });
    let mut files = vec![
        (RADIANCE, encode_radiance(&weathered.radiance, variance.as_ref(), lengths, facts)),
        (TRANSMITTANCE, encode_spectral(&weathered.transmittance, None, facts)),
        (AIRLIGHT, encode_spectral(&weathered.airlight, None, facts)),
    ];
    files.extend(weathered.cover.as_ref().map(|cover| (COVER, encode_plane(cover, None, facts))));
    files
}

/// Variance scales with the square of the transmittance; the variance of an airlight from the sky is not added.
fn attenuated_variance(variance: &SpectralCube<Variance>, weathered: &WeatheredImage) -> SpectralCube<Variance> {
    let mut dimmed = variance.clone();
    for (plane, transmittances) in dimmed.planes_mut().iter_mut().zip(weathered.transmittance.planes()) {
        let samples: Vec<f32> = plane
            .samples()
            .iter()
            .zip(transmittances.samples())
            .map(|(variance, transmittance)| variance * transmittance * transmittance)
            .collect();
        *plane = Plane::from_samples(transmittances.width(), transmittances.height(), samples)
            .expect("as many samples as pixels");
    }
    dimmed
}
