//! Changes of keys of a chart's job (`--set`): checked as a job is checked, and written into its files.
//!
//! All cameras of a chart have the lens, sensor, effects, processing and external optics of one camera file, for which the chart is drawn: changes of these
//! are applied before it is drawn. All others are written into `job.toml` and `scene.toml` afterwards.

use etendue_io::failure::{Error, ErrorCode};
use etendue_io::source::read_text;
use etendue_scene::{Description, Overrides, edit};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const JOB: &str = "job.toml";
const SCENE: &str = "scene.toml";
/// The camera file of a chart without a series.
const CAMERA: &str = "camera.toml";

/// Tables of a camera file.
const CAMERA_TABLES: [&str; 5] = ["lens", "external_optics", "effects", "sensor", "isp"];

/// Changes `key=value` of a chart's job.
#[derive(Clone, Copy)]
pub(super) struct Changes<'c>(pub(super) &'c [String]);

/// The file that contains a key.
enum KeyFile<'c> {
    /// The camera file, with the key and value within it.
    Camera(&'c str),
    Scene(&'c str),
    Job,
}

impl<'c> Changes<'c> {
    /// Returns the changes of the camera, as changes of its file.
    pub(super) fn camera_changes(self) -> Vec<String> {
        let key = |change: &String| match target(change) {
            KeyFile::Camera(key) => Some(key.to_owned()),
            KeyFile::Scene(_) | KeyFile::Job => None,
        };
        self.0.iter().filter_map(key).collect()
    }

    /// Returns the changes that are applied after the chart is drawn.
    pub(super) fn job_changes(self) -> Vec<String> {
        self.0.iter().filter(|change| !matches!(target(change), KeyFile::Camera(_))).cloned().collect()
    }

    /// Reads the job of `files` with the changes: the errors are those of rendering it with them.
    pub(super) fn check(self, folder: &Path, files: &BTreeMap<String, String>) -> Result<(), Error> {
        load(folder, files, &Overrides::new(self.0)).map(|_| ())
    }

    /// Writes the changes into the texts of the files; `camera_files` are those of the chart's cameras.
    pub(super) fn write(
        self,
        folder: &Path,
        camera_files: &[String],
        files: &mut BTreeMap<String, String>,
    ) -> Result<(), Error> {
        self.check_series(camera_files)?;
        let mut by_file: BTreeMap<&str, Vec<String>> = BTreeMap::new();
        for change in self.0 {
            match target(change) {
                KeyFile::Camera(key) => {
                    camera_files.iter().for_each(|file| by_file.entry(file).or_default().push(key.to_owned()));
                }
                KeyFile::Scene(key) => by_file.entry(SCENE).or_default().push(key.to_owned()),
                KeyFile::Job => by_file.entry(JOB).or_default().push(change.clone()),
            }
        }
        for (file, changes) in by_file {
            let Some(text) = files.get_mut(file) else { continue };
            *text = edit(&folder.join(file), text, &changes).map_err(|errors| Error::inputs(errors.as_slice()))?;
        }
        self.check_written(folder, files)
    }

    /// Refuses the exposure of a series, in which each camera has its own.
    fn check_series(self, camera_files: &[String]) -> Result<(), Error> {
        let is_exposure = |change: &&String| {
            let KeyFile::Camera(key) = target(change) else { return false };
            let key = key.split('=').next().unwrap_or_default().trim();
            key == "sensor" || key == "sensor.exposure_s"
        };
        if camera_files.iter().all(|file| file == CAMERA) {
            return Ok(());
        }
        self.0.iter().find(is_exposure).map_or(Ok(()), |change| {
            let remedy = "the chart sets the exposures of a series; give them with `exposures` or `levels`";
            Err(Error::argument("set", format!("`set` {change}: {remedy}")).with_code(ErrorCode::InvalidChange))
        })
    }

    /// Refuses a change that the files do not contain: applied again, a change has no effect.
    fn check_written(self, folder: &Path, files: &BTreeMap<String, String>) -> Result<(), Error> {
        let written = load(folder, files, &Overrides::default())?;
        let values = self.0.iter().filter(|change| !is_removal(change));
        for change in values {
            let repeated = load(folder, files, &Overrides::new([change]))?;
            if repeated.to_table() != written.to_table() {
                return Err(Error::argument(
                    "set",
                    format!(
                        "`set` {change}: the change cannot be written into the chart's files; give the whole list or table that contains the key, or change the camera file"
                    ),
                ).with_code(ErrorCode::InvalidChange));
            }
        }
        Ok(())
    }
}

/// Returns the file into which a change is written.
fn target(change: &str) -> KeyFile<'_> {
    let (key, _) = change.split_once('=').unwrap_or((change, ""));
    let parts: Vec<&str> = key.split('.').map(str::trim).collect();
    let after = |parts: usize| change.splitn(parts + 1, '.').nth(parts).unwrap_or("");
    match parts.as_slice() {
        ["cameras", _, table, ..] if CAMERA_TABLES.contains(table) => KeyFile::Camera(after(2)),
        ["scene", _, ..] => KeyFile::Scene(after(1)),
        _ => KeyFile::Job,
    }
}

fn is_removal(change: &str) -> bool {
    change.split_once('=').is_some_and(|(_, value)| value.trim() == "null")
}

fn load(folder: &Path, files: &BTreeMap<String, String>, overrides: &Overrides) -> Result<Description, Error> {
    let texts: BTreeMap<PathBuf, &String> = files.iter().map(|(name, text)| (folder.join(name), text)).collect();
    let read = |path: &Path| texts.get(path).map_or_else(|| read_text(path), |text| Ok((*text).clone()));
    let description = Description::load(&folder.join(JOB), &read, overrides);
    description.map_err(|errors| Error::inputs(errors.as_slice()))
}

#[cfg(test)]
mod tests {
    use super::Changes;

    #[test]
    fn changes_of_the_camera_are_those_of_its_file() {
        let set = [
            "cameras.front.lens.f_number=4",
            "cameras.front.output.raw=true",
            "scene.environment.luminance_cd_m2=3.5",
            "render.spp=4",
        ];
        let set = set.map(str::to_owned);
        assert_eq!(Changes(&set).camera_changes(), ["lens.f_number=4"]);
        assert_eq!(Changes(&set).job_changes(), &set[1..]);
    }
}
