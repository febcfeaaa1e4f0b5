//! The draws whose bits are promised: Poisson and normal, from addressed streams.

mod normal;
mod poisson;

pub use normal::standard_normal;
pub use poisson::Poisson;
