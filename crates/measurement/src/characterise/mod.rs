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
use etendue_io::{Existing, OutputFolder, paths::relative_path};
use serde_json::{Map, Value, json};

use crate::report::{finite, json_estimate};
use camera::{CameraFile, Found, camera_file};
use folder::Laboratory;
use parameter::Findings;
use point_picture::PointPicture;

pub use parameter::{Kind, Parameter, Part, Unknown};

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
    found: Found,
}

/// Measures a camera from the images of a laboratory folder. Runs on the caller's thread pool.
///
/// # Errors
/// If the folder cannot be used (unreadable images, images of several cameras, copies, saturated flat fields), or if nothing at
/// all can be determined.
pub fn characterise(request: &CharacteriseRequest, observer: &dyn Observer) -> Result<Characterisation, Error> {
    let laid_over = request.base.as_deref().map(|file| base::open(file).map(|camera| (file, camera))).transpose()?;
    let laboratory = Laboratory::open(&request.folder, observer)?;
    let (mut findings, mut found) = (Findings::default(), Found::default());
    let f = &mut findings;
    found.electronics = electronics::measure(&laboratory, f, observer)?;
    let electronics = found.electronics.as_ref();
    found.fall_off = fall_off::measure(&laboratory, electronics, f)?;
    found.geometry = geometry::measure(&laboratory, f, observer)?;
    found.spread = spread::measure(&laboratory, f)?;
    found.colour = colour::measure(&laboratory, electronics, f)?;
    if let Some((file, camera)) = &laid_over {
        base::refuse_what_is_measured(file, camera, &found)?;
    } else if found.colour.is_some() {
        f.unknown(
            "white balance and colour matrix of the camera file",
            "they depend on the spectral responsivities, which light of one wavelength does not determine; extend a camera file that has them (`base`)",
        );
    }
    let lens = [Kind::Field, Kind::Chart, Kind::Edges, Kind::Checker];
    found.exposure_s = lens.iter().find_map(|kind| laboratory.shots(*kind).first()?.exposure_s);
    if findings.parameters.is_empty() {
        let why: Vec<String> = findings.unknown.iter().map(|u| format!("{}: {}", u.what, u.why)).collect();
        return Err(Error::all_coded(
            ErrorCode::NotMeasurable,
            [vec![format!("{}: no property of the camera can be determined", request.folder.display())], why].concat(),
        ));
    }
    for unknown in &findings.unknown {
        observer.message(Message::Note(&format!("not known: {}: {}", unknown.what, unknown.why)));
    }
    Ok(Characterisation { laboratory, base: request.base.clone(), findings, found })
}

/// Refuses output files that exist and may not be replaced, before anything is measured.
///
/// # Errors
/// If a file that [`Characterisation::save`] would write exists, or the folder cannot be written.
pub fn claim(file: &Path, existing: Existing) -> Result<(), Error> {
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
    pub fn unknown(&self) -> &[Unknown] {
        &self.findings.unknown
    }

    /// The measurements.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.findings.parts
    }

    /// Writes the camera file and, under the same stem, the report as a page (`.html`) and as JSON (`.json`), and the point-spread
    /// image that the camera file names, if any (`-psf.png`). Returns their paths.
    ///
    /// # Errors
    /// If a file exists and may not be replaced, or cannot be written.
    pub fn save(&self, file: &Path, existing: Existing) -> Result<Vec<PathBuf>, Error> {
        self.save_spelled(file, existing, &str::to_owned)
    }

    /// Same as [`Self::save`], for a front end that spells the names of arguments in backticks in the texts.
    ///
    /// # Errors
    /// If a file exists and may not be replaced, or cannot be written.
    pub fn save_spelled(
        &self,
        file: &Path,
        existing: Existing,
        spelled: &dyn Fn(&str) -> String,
    ) -> Result<Vec<PathBuf>, Error> {
        let stem = etendue_io::paths::camera_stem(file);
        let parent = parent(file);
        let picture = self.point_picture();
        let picture_name = format!("{stem}{}", ENDINGS[3]);
        let mut folder = OutputFolder::open_beside(parent, existing).map_err(Error::input)?;
        let base = self.base.as_deref().map(|base| named_from(parent, base)).transpose()?;
        let camera =
            camera_file(&self.laboratory, &self.found, base.as_deref(), picture.as_ref().map(|p| (&*picture_name, p)));
        base::check(&parent.join(format!("{stem}{}", ENDINGS[0])), &camera.text)?;
        let mut files = vec![
            (format!("{stem}{}", ENDINGS[0]), spelled(&camera.text).into_bytes()),
            (format!("{stem}{}", ENDINGS[1]), spelled(&format!("{:#}\n", self.json(&camera))).into_bytes()),
            (format!("{stem}{}", ENDINGS[2]), spelled(&self.page(&camera)).into_bytes()),
        ];
        if let Some(picture) = picture {
            files.push((picture_name, picture.png()?));
        }
        folder.claim(files.iter().map(|(name, _)| name.as_str())).map_err(Error::input)?;
        files.iter().try_for_each(|(name, bytes)| folder.write(name, bytes)).map_err(Error::run)?;
        folder.commit().map_err(Error::run)
    }

    fn point_picture(&self) -> Option<PointPicture> {
        let pitch_um = self.laboratory.camera.pixel_pitch_um.unwrap_or(identity::PITCH_UM);
        PointPicture::of(&self.found.spread?, pitch_um)
    }

    /// The report: parameters, unknown quantities, and every measurement as `etendue measure` prints it.
    fn json(&self, camera: &CameraFile) -> Value {
        let parameter = |p: &Parameter| {
            let mut told = json_estimate(p.value);
            told["expanded_uncertainty_95"] = finite(2.0 * p.value.standard_uncertainty);
            told["unit"] = p.unit.into();
            told["label"] = p.label.as_str().into();
            told["from"] = p.from.folder().into();
            (p.key.clone(), told)
        };
        let unknown = |u: &Unknown| json!({ "what": u.what, "why": u.why });
        json!({
            "program": "etendue",
            "camera": self.laboratory.camera.name,
            "pictures": Kind::ALL.map(|kind| (kind.folder().to_owned(), self.laboratory.shots(kind).len().into())).into_iter().collect::<Map<_, _>>(),
            "parameters": self.findings.parameters.iter().map(parameter).collect::<Map<_, _>>(),
            "not_known": self.findings.unknown.iter().map(unknown).collect::<Value>(),
            "stand_ins": camera.stand_ins,
            "measurements": self.findings.parts.iter().map(|part| (part.report.kind().to_owned(), part.report.json())).collect::<Map<_, _>>(),
        })
    }

    fn page(&self, camera: &CameraFile) -> String {
        page::page(&self.laboratory, &self.findings, camera)
    }
}

/// Path of the base as the camera file states it.
fn named_from(folder: &Path, base: &Path) -> Result<String, Error> {
    let whole = |path: &Path| {
        path.canonicalize()
            .map_err(|error| Error::coded(ErrorCode::UnwritableOutput, format!("{}: {error}", path.display())))
    };
    let path = relative_path(&whole(folder)?, &whole(base)?);
    path.to_str().map(str::to_owned).ok_or_else(|| {
        Error::coded(ErrorCode::InvalidArgument, format!("{}: path is not valid text (UTF-8)", base.display()))
    })
}
