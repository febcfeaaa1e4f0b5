//! `measure ptc`: photon transfer after EMVA 1288.

mod defects;
mod found;
mod measurement;
mod plots;
mod reading;
mod report;
mod request;

pub(crate) use measurement::measured;
pub use measurement::ptc;
pub use request::PtcRequest;
