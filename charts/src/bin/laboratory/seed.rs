//! One laboratory: photographed, characterised, and what it told kept.

use crate::declared::declared;
use etendue::characterise::{CharacteriseRequest, characterise};
use etendue::{Error, ExistingFiles, LaboratoryRequest, NullObserver, laboratory, write_file};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// A laboratory of a reference camera with noise and a specimen of its own.
pub(crate) struct SeededLaboratory<'a> {
    pub(crate) camera: &'a str,
    /// How it is made small.
    pub(crate) set: &'a [&'a str],
    pub(crate) seed: u64,
}

impl SeededLaboratory<'_> {
    /// What is found (`found`, by parameters: value and standard uncertainty) and what the camera file declares (`declared`): of an earlier run where
    /// that may be and its laboratory was the same.
    pub(crate) fn seed_report(&self, folder: &Path, resume: bool) -> Result<Value, Error> {
        let (request, file) = (self.request(), self.file(folder));
        let stated = json!(format!("etendue {}: {request:?}", env!("CARGO_PKG_VERSION")));
        let stored = std::fs::read_to_string(&file).ok().filter(|_| resume);
        let stored = stored.and_then(|text| serde_json::from_str::<Value>(&text).ok());
        if let Some(stored) = stored.filter(|stored| stored["laboratory"] == stated) {
            return Ok(stored);
        }
        let mut results = self.characterised(&request, &folder.join(self.camera))?;
        results["laboratory"] = stated;
        write_file(&file, format!("{results:#}\n").as_bytes(), ExistingFiles::Replace)?;
        Ok(results)
    }

    fn file(&self, folder: &Path) -> PathBuf {
        folder.join("seeds").join(self.camera).join(format!("{:03}.json", self.seed))
    }

    fn request(&self) -> LaboratoryRequest {
        let seed_setting = format!("sensor.non_uniformity.seed={}", self.seed);
        let set = self.set.iter().map(|change| (*change).to_owned()).chain([seed_setting]).collect();
        LaboratoryRequest {
            set,
            seed: self.seed,
            levels: 12,
            stack: 16,
            views: 9,
            spp: 32,
            ..LaboratoryRequest::new(format!("charts/{}/camera.toml", self.camera))
        }
    }

    fn characterised(&self, request: &LaboratoryRequest, place: &Path) -> Result<Value, Error> {
        if place.exists() {
            std::fs::remove_dir_all(place).map_err(Error::run)?;
        }
        laboratory(request, place, ExistingFiles::Refuse, &NullObserver)?;
        let file = place.join("found.toml");
        characterise(&CharacteriseRequest::new(place), &NullObserver)?.save(&file, ExistingFiles::Refuse)?;
        let text = std::fs::read_to_string(file.with_extension("json")).map_err(Error::run)?;
        let report: Value = serde_json::from_str(&text).map_err(Error::run)?;
        let value_and_uncertainty = |value: &Value| json!([value["value"], value["standard_uncertainty"]]);
        let parameters = report["parameters"].as_object().into_iter().flatten();
        let values: serde_json::Map<String, Value> =
            parameters.map(|(key, value)| (key.clone(), value_and_uncertainty(value))).collect();
        Ok(json!({ "found": values, "declared": declared(place, &report["measurements"])? }))
    }
}
