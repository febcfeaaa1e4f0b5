//! Everything that can cost time or change a frame of a camera: the complete list.
//!
//! Each effect is required (modelled, always run), guarded (run only if a cheap test requires it) or skipped (absent at no cost), with a reason. It states
//! its cost, and the result of leaving it out: the keys, the time saved, and, if there is a closed form, the error. Times are those of `report/cpu_time.rs`
//! and of the street scene's paths; unmeasured times are unknown and not guessed. Some effects are parts of others (bounces beyond the second are indirect
//! light): times do not add up to the frame's.
//!
//! Sensor effects come from the sensor's own list, those on the irradiance from that of the optics, so that none can be forgotten. A test drops each effect
//! of every shipped job by its keys and checks that it is then skipped.

pub(super) mod lens;
mod lens_errors;
mod light_transport;
mod output;
mod planned_effect;
mod processing;
mod scene;
mod sensor;
#[cfg(test)]
mod tests;
mod weather;

pub use planned_effect::{EffectGroup, OmissionResult, PlannedEffect};

use crate::plan::{CameraPlan, Plan};

impl Plan {
    /// Everything that can cost time or change a frame of a camera of the plan, in the order of the light.
    #[must_use]
    pub fn effects(&self, camera: &CameraPlan) -> Vec<PlannedEffect> {
        let groups = [
            light_transport::effects(self, camera),
            scene::effects(self, camera),
            weather::effects(self, camera),
            lens::effects(self, camera),
            sensor::effects(camera),
            processing::effects(camera),
            output::effects(self, camera),
        ];
        groups.into_iter().flatten().collect()
    }
}
