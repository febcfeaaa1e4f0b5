//! The camera that a chart is made for: a camera file, or a reference camera that is written next to the chart.

use etendue_charts::CameraStation;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::load_assets;
use etendue_io::paths::relative_path;
use etendue_io::source::read_text;
use etendue_pipeline::compile_camera;
use etendue_pipeline::plan::CameraBody;
use etendue_scene::{Overrides, load_camera, named_files};
use std::path::{Path, PathBuf};

/// Reference camera files that name no other files.
const REFERENCE_CAMERAS: [(&str, &str); 5] = [
    ("web", include_str!("../../../../scenes/cameras/web.toml")),
    ("ccd-mono", include_str!("../../../../scenes/cameras/ccd-mono.toml")),
    ("ccd-bayer", include_str!("../../../../scenes/cameras/ccd-bayer.toml")),
    ("automotive", include_str!("../../../../scenes/cameras/automotive.toml")),
    ("laboratory", include_str!("../../../../scenes/cameras/laboratory.toml")),
];

/// Unit number of a series whose camera states none.
const DEFAULT_UNIT: u64 = 1;

/// A camera and the place of its file.
pub(super) struct ChartCamera {
    /// The camera.
    pub(super) body: CameraBody,
    source: Source,
}

enum Source {
    File(PathBuf),
    StandIn(String, &'static str),
}

impl ChartCamera {
    /// Reads and compiles a camera file, or a reference camera given by name, with changes `key=value` of its keys.
    pub(super) fn load(name_or_file: &str, changes: &[String]) -> Result<Self, Error> {
        let reference = REFERENCE_CAMERAS.iter().find(|(name, _)| *name == name_or_file);
        let source = match reference {
            Some((name, text)) => Source::StandIn(format!("{name}.toml"), text),
            None if name_or_file.ends_with(".toml") => Source::File(PathBuf::from(name_or_file)),
            None => {
                let names = REFERENCE_CAMERAS.map(|(name, _)| name).join(", ");
                let message = format!("`camera` {name_or_file}: expected a camera file (.toml) or one of {names}");
                return Err(Error::argument("camera", message));
            }
        };
        let (path, text) = match &source {
            Source::File(path) => (path.clone(), None),
            Source::StandIn(name, text) => (PathBuf::from(name), Some(*text)),
        };
        let read = |file: &Path| match text {
            Some(text) if file == path => Ok(text.to_owned()),
            _ => read_text(file),
        };
        let camera = load_camera(&path, &read, &Overrides::new(changes)).map_err(|f| Error::inputs(f.as_slice()))?;
        let assets = load_assets(&named_files::camera_files(&camera)).map_err(Error::inputs)?;
        Ok(Self { body: compile_camera(&camera, &assets).map_err(Error::inputs)?, source })
    }

    /// The reference camera's file and its text.
    pub(super) fn reference_camera(&self) -> Option<(String, &'static str)> {
        match &self.source {
            Source::File(_) => None,
            Source::StandIn(name, text) => Some((name.clone(), text)),
        }
    }

    /// The camera file as a path from the chart's folder.
    pub(super) fn base(&self, folder: &Path) -> Result<String, Error> {
        let file = match &self.source {
            Source::StandIn(name, _) => return Ok(name.clone()),
            Source::File(path) => path,
        };
        let absolute = |path: &Path| {
            let here = if path.as_os_str().is_empty() { Path::new(".") } else { path };
            here.canonicalize()
                .map_err(|error| Error::coded(ErrorCode::UnsuitableFile, format!("{}: {error}", path.display())))
        };
        let from_to = relative_path(&absolute(folder)?, &absolute(file)?);
        let text = from_to.to_str().filter(|text| !text.contains(['"', '\\']));
        let message = || {
            Error::coded(
                ErrorCode::InvalidArgument,
                format!(
                    "{}: the path contains a quote or a backslash, or is not UTF-8; give another path",
                    file.display()
                ),
            )
        };
        text.map(str::to_owned).ok_or_else(message)
    }

    /// Keys removed from a chart's cameras: those that change the exposure from frame to frame.
    pub(super) fn removed_keys(&self) -> &'static [&'static str] {
        let sensor = self.body.sensor.as_ref();
        let controlled = sensor.is_some_and(|sensor| sensor.parameters().exposure.control.is_some());
        if controlled { &["sensor.auto_exposure"] } else { &[] }
    }

    /// Unit number for the cameras of a series, so that all of them are the same physical unit.
    pub(super) fn default_unit(&self, stations: &[CameraStation]) -> Option<u64> {
        let sensor = self.body.sensor.as_ref()?;
        let open = sensor.parameters().unit.is_none();
        (open && stations.len() > 1).then_some(DEFAULT_UNIT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reference_cameras_are_complete() {
        for (name, _) in REFERENCE_CAMERAS {
            let camera = ChartCamera::load(name, &[]).unwrap_or_else(|failure| panic!("{name}: {failure}"));
            assert_eq!(camera.body.sensor.is_some(), name != "laboratory");
        }
    }
}
