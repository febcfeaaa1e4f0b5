//! One laboratory: photographed, characterised, and what it told kept.

use crate::declared::declared;
use etendue::characterise::{CharacteriseRequest, characterise};
use etendue::{Error, Existing, LaboratoryRequest, Unobserved, laboratory, write_file};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// A laboratory of a reference camera with noise and a specimen of its own.
pub(crate) struct Seed<'a> {
    pub(crate) camera: &'a str,
    /// How it is made small.
    pub(crate) set: &'a [&'a str],
    pub(crate) seed: u64,
}

impl Seed<'_> {
    /// What is found (`found`, by parameters: value and standard uncertainty) and what the camera file declares (`declared`): of an earlier run where
    /// that may be and its laboratory was the same.
    pub(crate) fn told(&self, folder: &Path, resume: bool) -> Result<Value, Error> {
        let (request, file) = (self.request(), self.file(folder));
        let stated = json!(format!("etendue {}: {request:?}", env!("CARGO_PKG_VERSION")));
        let kept = std::fs::read_to_string(&file).ok().filter(|_| resume);
        let kept = kept.and_then(|text| serde_json::from_str::<Value>(&text).ok());
        if let Some(kept) = kept.filter(|kept| kept["laboratory"] == stated) {
            return Ok(kept);
        }
        let mut told = self.characterised(&request, &folder.join(self.camera))?;
        told["laboratory"] = stated;
        write_file(&file, format!("{told:#}\n").as_bytes(), Existing::Replace)?;
        Ok(told)
    }

    fn file(&self, folder: &Path) -> PathBuf {
        folder.join("seeds").join(self.camera).join(format!("{:03}.json", self.seed))
    }

    fn request(&self) -> LaboratoryRequest {
        let specimen = format!("sensor.non_uniformity.seed={}", self.seed);
        let set = self.set.iter().map(|change| (*change).to_owned()).chain([specimen]).collect();
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
        laboratory(request, place, Existing::Refuse, &Unobserved)?;
        let file = place.join("found.toml");
        characterise(&CharacteriseRequest::new(place), &Unobserved)?.save(&file, Existing::Refuse)?;
        let text = std::fs::read_to_string(file.with_extension("json")).map_err(Error::run)?;
        let report: Value = serde_json::from_str(&text).map_err(Error::run)?;
        let of = |value: &Value| json!([value["value"], value["standard_uncertainty"]]);
        let found = report["parameters"].as_object().into_iter().flatten();
        let found: serde_json::Map<String, Value> = found.map(|(key, value)| (key.clone(), of(value))).collect();
        Ok(json!({ "found": found, "declared": declared(place, &report["measurements"])? }))
    }
}
