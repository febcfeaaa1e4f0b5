//! Everything that can cost or change a frame of a camera: the closed list.
//!
//! Each effect says whether it is required (modelled, always run), guarded (run where a cheap test asks for it) or skipped (absent at no
//! cost), and why; what it takes; and what leaving it out would bring: by which keys, how much time, and, where there is a closed form, which
//! error. Times are those of `report/cpu_time.rs` and of the street's paths; what was never measured is not known, and not guessed. Parts of
//! others are in the list, too (bounces beyond the second are indirect light): times do not add up to the frame's.
//!
//! Sensor effects come from the sensor's own list, those on the irradiance from that of the optics, so that none can be forgotten; a test
//! drops every one of every job that ships by its keys and looks for it among what is skipped.

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

pub use planned_effect::{EffectGroup, IfDropped, PlannedEffect};

use crate::plan::{CameraPlan, Plan};

impl Plan {
    /// Everything that can cost or change a frame of a camera of the plan, in the order of the light.
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
