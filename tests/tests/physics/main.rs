//! The whole way from a description to light, electrons, pictures and ground truth, against closed forms.
//!
//! Small pictures, fixed seeds. A tolerance is either statistical (from the scatter of 16 replicates or more, Student's t,
//! Šidák's correction, one wrong alarm in a thousand; see `etendue_testkit::judge`) or says where it comes from.

mod adaptive_noise;
mod caustics;
mod charts;
mod colour;
mod colour_chart;
mod cornell;
mod datasheet;
mod defocus;
mod dispersing_lens;
mod effects;
mod emva;
mod extremes;
mod front;
mod furnace;
mod ground_truth;
mod high_range;
mod irradiance;
mod lamps;
mod lens_light;
mod levels;
mod mirrors;
mod motion;
mod openings;
mod photons;
mod plausible;
mod ranges;
mod reconstruction;
mod routes;
mod signs;
mod sky;
mod spectral_routes;
mod time;
mod vertex_animation;
mod views;
mod wavelength_density;
mod wheel;
