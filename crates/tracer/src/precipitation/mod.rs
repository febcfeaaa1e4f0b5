//! Rain and snow.
//!
//! - `size_law`: laws of sizes, speeds and shapes of rain and snow, with their sources, and what follows from them: rate, extinction,
//!   visibility; a law in narrow ranges of size (classes), whose particles fall together.
//! - `field`: which particles exist and where: a pure function of seed and time.
//! - `change_over`: what part of space a camera sees, and how far about it particles are modelled one by one.
//! - `near`: those of one view, and the medium beyond them; how a drop refracts a ray.
//!
//! One particle falls straight and evenly, with the speed of its class and the wind's. Left out: turbulence, tumbling and oscillation,
//! particles that collide, and shelter by objects: it rains through roofs.

mod change_over;
mod field;
mod near;
mod size_law;

pub use change_over::{ChangeOver, Resolution, SeenRegion};
pub use field::{Field, Particle};
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
