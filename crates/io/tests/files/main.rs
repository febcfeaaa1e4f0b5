//! Reading and writing of files: formats of other programs and our own.

mod assets;
mod calibration_export;
mod calibrations;
mod correspondence;
mod cryptomatte;
mod exr_files;
mod f_theta;
mod field_calibrations;
mod foreign;
mod gltf;
mod lamps;
mod meshes;
mod odd_gltf;
mod odd_images;
mod odd_meshes;
mod openexr;
mod pixel_centres;
mod ply;
mod point_spreads;
mod prescriptions;
