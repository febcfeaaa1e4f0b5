//! What the benchmarks are made of: scenes and rays, clocks, tables. The benchmarks beside other programs (peers/) use
//! it too.

pub mod clock;
pub mod defocus;
pub mod files;
pub mod flat;
pub mod frames;
pub mod instances;
pub mod lamps;
pub mod lenses;
pub mod machine;
pub mod memory;
pub mod motion;
pub mod obj;
pub mod paths;
pub mod peer;
pub mod questions;
pub mod rays;
pub mod road;
pub mod runs;
pub mod scenes;
pub mod sensor;
pub mod table;
pub mod terrain;
pub mod threads;
pub mod trees;
pub mod views;
