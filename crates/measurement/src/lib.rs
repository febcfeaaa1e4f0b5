//! From images to camera parameters with uncertainty: single measurements, characterisation from a laboratory folder, comparison
//! of two results; their reports, plots and pages.

pub mod characterise;
mod compare;
pub mod measure;
pub mod page;
pub mod plot;
pub mod report;

pub use compare::{ChannelComparison, Comparison, compare};
