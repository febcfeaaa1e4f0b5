//! Random numbers for sensors: our own implementation, because their bits are guaranteed.

mod normal;
pub(crate) mod pattern;
mod poisson;

pub use normal::standard_normal;
pub use poisson::Poisson;
