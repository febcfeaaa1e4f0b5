//! Import of scenes of other programs as files of the format: a scene, a job with its cameras, and a conversion report.
//!
//! The content of another program's file is written in our own keys, so that it can be read, changed and extended (docs/import.md, docs/decisions/import.md).

mod gltf;
mod lamps;
mod mitsuba;
mod moving;
mod naming;
mod pbrt;
mod scenery;
mod substitutes;
pub mod syntax;
#[cfg(feature = "usd")]
mod usd;
mod written;

use std::path::{Path, PathBuf};

use clap::Args;
use etendue_core::observer::{Message, Observer};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::{ExistingFiles, OutputFolder};

use written::ImportFiles;

/// Supported scene files, by extension.
const KINDS: &str = ".glb, .gltf, .pbrt, .xml (Mitsuba), .usd, .usda, .usdc or .usdz";

/// A scene of another program.
#[derive(Args, Clone, Debug, Default, Eq, PartialEq)]
pub struct ImportRequest {
    /// The scene: glTF 2.0 (.glb, .gltf), pbrt-v4 (.pbrt), Mitsuba 3 (.xml), USD (.usd, .usda, .usdc, .usdz) where it is built in
    #[arg(id = "scene", value_name = "SCENE")]
    pub file: PathBuf,
    /// Give a value to a parameter of a Mitsuba scene ($name) in place of its default, e.g. -D radius=0.5
    #[arg(id = "define", short = 'D', long, value_name = "NAME=VALUE", value_parser = parameter)]
    pub parameters: Vec<(String, String)>,
}

/// `NAME=VALUE`, as Mitsuba's own option.
fn parameter(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.is_empty() => Ok((name.to_owned(), value.to_owned())),
        _ => Err("expected NAME=VALUE, such as radius=0.5".to_owned()),
    }
}

/// Imports a scene of another program: writes `scene.toml`, `job.toml` and their files into a folder and returns their paths. The conversion report (mapped and
/// dropped content) is the header of the scene and is passed to the observer.
///
/// # Errors
/// If the file cannot be read or used, a parameter has no effect, or the folder cannot be written.
pub fn import(
    request: &ImportRequest,
    folder: &Path,
    existing: ExistingFiles,
    observer: &dyn Observer,
) -> Result<Vec<PathBuf>, Error> {
    // The folder may be created by this call: paths between files need it.
    let from = std::path::absolute(folder)
        .map_err(|cause| Error::coded(ErrorCode::UnreadableFile, format!("{}: {cause}", folder.display())))?;
    let ImportFiles { files, report } = read(request, &from)?;
    let mut folder = OutputFolder::open_beside(folder, existing).map_err(Error::input)?;
    folder.claim(files.iter().map(|(name, _)| name.as_str())).map_err(Error::input)?;
    for (name, bytes) in &files {
        folder.write(name, bytes).map_err(Error::run)?;
    }
    report.iter().for_each(|line| observer.message(Message::Note(line)));
    folder.commit().map_err(Error::run)
}

/// Files of a scene, with paths relative to `folder`.
fn read(request: &ImportRequest, folder: &Path) -> Result<ImportFiles, Error> {
    let ImportRequest { file, parameters } = request;
    let ending = file.extension().unwrap_or_default().to_ascii_lowercase();
    let reader = match ending.to_str() {
        Some("xml") => return mitsuba::convert(file, folder, parameters),
        Some("glb" | "gltf") => gltf::convert,
        Some("pbrt") => pbrt::convert,
        #[cfg(feature = "usd")]
        Some("usd" | "usda" | "usdc" | "usdz") => usd::convert,
        #[cfg(not(feature = "usd"))]
        Some("usd" | "usda" | "usdc" | "usdz") => return Err(without_usd(file)),
        _ => {
            let shown = file.display();
            return Err(Error::coded(
                ErrorCode::UnsupportedFile,
                format!("{shown}: unsupported scene file; expected {KINDS}"),
            ));
        }
    };
    match parameters.first() {
        None => reader(file, folder),
        Some((name, _)) => Err(Error::coded(
            ErrorCode::NoEffect,
            format!(
                "{}: the parameter \"{name}\" has no effect; only Mitsuba scenes (.xml) have parameters: remove it",
                file.display()
            ),
        )),
    }
}

/// Error for a scene whose reader is not built in.
#[cfg(any(test, not(feature = "usd")))]
fn without_usd(file: &Path) -> Error {
    Error::coded(
        ErrorCode::UnsupportedFile,
        format!(
            "{}: this program was built without support for Universal Scene Description; build it with the feature \"usd\" (docs/import.md), or convert \
                the scene to glTF",
            file.display()
        ),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_without_the_reader_says_how_to_build_it() {
        let message = without_usd(Path::new("a.usdz")).to_string();
        assert!(message.contains("a.usdz: ") && message.contains("the feature \"usd\""), "{message}");
    }
}
