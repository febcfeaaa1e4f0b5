//! What the benchmarks are made of: scenes and rays, clocks, tables. What needs the core and the tracer alone
//! stands in `etendue-bench-rays`, which the comparison with Embree links.

pub mod adaptive;
pub mod child;
pub mod defocus;
pub mod files;
pub mod films;
pub mod frames;
pub mod inputs;
pub mod instances;
pub mod lamps;
pub mod lenses;
pub mod memory;
pub mod motion;
pub mod obj;
pub mod paths;
pub mod peer;
pub mod questions;
pub mod rays;
pub mod road;
pub mod scenes;
pub mod sensor;
pub mod soak;
pub mod textures;
pub mod trees;
pub mod views;
