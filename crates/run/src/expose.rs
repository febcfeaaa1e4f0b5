//! Exposes stored radiance with another lens and sensor.

use crate::result_files::ResultFiles;
use crate::results::frames::{FrameProducts, frames, write_frames};
use crate::results::metadata;
use crate::results::writer::ResultWriter;
use clap::Args;
use etendue_arguments::seed;
use etendue_core::observer::{Message, Observer};
use etendue_core::quantity::{Length, Radiance, Variance};
use etendue_core::{Plane, SpectralCube};
use etendue_io::exr::{SpectralImage, read_spectral};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::paths::camera_stem;
use etendue_io::{ExistingFiles, OutputFolder, Provenance};
use etendue_optics::{DepthOfField, FastBlend, FastParameters, OpticsError, PupilProjection};
use etendue_pipeline::defocus::available_margin_px;
use etendue_pipeline::photograph::Light;
use etendue_pipeline::plan::{CameraBody, Products, default_raw_format};
use etendue_pipeline::stored;
use etendue_plan_report::{camera_facts, open_camera};
use etendue_sensor::{FrameAddress, SensorState};
use serde_json::json;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A stored radiance image and the camera that exposes it.
#[derive(Args, Clone, Debug)]
pub struct ExposeRequest {
    /// A spectral radiance image rendered with route = "pupil"
    #[arg(value_name = "RADIANCE.exr")]
    pub radiance: PathBuf,
    /// The camera file (TOML)
    #[arg(long, value_name = "CAMERA.toml")]
    pub camera: PathBuf,
    /// Change a key of the camera file, e.g. --set sensor.exposure_s=0.002
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Seed of the sensor's noise [default: that of the radiance image]
    #[arg(long, value_name = "N", value_parser = seed)]
    pub seed: Option<u64>,
    /// Frames to take, first to last (the last excluded); each has its own sensor noise
    #[arg(long, value_name = "A..B", value_parser = etendue_arguments::frames, default_value = "0..1")]
    pub frames: Range<u32>,
    /// Blur of objects out of focus: physical, none, or an artistic setting, e.g. fast:blur_px=8,near_m=0.5..2,far_m=10..40 [default: physical]
    #[arg(long, value_name = "METHOD", value_parser = blur_method)]
    pub depth_of_field: Option<DepthOfField>,
}

impl ExposeRequest {
    /// One frame with the seed of the image and physical blur.
    pub fn new(radiance: impl Into<PathBuf>, camera: impl Into<PathBuf>) -> Self {
        let (radiance, camera) = (radiance.into(), camera.into());
        Self { radiance, camera, set: Vec::new(), seed: None, frames: 0..1, depth_of_field: None }
    }
}

/// Exposes a stored radiance image with another lens and sensor. Writes the files into a folder and returns their paths. Runs on the caller's thread pool.
///
/// # Errors
/// The image or the camera cannot be used, the camera looks outside the image, or the folder cannot be written.
pub fn expose(
    request: &ExposeRequest,
    folder: &Path,
    existing: ExistingFiles,
    observer: &dyn Observer,
) -> Result<Vec<PathBuf>, Error> {
    let body = open_camera(&request.camera, &request.set)?;
    let stored = StoredRadiance::open(&request.radiance)?;
    check_shutter(&body, &stored, request, observer)?;
    let name = camera_stem(&request.camera);
    let mut folder = OutputFolder::open_part(folder, &name, existing).map_err(Error::input)?;
    let files = ResultFiles::for_products(&products(&body), &body, &request.frames);
    let claimed = files.keys().map(String::as_str).chain([ResultFiles::SIDECAR]);
    let claimed: Vec<String> = claimed.map(|file| format!("{name}/{file}")).collect();
    folder.claim(claimed.iter().map(String::as_str)).map_err(Error::input)?;
    write(&body, &stored, request, observer, &mut ResultWriter { prefix: name, folder: &mut folder })?;
    folder.commit().map_err(Error::run)
}

/// Refuses a rolling shutter where light depends on time, because the image holds a single exposure for all rows. Warns if the camera's exposure differs from
/// the image's.
fn check_shutter(
    body: &CameraBody,
    stored: &StoredRadiance,
    request: &ExposeRequest,
    observer: &dyn Observer,
) -> Result<(), Error> {
    let Some(stored_s) = stored.exposure_s() else { return Ok(()) };
    let (radiance, camera) = (request.radiance.display(), request.camera.display());
    if !body.exposure.is_global() {
        return Err(Error::coded(
            ErrorCode::NotModelled,
            format!(
                "{radiance} through {camera}: its light depends on time and is the mean over one exposure of \
             {stored_s} s, but the camera has a rolling shutter; give it a \"global\" shutter, or render the job \
             through the lens"
            ),
        ));
    }
    let exposure = &body.exposure;
    if exposure.exposure_s != stored_s || exposure.distinct_captures().len() > 1 {
        observer.message(Message::Warning(&format!(
            "{radiance}: its light depends on time and is the mean over {stored_s} s; motion and flicker remain \
             those of that exposure, whatever the exposure of {camera}"
        )));
    }
    Ok(())
}

/// All products that the camera can make from the light.
fn products(body: &CameraBody) -> Products {
    Products {
        irradiance: true,
        ghosts: body.effects.ghosts().is_some(),
        raw: body.sensor.is_some(),
        raw_format: default_raw_format(body.sensor.as_ref()),
        picture: body.development.is_some(),
        ..Products::default()
    }
}

fn write(
    body: &CameraBody,
    stored: &StoredRadiance,
    request: &ExposeRequest,
    observer: &dyn Observer,
    writer: &mut ResultWriter<'_>,
) -> Result<(), Error> {
    let StoredRadiance { radiance, projection, distance, .. } = stored;
    let at_pupil = stored::StoredRadianceImage { projection, radiance, distance: distance.as_ref() };
    let refuse = |error: OpticsError| {
        let (radiance, camera) = (request.radiance.display(), request.camera.display());
        Error::coded(ErrorCode::UnsuitableFile, format!("{radiance} through {camera}: {error}{}", margin(body)))
    };
    let depth_of_field = depth_of_field(body, stored, request, observer)?;
    warn_of_margin(body, stored, &depth_of_field, observer).map_err(refuse)?;
    let light = Light::at_pupil(body, &at_pupil, &depth_of_field).map_err(refuse)?;
    let seed = request.seed.unwrap_or(stored.provenance.seed);
    let facts = metadata::exposed_provenance(&stored.provenance, &writer.prefix, seed);
    writer.irradiance(ResultFiles::IRRADIANCE, &light, false, &facts)?;
    writer.ghosts(ResultFiles::GHOSTS, &light, &facts)?;
    let mut points = Vec::new();
    if let Some(captures) = light.captures() {
        let address = |frame| FrameAddress { seed, camera: stored.camera_index(), frame, capture: 0 };
        let products = products(body);
        let frame_products = FrameProducts {
            products: &products,
            camera: &writer.prefix.clone(),
            facts: &facts,
            undistorted: None,
            one_by_one: false,
            observer,
        };
        let frames_taken = frames(body, captures, request.frames.clone(), SensorState::default(), address, false);
        points = write_frames(body, frames_taken, address, frame_products, writer)?;
    }
    let mut facts = sidecar(body, stored, request, seed, &depth_of_field);
    facts["frames"] = points.into();
    writer.json(ResultFiles::SIDECAR, &facts)
}

/// Describes the margin that the camera's effects need outside its image; empty if they need none.
fn margin(body: &CameraBody) -> String {
    match body.effects.margin_px() {
        [0, 0] => String::new(),
        [x, y] => format!(
            "; the camera's [effects] need {x} columns and {y} rows beyond its image: give them a smaller \
             \"margin\", or render with more \"overscan\""
        ),
    }
}

/// The requested depth of field; by default the physical one as far as lens and image allow.
fn depth_of_field(
    body: &CameraBody,
    stored: &StoredRadiance,
    request: &ExposeRequest,
    observer: &dyn Observer,
) -> Result<DepthOfField, Error> {
    let blurs = body.lens.entrance_pupil_radius_m() > 0.0;
    let file = request.radiance.display();
    match request.depth_of_field {
        Some(DepthOfField::None) => Ok(DepthOfField::None),
        Some(_) if stored.distance.is_none() => Err(Error::coded(
            ErrorCode::UnsuitableFile,
            format!(
                "{file}: it has no distances (channel distance.Z), which depth of field needs: render it again, or \
             give `depth_of_field` none"
            ),
        )),
        Some(DepthOfField::Physical) if !blurs => Err(Error::argument(
            "depth_of_field",
            format!("`depth_of_field` physical has no effect: the lens of {} has no defocus", request.camera.display()),
        )
        .with_code(ErrorCode::NoEffect)),
        Some(requested) => Ok(requested),
        None if blurs && stored.distance.is_some() => Ok(DepthOfField::Physical),
        None => {
            if blurs {
                let sentence = format!("{file} has no distances (channel distance.Z): defocus is omitted");
                observer.message(Message::Warning(&sentence));
            }
            Ok(DepthOfField::None)
        }
    }
}

/// Warns where blur from outside the image is cut off.
fn warn_of_margin(
    body: &CameraBody,
    stored: &StoredRadiance,
    depth_of_field: &DepthOfField,
    observer: &dyn Observer,
) -> Result<(), OpticsError> {
    let needed = body.blur_margin_px(depth_of_field);
    let available = available_margin_px(&stored.projection, body, stored.radiance.bands(), depth_of_field)?;
    if available < needed {
        observer.message(Message::Warning(&format!(
            "depth of field needs {needed} px around the image, but the file has {available}: blur is cut off at its \
             edges; render with more overscan"
        )));
    }
    Ok(())
}

fn sidecar(
    body: &CameraBody,
    stored: &StoredRadiance,
    request: &ExposeRequest,
    seed: u64,
    depth_of_field: &DepthOfField,
) -> serde_json::Value {
    json!({
        "program": "etendue",
        "version": metadata::VERSION,
        "seed": seed,
        "camera_index": stored.camera_index(),
        "radiance": {
            "plan_hash": stored.provenance.plan_hash,
            "version": stored.provenance.version,
            "camera": stored.provenance.camera,
        },
        "pose": { "camera_to_world": stored.provenance.camera_to_world },
        "optics": camera_facts::optics(body),
        "effects": camera_facts::effects(body),
        "sensor": camera_facts::sensor(body),
        "route": "pupil",
        "sampling": { "correlated_block_px": stored.correlated_block_px() },
        "depth_of_field": camera_facts::depth_of_field(depth_of_field),
        "files": ResultFiles::for_products(&products(body), body, &request.frames),
        "time_s": stored.provenance.time_s,
    })
}

/// A stored radiance image with its geometry.
pub(crate) struct StoredRadiance {
    pub(crate) radiance: SpectralCube<Radiance>,
    /// Variance of its band means, where it is stored.
    pub(crate) variance: Option<SpectralCube<Variance>>,
    /// Distance of the surface that each pixel sees; `None` in files of earlier versions.
    pub(crate) distance: Option<Plane<Length>>,
    pub(crate) projection: PupilProjection,
    pub(crate) provenance: Provenance,
}

impl StoredRadiance {
    /// Reads the image and its geometry.
    ///
    /// # Errors
    /// The file is not radiance at the pupil rendered by etendue.
    pub(crate) fn open(path: &Path) -> Result<Self, Error> {
        let refuse = |why: &str| Error::coded(ErrorCode::UnsuitableFile, format!("{}: {why}", path.display()));
        let file = read_spectral(path).map_err(Error::input)?;
        let SpectralImage::Radiance(image) = file.image else {
            return Err(refuse("this is irradiance behind a lens; expected radiance, rendered with route = \"pupil\""));
        };
        let remedy = "its geometry is not stated; expected radiance that etendue rendered with route = \"pupil\"";
        let provenance = file.provenance.ok_or_else(|| refuse(remedy))?;
        let radiance = image.cube;
        let through_lens = "it was rendered through a lens; render it with `set` render.route=pupil to expose it";
        let geometry = metadata::pupil_geometry(&provenance, radiance.width(), radiance.height());
        let projection = geometry.ok_or_else(|| refuse(through_lens))?.map_err(|why| refuse(&why))?;
        Ok(Self { radiance, variance: image.variance, distance: file.distance, projection, provenance })
    }

    /// Index, within its job, of the camera that rendered the image; 0 in files of earlier versions.
    pub(crate) fn camera_index(&self) -> u32 {
        self.provenance.further.get("camera_index").and_then(|i| i.parse().ok()).unwrap_or(0)
    }

    /// Exposure time over which time-dependent light was accumulated; `None` for constant light.
    pub(crate) fn exposure_s(&self) -> Option<f64> {
        self.provenance.further.get(metadata::EXPOSURE_S).and_then(|s| s.parse().ok())
    }

    /// Number of pixels of a block whose errors may be correlated.
    pub(crate) fn correlated_block_px(&self) -> u32 {
        self.provenance.further.get("correlated_block_px").and_then(|n| n.parse().ok()).unwrap_or(1)
    }
}

fn blur_method(text: &str) -> Result<DepthOfField, String> {
    match text.split_once(':') {
        None if text == "physical" => Ok(DepthOfField::Physical),
        None if text == "none" => Ok(DepthOfField::None),
        Some(("fast", keys)) => blend(keys).map(DepthOfField::Fast),
        _ => Err(format!("expected physical, none or fast:blur_px=…, not '{text}'")),
    }
}

fn blend(keys: &str) -> Result<FastBlend, String> {
    let (mut near, mut distant, mut blur_px) = (None, None, None);
    for pair in keys.split(',') {
        let expected = || format!("expected blur_px=NUMBER, near_m=FROM..TO or far_m=FROM..TO, not '{pair}'");
        let number = |text: &str| text.trim().parse::<f64>().map_err(|_| expected());
        let (key, value) = pair.split_once('=').ok_or_else(expected)?;
        let range = || {
            let (from, to) = value.split_once("..").ok_or_else(expected)?;
            Ok::<_, String>((number(from)?, number(to)?))
        };
        match key.trim() {
            "blur_px" => blur_px = Some(number(value)?),
            "near_m" => near = Some(range()?),
            "far_m" => distant = Some(range()?),
            _ => return Err(expected()),
        }
    }
    let blur_px = blur_px.ok_or("the diameter of the blur is missing: add blur_px=NUMBER")?;
    if near.is_none() && distant.is_none() {
        return Err("this blurs nothing: add near_m=FROM..TO or far_m=FROM..TO".to_owned());
    }
    let (blurred_near_m, sharp_near_m) = near.unwrap_or((0.0, 0.0));
    let (sharp_far_m, blurred_far_m) = distant.unwrap_or((f64::INFINITY, f64::INFINITY));
    let parameters = FastParameters { sharp_near_m, sharp_far_m, blurred_near_m, blurred_far_m, blur_px };
    FastBlend::new(parameters).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_of_field_is_a_word_or_a_look_with_numbers() {
        assert_eq!(blur_method("physical"), Ok(DepthOfField::Physical));
        assert_eq!(blur_method("none"), Ok(DepthOfField::None));
        let parametric = blur_method("fast:blur_px=8,far_m=10..40");
        let Ok(DepthOfField::Fast(blend)) = parametric else { panic!("{parametric:?}") };
        let p = blend.parameters();
        assert_eq!((p.blur_px, p.sharp_near_m, p.sharp_far_m, p.blurred_far_m), (8.0, 0.0, 10.0, 40.0));
        let wrong = [
            "fast",
            "fast:",
            "fast:blur_px=8",
            "fast:far_m=10..40",
            "fast:blur=8",
            "sharp",
            "fast:blur_px=8,far_m=10",
            "fast:blur_px=8,far_m=40..10",
        ];
        assert!(wrong.iter().all(|text| blur_method(text).is_err()));
    }
}
