//! Rain and snow.
//!
//! - `rain`, `snow`: laws of sizes, speeds and shapes, with their sources.
//! - `size_law`: what both have in common, and what follows from it: rate, extinction, visibility.
//! - `class`: a law in narrow ranges of size, whose particles fall together.
//! - `field`: which particles exist and where: a pure function of seed and time.
//! - `region`: what part of space a camera sees; `change_over`: how far about it particles are modelled one by one.
//! - `near`: those of one view, and the medium beyond them; `drop_optics`: how a drop bends a ray.
//!
//! One particle falls straight and evenly, with the speed of its class and the wind's. Left out: turbulence, tumbling and oscillation,
//! particles that collide, and shelter by objects: it rains through roofs.

mod change_over;
mod class;
mod drop_optics;
mod field;
mod near;
mod rain;
mod region;
mod size_law;
mod snow;
#[cfg(test)]
mod tests;

pub use change_over::{ChangeOver, Resolution};
pub use class::SizeClass;
pub use field::{Field, Particle};
pub use near::{Near, NearHit};
pub use rain::{axis_ratio, terminal_speed_mps};
pub use region::SeenRegion;
pub use size_law::{SizeLaw, SizeLawError};
pub use snow::Crystals;
