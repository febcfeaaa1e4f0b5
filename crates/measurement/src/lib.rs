//! Images to parameters of cameras with their uncertainty: single measurements, the characterisation of a laboratory folder, the comparison of two
//! results; their reports, plots and pages.

pub mod characterise;
mod compare;
pub mod measure;
pub mod page;
pub mod plot;
pub mod report;

pub use compare::{ChannelComparison, Comparison, compare};
