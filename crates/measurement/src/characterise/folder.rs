//! A laboratory folder: its images by kind, and the facts stated about them.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicUsize;

use etendue_core::observer::Observer;
use etendue_io::failure::{Error, ErrorCode, InputError};
use etendue_io::source::read_text;
use etendue_scene::{load_laboratory, record};
use rayon::prelude::*;

use super::{checks, identity, parameter::ImageKind, shot::LaboratoryImage};
use crate::measure::pictures::ImageProgress;

/// The file that states what the images do not.
const FILE: &str = "laboratory.toml";
const TRUTH: &str = "truth.json";
/// File name endings of images; the format follows from their first bytes.
const ENDINGS: [&str; 8] = ["png", "tif", "tiff", "dng", "jpg", "jpeg", "exr", "pfm"];
/// Maximum depth of nested folders.
const MAX_DEPTH: usize = 6;

/// Images of a laboratory folder.
pub(super) struct Laboratory {
    pub(super) root: PathBuf,
    pub(super) stated: record::Laboratory,
    /// Sorted by name.
    shots: Vec<LaboratoryImage>,
    /// Facts about the camera.
    pub(super) camera: identity::CameraFacts,
}

impl Laboratory {
    /// Reads all images and checks that they come from one camera and are usable.
    pub(super) fn open(root: &Path, observer: &dyn Observer) -> Result<Self, Error> {
        if !root.is_dir() {
            return Err(Error::coded(
                ErrorCode::MissingFile,
                format!("{}: folder not found; expected a folder of images", root.display()),
            ));
        }
        let file = root.join(FILE);
        let stated = match file.is_file() {
            true => load_laboratory(&file, &read_text).map_err(|errors| Error::inputs(errors.as_slice()))?,
            false => record::Laboratory::default(),
        };
        let files = files(root)?;
        check_stated(root, &file, &stated)?;
        let progress = ImageProgress { heading: "pictures", done: AtomicUsize::new(0), total: files.len(), observer };
        let read = |(kind, file): &(ImageKind, PathBuf)| {
            let shot = LaboratoryImage::read(*kind, file, exposure_s(root, &stated, file));
            progress.step();
            shot
        };
        let read: Vec<Result<LaboratoryImage, Error>> = files.par_iter().map(read).collect();
        let (mut shots, mut errors) = (Vec::new(), Vec::new());
        for one in read {
            match one {
                Ok(shot) => shots.push(shot),
                Err(Error::Input(more)) => errors.extend(more),
                Err(other) => return Err(other),
            }
        }
        if !errors.is_empty() {
            return Err(Error::Input(errors));
        }
        checks::check(&shots)?;
        let camera = identity::CameraFacts::from_shots(&shots, &stated)?;
        Ok(Self { root: root.to_path_buf(), stated, shots, camera })
    }

    /// Images of a kind: raw ones if there are any, otherwise developed ones.
    pub(super) fn shots(&self, kind: ImageKind) -> Vec<&LaboratoryImage> {
        let all: Vec<&LaboratoryImage> = self.shots.iter().filter(|shot| shot.kind == kind).collect();
        let raw: Vec<&LaboratoryImage> = all.iter().copied().filter(|shot| shot.is_raw()).collect();
        if raw.is_empty() { all } else { raw }
    }

    /// Number of images.
    pub(super) fn count(&self) -> usize {
        self.shots.len()
    }

    /// Ground truth of a kind's chart, if stored with the images.
    pub(super) fn truth(&self, kind: ImageKind) -> Option<PathBuf> {
        Some(self.root.join(kind.folder()).join(TRUTH)).filter(|file| file.is_file())
    }
}

/// Exposure that the laboratory file states for an image's folder, or for a folder around it.
fn exposure_s(root: &Path, stated: &record::Laboratory, file: &Path) -> Option<f64> {
    let within = |folder: &str| file.starts_with(root.join(folder));
    let fit = stated.exposures_s.iter().filter(|(folder, _)| within(&folder.value));
    fit.max_by_key(|(folder, _)| Path::new(&folder.value).components().count()).map(|(_, s)| s.value)
}

/// Refuses named folders that do not exist: a key without effect is a mistake.
fn check_stated(root: &Path, file: &Path, stated: &record::Laboratory) -> Result<(), Error> {
    let missing_folders = stated.exposures_s.iter().filter(|(folder, _)| !root.join(&folder.value).is_dir());
    let sentence = |folder: &str| {
        format!(
            "{}: exposures_s: folder {folder} not found; give a path relative to the laboratory folder",
            file.display()
        )
    };
    let mut errors: Vec<InputError> =
        missing_folders.map(|(folder, _)| InputError::new(ErrorCode::MissingFile, sentence(&folder.value))).collect();
    let tables = [
        (stated.flat.is_some(), ImageKind::Flat),
        (stated.chart.is_some(), ImageKind::Chart),
        (stated.edges.is_some(), ImageKind::Edges),
        (stated.checker.is_some(), ImageKind::Checker),
    ];
    for (_, kind) in tables.into_iter().filter(|(is_stated, kind)| *is_stated && !root.join(kind.folder()).is_dir()) {
        let name = kind.folder();
        let message =
            format!("{}: [{name}] has no effect without a folder {name}/; add it, or remove the table", file.display());
        errors.push(InputError::new(ErrorCode::NoEffect, message));
    }
    if errors.is_empty() { Ok(()) } else { Err(Error::Input(errors)) }
}

/// All images with their kinds, sorted by name.
fn files(root: &Path) -> Result<Vec<(ImageKind, PathBuf)>, Error> {
    let mut image_files = Vec::new();
    for kind in ImageKind::ALL {
        let folder = root.join(kind.folder());
        if folder.is_dir() {
            let mut within = Vec::new();
            collect_files(&folder, MAX_DEPTH, &mut within)?;
            within.sort();
            image_files.extend(within.into_iter().map(|file| (kind, file)));
        }
    }
    if image_files.is_empty() {
        let names = ImageKind::ALL.map(|kind| format!("{}/ ({})", kind.folder(), kind.about())).join(", ");
        let message = format!(
            "{}: contains no images to characterise a camera; expected one or more of these folders, with images: {names}",
            root.display()
        );
        return Err(Error::coded(ErrorCode::Empty, message));
    }
    Ok(image_files)
}

fn collect_files(folder: &Path, depth_left: usize, files: &mut Vec<PathBuf>) -> Result<(), Error> {
    let failed =
        |error: std::io::Error| Error::coded(ErrorCode::UnreadableFile, format!("{}: {error}", folder.display()));
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let ending = path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
        if path.is_dir() && depth_left > 0 {
            collect_files(&path, depth_left - 1, files)?;
        } else if path.is_file() && ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str())) {
            files.push(path);
        }
    }
    Ok(())
}
