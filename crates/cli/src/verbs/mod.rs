//! One verb a file.

pub mod chart;
pub mod compare;
pub mod datasheet;
pub mod develop;
mod difference;
pub mod expose;
pub mod flat;
pub mod inspect;
pub mod measure;
pub mod merge;
pub mod plan;
pub mod render;
pub mod schema;
