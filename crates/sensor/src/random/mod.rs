//! Random numbers for sensors: our own, because their bits are promised.

mod normal;
pub(crate) mod pattern;
mod poisson;

pub use normal::standard_normal;
pub use poisson::Poisson;
