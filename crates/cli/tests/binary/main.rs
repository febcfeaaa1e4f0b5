//! The binary as users run it: bytes, refusals, plans, golden results.
//!
//! `ETENDUE_BLESS=1` rewrites plan snapshots and golden results.

mod adaptive_sampling;
mod bad_fronts;
mod bad_input;
mod bad_lights;
mod bad_pictures;
mod bad_processing;
mod bad_results;
mod bad_sensors;
mod black_boxes;
mod bounded_work;
mod box_formats;
mod branches;
mod browser;
mod bytes;
#[cfg(unix)]
mod captions;
mod characterise;
mod charts;
mod compared;
mod concurrent;
#[cfg(unix)]
mod cookbook;
mod datasets;
mod datasheet;
mod develop;
mod display;
mod dropped;
mod drops;
mod effect_pages;
mod encodings;
mod error_texts;
mod explain;
mod extremes;
mod faults;
mod films;
mod flags;
mod flat;
mod geometry;
mod gltf;
mod gltf_motion;
mod goldens;
mod help;
mod hostile;
mod hostile_outputs;
mod identity;
mod import;
mod import_opacity;
mod import_textures;
mod interrupted;
mod kenney;
mod killed;
mod lens_files;
mod lens_tables;
mod lenses;
mod limits;
mod measures;
mod memory_that_fails;
mod mitsuba;
mod normal_maps;
mod object_axes;
mod plan_json;
mod plans;
mod point_lists;
mod point_spread_files;
mod precipitation;
mod progressive;
mod raw_files;
mod sandboxed;
mod sequences;
mod shards_elsewhere;
mod shared_light;
mod shared_paths;
mod slurm;
mod support;
#[cfg(unix)]
mod terminal;
mod textures;
mod tradeoff;
mod truths;
#[cfg(feature = "usd")]
mod usd;
mod vertex_animation;
mod view;
mod weather;
