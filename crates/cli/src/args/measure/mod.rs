//! `etendue measure` and `etendue calibrate`, as typed: one kind of measurement a file.

pub mod calibrate;
pub mod cdp;
pub mod chart_points;
pub mod chromatic;
pub mod colour;
pub mod compare;
pub mod dark_current;
pub mod depth;
pub mod distortion;
pub mod encoding;
pub mod flare;
pub mod focal;
pub mod lens;
pub mod noise;
pub mod oecf;
pub mod picture;
pub mod ptc;
pub mod report;
pub mod selection;
pub mod sfr;
pub mod shading;
pub mod texture;
pub mod truth;
pub mod views;
