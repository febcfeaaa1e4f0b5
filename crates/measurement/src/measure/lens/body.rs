//! The measured camera: from a camera file, or built around a lens.

use std::path::{Path, PathBuf};

use etendue_core::maths::f64::sin_cos;
use etendue_io::failure::{Error, ErrorCode, InputError};
use etendue_io::{
    load_assets,
    prescription::{read_glass_catalogue, read_prescription_with},
    source::read_text,
};
use etendue_optics::Lens;
use etendue_pipeline::{compile_camera_with_remarks, plan::CameraBody};
use etendue_scene::asset::{GlassCatalogueAsset, LensFields, PrescriptionAsset};
use etendue_scene::{Overrides, load_camera, named_files};
use glam::{DVec2, DVec3};
use serde_json::Value;

use super::request::LensRequest;

/// Half of a full-frame diagonal, mm.
const FULL_FRAME_MM: f64 = 21.64;
/// An image radius that every lens illuminates, mm.
const SMALL_MM: f64 = 0.5;

/// A camera, and the notes on it.
pub(super) type MeasuredBody = (CameraBody, Vec<String>);

/// Returns the camera: of a camera file, or built around a lens file or a published lens.
pub(super) fn body(request: &LensRequest) -> Result<MeasuredBody, Error> {
    let lens_file = Path::new(&request.lens);
    if lens_file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        return match request.picture_radius_mm {
            None => compiled(request, lens_file, None),
            Some(_) => Err(Error::argument(
                "picture_radius_mm",
                "`picture_radius_mm`: the sensor of a camera file determines the image size; leave it out",
            )
            .with_code(ErrorCode::NoEffect)),
        };
    }
    let body_for_radius = |radius_mm: f64| {
        let text = generated_camera(&request.lens, radius_mm);
        compiled(request, &PathBuf::from(GENERATED_FILE), Some(text))
            .map_err(|failure| without_location(failure, &request.lens))
    };
    if let Some(radius_mm) = request.picture_radius_mm {
        return body_for_radius(radius_mm);
    }
    if !is_lens_file(&request.lens) {
        return body_for_radius(FULL_FRAME_MM);
    }
    let lens_of_radius = |radius_mm: f64| body_for_radius(radius_mm).map(|measured| measured.0.lens);
    let fields = read_prescription_with(lens_file, &glass_catalogues(request)?).ok().and_then(Fields::from_asset);
    let stated_mm = match fields {
        // The lens's first-order quantities do not depend on the size of its image.
        Some(fields) => fields.radius_mm(&lens_of_radius(SMALL_MM)?, lens_of_radius),
        None => None,
    };
    match stated_mm {
        Some(radius_mm) => body_for_radius(radius_mm),
        None => {
            let radius_mm = half_light_radius_mm(lens_of_radius)?;
            let (body, mut remarks) = body_for_radius(radius_mm)?;
            remarks.push(format!(
                "the file states no field: its image is measured up to {radius_mm:.3} mm from the axis, where half of the light of the axis arrives, at most \
                 {FULL_FRAME_MM} mm; `picture_radius_mm` sets another radius"
            ));
            Ok((body, remarks))
        }
    }
}

fn glass_catalogues(request: &LensRequest) -> Result<Vec<GlassCatalogueAsset>, Error> {
    let files = request.glasses.iter().map(|file| read_glass_catalogue(file));
    files.collect::<Result<_, _>>().map_err(|error| Error::inputs(vec![error]))
}

/// Factor between the radii that [`half_light_radius_mm`] tries.
const RADIUS_STEP: f64 = 1.25;
/// Bisections between two of them: 1/64 of the step.
const HALVINGS: usize = 6;

/// Distance from the axis at which half of the axis's light arrives, at most [`FULL_FRAME_MM`].
fn half_light_radius_mm(lens_of_radius: impl Fn(f64) -> Result<Lens, Error>) -> Result<f64, Error> {
    let is_lit = |radius_mm: f64| -> Result<bool, Error> {
        let lens = lens_of_radius(radius_mm)?;
        let light = |at_mm: f64| lens.projected_solid_angle_sr(DVec2::new(at_mm, 0.0));
        // The corner of the image may be nearer by the rounding of its pixel pitch.
        Ok(light(radius_mm * (1.0 - 1e-9)) >= 0.5 * light(0.0))
    };
    let mut lit_mm = SMALL_MM;
    let mut dark_mm = FULL_FRAME_MM;
    while lit_mm * RADIUS_STEP < FULL_FRAME_MM {
        if !is_lit(lit_mm * RADIUS_STEP)? {
            dark_mm = lit_mm * RADIUS_STEP;
            break;
        }
        lit_mm *= RADIUS_STEP;
    }
    for _ in 0..HALVINGS {
        let middle_mm = 0.5 * (lit_mm + dark_mm);
        *if is_lit(middle_mm)? { &mut lit_mm } else { &mut dark_mm } = middle_mm;
    }
    Ok(lit_mm)
}

fn compiled(request: &LensRequest, file: &Path, generated: Option<String>) -> Result<MeasuredBody, Error> {
    let f_number = request.f_number.map(|n| format!("lens.f_number={n}"));
    let paths: Vec<Value> = request.glasses.iter().map(|file| Value::from(file.to_string_lossy())).collect();
    let glasses = (!paths.is_empty()).then(|| format!("lens.glasses={}", Value::Array(paths)));
    let changes: Vec<String> = request.set.iter().cloned().chain(f_number).chain(glasses).collect();
    let overrides = Overrides::new(&changes);
    let read = |path: &Path| match &generated {
        Some(text) if path == file => Ok(text.clone()),
        _ => read_text(path),
    };
    let camera = load_camera(file, &read, &overrides).map_err(|f| Error::inputs(f.as_slice()))?;
    let assets = load_assets(&named_files::camera_files(&camera)).map_err(Error::inputs)?;
    compile_camera_with_remarks(&camera, &assets).map_err(Error::inputs)
}

/// File name of a camera built around a lens; no such file exists.
const GENERATED_FILE: &str = "measure.toml";

/// Reports errors of a generated camera against the lens, not against a line of text.
fn without_location(failure: Error, lens: &str) -> Error {
    let with_message = |error: InputError| match error
        .message
        .strip_prefix(GENERATED_FILE)
        .and_then(|rest| rest.splitn(4, ':').last())
    {
        Some(words) => InputError { file: Some(lens.into()), ..InputError::new(error.code, format!("{lens}:{words}")) },
        None => error,
    };
    match failure {
        Error::Input(errors) => Error::Input(errors.into_iter().map(with_message).collect()),
        run @ Error::Run(_) => run,
    }
}

fn is_lens_file(lens: &str) -> bool {
    [".zmx", ".seq"].iter().any(|extension| lens.to_ascii_lowercase().ends_with(extension))
}

/// Builds a camera around a lens without a sensor. Focus: that of a lens file; infinity for a published lens. The image is a
/// square with the requested radius; a lens with a smaller image circle is measured as far as it has light.
fn generated_camera(lens: &str, radius_mm: f64) -> String {
    const PIXELS: f64 = 1000.0;
    let pitch_um = 1000.0 * radius_mm * std::f64::consts::SQRT_2 / PIXELS;
    let (key, focus) =
        if is_lens_file(lens) { ("file", "") } else { ("published", "focus_distance_m = \"infinity\"\n") };
    let name = Value::from(lens);
    format!(
        "format = 1\n[lens]\ntype = \"prescription\"\n{key} = {name}\n{focus}[sensor]\n\
         width_px = {PIXELS}\nheight_px = {PIXELS}\npixel_pitch_um = {pitch_um}\n"
    )
}

/// The largest field that a lens file states.
#[derive(Clone, Copy, Debug)]
enum Fields {
    Angle { rad: f64 },
    Object { height_mm: f64, distance_mm: f64 },
    Image { height_mm: f64 },
}

impl Fields {
    fn from_asset(asset: PrescriptionAsset) -> Option<Self> {
        let largest = |list: &[f64]| list.iter().map(|x| x.abs()).reduce(f64::max).filter(|x| *x > 0.0);
        Some(match asset.fields.as_ref()? {
            LensFields::AnglesDeg(list) => Self::Angle { rad: largest(list)?.to_radians() },
            LensFields::ObjectMm(list) => {
                Self::Object { height_mm: largest(list)?, distance_mm: asset.object_distance_mm }
            }
            LensFields::ImageMm(list) => Self::Image { height_mm: largest(list)? },
        })
    }

    /// Returns its radius on the sensor: for an angle, where the lens images it; for an object height, from first order.
    fn radius_mm(self, lens: &Lens, build: impl Fn(f64) -> Result<Lens, Error>) -> Option<f64> {
        let f = lens.focal_length_mm();
        let radius_mm = match self {
            Self::Image { height_mm } => height_mm,
            Self::Object { height_mm, distance_mm } => {
                let Lens::Prescription(lens) = lens else { return None };
                height_mm * (f / (distance_mm + lens.prescription().paraxial().front_focus_mm)).abs()
            }
            Self::Angle { rad } => {
                let (sine, cosine) = sin_cos(rad);
                // An image that is large enough for the distortion of usual lenses.
                let rectilinear = if cosine > 0.0 { 1.3 * sine / cosine } else { f64::INFINITY };
                let wide = build(f * rectilinear.min(2.5 * rad)).ok()?;
                wide.project(DVec3::new(sine, 0.0, cosine))?.length()
            }
        };
        Some(radius_mm).filter(|r| r.is_finite() && *r > 0.0)
    }
}
