//! The binary as its users meet it: bytes, refusals, plans, golden results.
//!
//! `ETENDUE_BLESS=1` writes plan snapshots and golden results anew.

mod adaptive_sampling;
mod bad_fronts;
mod bad_input;
mod bad_lights;
mod bad_processing;
mod bad_results;
mod bad_sensors;
mod bytes;
mod charts;
mod compared;
mod datasheet;
mod develop;
mod display;
mod dropped;
mod drops;
mod encodings;
mod faults;
mod flat;
mod geometry;
mod goldens;
mod help;
mod hostile;
mod identity;
mod interrupted;
mod kenney;
mod lenses;
mod limits;
mod measures;
mod plan_json;
mod plans;
mod point_lists;
mod precipitation;
mod progressive;
mod raw_files;
mod sandboxed;
mod sequences;
mod shared_light;
mod shared_paths;
mod support;
mod textures;
mod tradeoff;
mod truths;
mod vertex_animation;
mod weather;
