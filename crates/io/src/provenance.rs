//! Provenance of a result: the facts that every output carries. They include no clock time.

use std::collections::BTreeMap;

/// Origin of a result, and its geometry.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Provenance {
    /// Hash of the plan, hexadecimal.
    pub plan_hash: String,
    /// Seed of the job.
    pub seed: u64,
    /// Version of the program.
    pub version: String,
    /// Name of the camera.
    pub camera: String,
    /// Index of the frame.
    pub frame: u64,
    /// Simulated time at the start of the exposure, s.
    pub time_s: f64,
    /// Geometric convention in words: projection, axes, position of pixel centres.
    pub geometry: String,
    /// Camera to world: rows of a 3 × 4 matrix, translation in m. `None` if there is no single pose (a moving camera).
    pub camera_to_world: Option<[[f64; 4]; 3]>,
    /// Further facts; names become `etendue:<name>` in EXR headers.
    pub further: BTreeMap<String, String>,
}

impl Provenance {
    /// Facts as named texts, sorted by name, without the `etendue:` prefix. Numbers read back to the same bits.
    #[must_use]
    pub fn texts(&self) -> BTreeMap<String, String> {
        let mut texts = self.further.clone();
        let fixed = [
            ("plan_hash", self.plan_hash.clone()),
            ("seed", self.seed.to_string()),
            ("version", self.version.clone()),
            ("camera", self.camera.clone()),
            ("frame", self.frame.to_string()),
            ("time_s", self.time_s.to_string()),
            ("geometry", self.geometry.clone()),
        ];
        texts.extend(fixed.map(|(name, text)| (name.to_owned(), text)));
        if let Some(pose) = &self.camera_to_world {
            texts.insert("camera_to_world".to_owned(), pose_text(pose));
        }
        texts
    }

    /// Facts from named texts as [`Self::texts`] writes them. Absent or unreadable names keep their default; unknown names go into `further`.
    #[must_use]
    pub fn from_texts(texts: &BTreeMap<String, String>) -> Self {
        let mut facts = Self::default();
        for (name, text) in texts {
            facts.take(name, text);
        }
        facts
    }

    fn take(&mut self, name: &str, text: &str) {
        match name {
            "plan_hash" => self.plan_hash = text.to_owned(),
            "seed" => self.seed = text.parse().unwrap_or_default(),
            "version" => self.version = text.to_owned(),
            "camera" => self.camera = text.to_owned(),
            "frame" => self.frame = text.parse().unwrap_or_default(),
            "time_s" => self.time_s = text.parse().unwrap_or_default(),
            "geometry" => self.geometry = text.to_owned(),
            "camera_to_world" => self.camera_to_world = parse_pose(text),
            _ => {
                self.further.insert(name.to_owned(), text.to_owned());
            }
        }
    }
}

fn pose_text(pose: &[[f64; 4]; 3]) -> String {
    pose.map(|row| row.map(|v| v.to_string()).join(" ")).join("; ")
}

fn parse_pose(text: &str) -> Option<[[f64; 4]; 3]> {
    let numbers: Vec<f64> = text.split([' ', ';']).filter(|t| !t.is_empty()).map_while(|t| t.parse().ok()).collect();
    let flat: [f64; 12] = numbers.try_into().ok()?;
    Some(std::array::from_fn(|row| std::array::from_fn(|column| flat[4 * row + column])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facts_survive_the_way_through_text() {
        let facts = Provenance {
            plan_hash: "ab12".to_owned(),
            seed: u64::MAX,
            version: "0.1.0".to_owned(),
            camera: "front".to_owned(),
            frame: 7,
            time_s: 0.1 + 0.2,
            geometry: "pinhole".to_owned(),
            camera_to_world: Some([[1.0, 0.0, 1e-17, 4.5e6], [0.0, -1.0, 0.1, 2.0], [0.0, 0.0, 1.0, -3.0]]),
            further: BTreeMap::from([("note".to_owned(), "x".to_owned())]),
        };
        assert_eq!(Provenance::from_texts(&facts.texts()), facts);
    }
}
