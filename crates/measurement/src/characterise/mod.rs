//! A camera from a laboratory folder: dark frames, flats, views of a chart, slanted edges, a ColorChecker, each optional.
//!
//! The measurements are those of [`measure`](crate::measure), in sequence. Each result goes into one camera file with its
//! standard uncertainty; unknown quantities are reported with the reason. docs/characterise.md describes the layout of a folder.

mod base;
mod camera;
mod checks;
mod colour;
mod electronics;
mod fall_off;
mod folder;
mod geometry;
mod identity;
mod page;
mod parameter;
mod point_picture;
mod shot;
mod spread;

use std::path::{Path, PathBuf};

use clap::Args;
use etendue_arguments::toml;
use etendue_core::observer::{Message, Observer};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::{ExistingFiles, OutputFolder, paths::relative_path};
use serde_json::{Map, Value, json};

use crate::report::{finite, json_estimate};
use camera::{CameraFile, CharacterisationResults, camera_file};
use folder::Laboratory;
use parameter::Findings;
use point_picture::PointSpreadImage;

pub use parameter::{ImageKind, Parameter, PartialReport, UndeterminedQuantity};

/// `etendue characterise`
#[derive(Args, Clone, Debug)]
pub struct CharacteriseRequest {
    /// Laboratory folder: folders dark, flat, field, chart, edges and checker with images, each optional, and laboratory.toml for
    /// facts that the images do not state
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
    /// Camera file to extend: supplies what is not measured
    #[arg(long, value_name = "CAMERA.toml", value_parser = toml, display_order = 2)]
    pub base: Option<PathBuf>,
}

impl CharacteriseRequest {
    /// Creates a request with the program's defaults.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), base: None }
    }
}

/// Results of the characterisation of a camera.
pub struct Characterisation {
    laboratory: Laboratory,
    base: Option<PathBuf>,
    findings: Findings,
    results: CharacterisationResults,
}

/// Measures a camera from the images of a laboratory folder. Runs on the caller's thread pool.
///
/// # Errors
/// If the folder cannot be used (unreadable images, images of several cameras, copies, saturated flat fields), or if nothing at
/// all can be determined.
pub fn characterise(request: &CharacteriseRequest, observer: &dyn Observer) -> Result<Characterisation, Error> {
    let base_camera = request.base.as_deref().map(|file| base::open(file).map(|camera| (file, camera))).transpose()?;
    let laboratory = Laboratory::open(&request.folder, observer)?;
    let (mut findings, mut results) = (Findings::default(), CharacterisationResults::default());
    let f = &mut findings;
    results.electronics = electronics::measure(&laboratory, f, observer)?;
    let electronics = results.electronics.as_ref();
    results.fall_off = fall_off::measure(&laboratory, electronics, f)?;
    results.geometry = geometry::measure(&laboratory, f, observer)?;
    results.spread = spread::measure(&laboratory, f)?;
    results.colour = colour::measure(&laboratory, electronics, f)?;
    if let Some((file, camera)) = &base_camera {
        base::refuse_what_is_measured(file, camera, &results)?;
    } else if results.colour.is_some() {
        f.unknown(
            "white balance and colour matrix of the camera file",
            "they depend on the spectral responsivities, which light of one wavelength does not determine; extend a camera file that has them (`base`)",
        );
    }
    let lens = [ImageKind::Field, ImageKind::Chart, ImageKind::Edges, ImageKind::Checker];
    results.exposure_s = lens.iter().find_map(|kind| laboratory.shots(*kind).first()?.exposure_s);
    if findings.parameters.is_empty() {
        let reasons: Vec<String> = findings.unknown.iter().map(|u| format!("{}: {}", u.quantity, u.reason)).collect();
        return Err(Error::all_coded(
            ErrorCode::NotMeasurable,
            [vec![format!("{}: no property of the camera can be determined", request.folder.display())], reasons]
                .concat(),
        ));
    }
    for unknown in &findings.unknown {
        observer.message(Message::Note(&format!("not known: {}: {}", unknown.quantity, unknown.reason)));
    }
    Ok(Characterisation { laboratory, base: request.base.clone(), findings, results })
}

/// Refuses output files that exist and may not be replaced, before anything is measured.
///
/// # Errors
/// If a file that [`Characterisation::save`] would write exists, or the folder cannot be written.
pub fn claim(file: &Path, existing: ExistingFiles) -> Result<(), Error> {
    let folder = OutputFolder::open_beside(parent(file), existing).map_err(Error::input)?;
    let names = ENDINGS.map(|ending| format!("{}{ending}", etendue_io::paths::camera_stem(file)));
    folder.claim(names.iter().map(String::as_str)).map_err(Error::input)
}

/// Endings of the output files, after the stem.
const ENDINGS: [&str; 4] = [".toml", ".json", ".html", "-psf.png"];

fn parent(file: &Path) -> &Path {
    file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

impl Characterisation {
    /// The measured parameters.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.findings.parameters
    }

    /// Quantities that could not be determined, with the reasons.
    #[must_use]
    pub fn unknown(&self) -> &[UndeterminedQuantity] {
        &self.findings.unknown
    }

    /// The measurements.
    #[must_use]
    pub fn parts(&self) -> &[PartialReport] {
        &self.findings.parts
    }

    /// Writes the camera file and, under the same stem, the report as a page (`.html`) and as JSON (`.json`), and the point-spread
    /// image that the camera file names, if any (`-psf.png`). Returns their paths.
    ///
    /// # Errors
    /// If a file exists and may not be replaced, or cannot be written.
    pub fn save(&self, file: &Path, existing: ExistingFiles) -> Result<Vec<PathBuf>, Error> {
        self.save_spelled(file, existing, &str::to_owned)
    }

    /// Same as [`Self::save`], for a front end that spells the names of arguments in backticks in the texts.
    ///
    /// # Errors
    /// If a file exists and may not be replaced, or cannot be written.
    pub fn save_spelled(
        &self,
        file: &Path,
        existing: ExistingFiles,
        spelling: &dyn Fn(&str) -> String,
    ) -> Result<Vec<PathBuf>, Error> {
        let stem = etendue_io::paths::camera_stem(file);
        let parent = parent(file);
        let point_spread = self.point_spread_image();
        let picture_name = format!("{stem}{}", ENDINGS[3]);
        let mut folder = OutputFolder::open_beside(parent, existing).map_err(Error::input)?;
        let base = self.base.as_deref().map(|base| named_from(parent, base)).transpose()?;
        let camera = camera_file(
            &self.laboratory,
            &self.results,
            base.as_deref(),
            point_spread.as_ref().map(|p| (&*picture_name, p)),
        );
        base::check(&parent.join(format!("{stem}{}", ENDINGS[0])), &camera.text)?;
        let mut files = vec![
            (format!("{stem}{}", ENDINGS[0]), spelling(&camera.text).into_bytes()),
            (format!("{stem}{}", ENDINGS[1]), spelling(&format!("{:#}\n", self.json(&camera))).into_bytes()),
            (format!("{stem}{}", ENDINGS[2]), spelling(&self.page(&camera)).into_bytes()),
        ];
        if let Some(point_spread) = point_spread {
            files.push((picture_name, point_spread.png()?));
        }
        folder.claim(files.iter().map(|(name, _)| name.as_str())).map_err(Error::input)?;
        files.iter().try_for_each(|(name, bytes)| folder.write(name, bytes)).map_err(Error::run)?;
        folder.commit().map_err(Error::run)
    }

    fn point_spread_image(&self) -> Option<PointSpreadImage> {
        let pitch_um = self.laboratory.camera.pixel_pitch_um.unwrap_or(identity::PLACEHOLDER_PITCH_UM);
        PointSpreadImage::from_spread(&self.results.spread?, pitch_um)
    }

    /// The report: parameters, unknown quantities, and every measurement as `etendue measure` prints it.
    fn json(&self, camera: &CameraFile) -> Value {
        let parameter = |p: &Parameter| {
            let mut value_json = json_estimate(p.value);
            value_json["expanded_uncertainty_95"] = finite(2.0 * p.value.standard_uncertainty);
            value_json["unit"] = p.unit.into();
            value_json["label"] = p.label.as_str().into();
            value_json["from"] = p.image_kind.folder().into();
            (p.key.clone(), value_json)
        };
        let unknown = |u: &UndeterminedQuantity| json!({ "what": u.quantity, "why": u.reason });
        json!({
            "program": "etendue",
            "camera": self.laboratory.camera.name,
            "pictures": ImageKind::ALL.map(|kind| (kind.folder().to_owned(), self.laboratory.shots(kind).len().into())).into_iter().collect::<Map<_, _>>(),
            "parameters": self.findings.parameters.iter().map(parameter).collect::<Map<_, _>>(),
            "not_known": self.findings.unknown.iter().map(unknown).collect::<Value>(),
            "stand_ins": camera.placeholders,
            "measurements": self.findings.parts.iter().map(|part| (part.report.kind().to_owned(), part.report.json())).collect::<Map<_, _>>(),
        })
    }

    fn page(&self, camera: &CameraFile) -> String {
        page::page(&self.laboratory, &self.findings, camera)
    }
}

/// Path of the base as the camera file states it.
fn named_from(folder: &Path, base: &Path) -> Result<String, Error> {
    let absolute = |path: &Path| {
        path.canonicalize()
            .map_err(|error| Error::coded(ErrorCode::UnwritableOutput, format!("{}: {error}", path.display())))
    };
    let path = relative_path(&absolute(folder)?, &absolute(base)?);
    path.to_str().map(str::to_owned).ok_or_else(|| {
        Error::coded(ErrorCode::InvalidArgument, format!("{}: path is not valid text (UTF-8)", base.display()))
    })
}
