//! Lenses, their image and their effect on light: closed forms, other programs, conservation.

mod calibrated;
mod defocus;
mod front_dirt;
mod front_mesh;
mod front_mirror;
mod front_windscreen;
mod ghosts;
mod glare;
mod lens_geometry;
mod lens_light;
mod lens_programs;
mod mirrors;
mod openings;
mod prescribed;
mod prescription;
mod psf;
mod pupil_image;
mod pupil_views;
mod ray_transfer;
mod sample_spread;
mod spots;
mod spread_image;
mod spread_table;
