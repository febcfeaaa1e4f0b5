//! What of a plan a rendering repeats: why the picture may not be what was meant.

use crate::plan::Plan;
use crate::plan::remark::{Weight, grouped};
use crate::render::light_counts;

impl Plan {
    /// Warnings that concern the picture, each a sentence without a full stop: those of the remarks, and of each camera that
    /// nothing gives light.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let groups = grouped(&self.remarks).into_iter().filter(|group| group.weight == Weight::Warning);
        let said = groups.map(|group| group.to_string());
        said.chain(self.dark_cameras()).collect()
    }

    fn dark_cameras(&self) -> Option<String> {
        let dark = self.cameras.iter().filter(|camera| light_counts(self, camera).is_dark());
        let names: Vec<&str> = dark.map(|camera| camera.name.as_str()).collect();
        let told = format!("camera {}: nothing gives light, so that the picture will be black", names.join(", "));
        (!names.is_empty()).then_some(told)
    }
}
