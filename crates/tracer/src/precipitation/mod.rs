//! Rain and snow.
//!
//! - `size_law`: laws of sizes, speeds and shapes of rain and snow, with their sources, and the resulting rate, extinction and
//!   visibility; a law in narrow ranges of size (classes), whose particles fall together.
//! - `field`: the set of particles and their places: a pure function of seed and time.
//! - `change_over`: the part of space that a camera sees, and the distance up to which particles are modelled one by one.
//! - `near`: those of one view, and the medium beyond them; refraction of a ray by a drop.
//!
//! A particle falls straight and at constant speed, that of its class plus the wind. Left out: turbulence, tumbling and oscillation, colliding
//! particles, and shelter by objects: it rains through roofs.

mod change_over;
mod field;
mod near;
mod size_law;

pub use change_over::{CameraResolution, ChangeOver, VisibleRegion};
pub use field::{Particle, PrecipitationField};
pub use near::{NearParticles, ParticleHit, ViewPlacement};
pub use size_law::{Crystals, SizeClass, SizeLaw, SizeLawError, SizeRange, axis_ratio, terminal_speed_mps};

#[cfg(test)]
mod tests {
    mod drops;
    mod fields;
    mod laws;
    mod seam;
    mod visibility;

    use etendue_core::TimeInterval;
    use glam::DVec3;

    use super::*;

    /// Everything within `radius_m`, of every class.
    fn ball(radius_m: f64) -> ChangeOver {
        ChangeOver { clear_m: 0.0, radii_m: vec![radius_m; size_law::CLASSES as usize], expected: 0.0 }
    }

    fn moment(time_s: f64) -> TimeInterval {
        TimeInterval::at(time_s).expect("finite")
    }
}
