//! `measure ptc`: photon transfer after EMVA 1288.

mod defects;
mod found;
mod groups;
mod measurement;
mod plots;
mod reading;
mod report;
mod request;

pub(crate) use found::Found;
pub(crate) use groups::{Group, groups, of_groups};
pub(crate) use measurement::measured;
pub use measurement::ptc;
pub(crate) use report::report;
pub use request::PtcRequest;
