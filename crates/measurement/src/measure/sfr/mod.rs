//! `measure sfr`: the response of slanted edges.

mod found;
mod measurement;
mod planes;
mod refusal;
mod report;
mod request;

pub(crate) use measurement::responses;
pub use measurement::sfr;
pub use request::SfrRequest;
