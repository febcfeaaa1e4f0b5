//! Request and results of `measure sfr`, the measured planes, and the reasons for leaving out an edge.
//!
//! Sagittal and tangential responses of slanted stars (after ISO 12233:2023) are means of a star's edges. Sagittal: edges within
//! 22.5° of the radius from the image centre, which measure structure across the radius. Tangential: edges within 22.5° of its
//! perpendicular. A star in the centre has neither: its plane is every direction.

use std::{ops::RangeInclusive, path::PathBuf};

use clap::Args;
use etendue_arguments::{in_range, region};
use etendue_io::failure::Error;
use etendue_metrology::sfr::{Sfr, SfrError, SfrPoint, mean_curve};
use glam::DVec2;

use crate::measure::pictures::{PictureInput, refused};
use crate::measure::truth::place::{Sought, Star};

/// Allowed degrees of the curve of an edge.
pub(super) const EDGE_DEGREES: RangeInclusive<u8> = 1..=5;
/// Allowed degrees of the shading surfaces on either side of an edge.
pub(super) const SHADING_DEGREES: RangeInclusive<u8> = 0..=2;

/// `etendue measure sfr`
#[derive(Args, Clone, Debug)]
pub struct SfrRequest {
    /// Image of one or more slanted edges
    #[arg(value_name = "IMAGE")]
    pub picture: PathBuf,
    /// Part of the image that contains one edge: left column, top row, width, height; once per edge [default: all of it]
    #[arg(long = "edge", value_name = "X,Y,W,H", value_parser = region, conflicts_with = "truth")]
    pub edges: Vec<[usize; 4]>,
    /// Degree of the curve of the edges: 2 or 3 if the lens bends them
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = in_range(EDGE_DEGREES))]
    pub edge_degree: u8,
    /// Reach of the profile's fine detail on either side of the edge, pixels [default: 10]
    #[arg(long, value_name = "PX", allow_negative_numbers = true)]
    pub reach_px: Option<f64>,
    /// Degree of the surfaces that model shading, one on either side of the edge: 1 or 2 if the lens's fall-off makes the sides
    /// slope
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = in_range(SHADING_DEGREES))]
    pub shading_degree: u8,
    /// Pixel pitch, µm: adds MTF50 and MTF10 in line pairs per millimetre
    #[arg(long, value_name = "UM", allow_negative_numbers = true)]
    pub pixel_pitch_um: Option<f64>,
    /// Viewing condition for acutance: pixels per degree at the eye
    #[arg(long, value_name = "N", default_value_t = 60.0, allow_negative_numbers = true)]
    pub pixels_per_degree: f64,
    /// Readings of the image, their meaning, and the chart's ground truth.
    #[command(flatten)]
    pub input: PictureInput,
}

impl SfrRequest {
    /// Creates a request with the program's defaults.
    pub fn new(picture: impl Into<PathBuf>) -> Self {
        Self {
            picture: picture.into(),
            edges: Vec::new(),
            edge_degree: 1,
            reach_px: None,
            shading_degree: 0,
            pixel_pitch_um: None,
            pixels_per_degree: 60.0,
            input: PictureInput::default(),
        }
    }
}

/// A measured edge.
pub(super) struct Found<'a> {
    pub(super) sought: &'a Sought,
    pub(super) field: f64,
    pub(super) sfr: Sfr,
}

pub(super) const SAGITTAL: &str = "sagittal";
const TANGENTIAL: &str = "tangential";
const EVERY: &str = "every direction";
/// cos 22.5°.
const NEAR: f64 = 0.923_879_532_511_286_7;
/// Stars closer to the centre than this fraction of the half diagonal have no radius.
const MIDDLE: f64 = 0.05;

/// Response of a star in a plane.
pub(super) struct Plane {
    /// The star's centre, px.
    pub place: String,
    /// Relative to the half diagonal.
    pub field: f64,
    pub name: &'static str,
    pub edges: usize,
    pub curve: Vec<SfrPoint>,
}

/// The planes of the stars among the results, star by star.
pub(super) fn of(found: &[Found<'_>], width: usize, height: usize) -> Vec<Plane> {
    let mut stars: Vec<Star> = Vec::new();
    for star in found.iter().filter_map(|one| one.sought.spoke.as_ref().map(|spoke| spoke.star)) {
        if !stars.contains(&star) {
            stars.push(star);
        }
    }
    let half = 0.5 * DVec2::new(width as f64, height as f64);
    stars.iter().flat_map(|star| of_star(star, found, half)).collect()
}

fn of_star(star: &Star, found: &[Found<'_>], half: DVec2) -> Vec<Plane> {
    let centre = DVec2::from(star.centre_px);
    let field = (centre - half).length() / half.length();
    let radius = (centre - half).normalize_or_zero();
    let along = |ends: [[f64; 2]; 2]| (DVec2::from(ends[1]) - DVec2::from(ends[0])).normalize_or_zero();
    let plane = |name: &'static str, holds: &dyn Fn(DVec2) -> bool| {
        let of_this = found.iter().filter_map(|one| one.sought.spoke.as_ref().map(|spoke| (spoke, &one.sfr)));
        let curves: Vec<&[SfrPoint]> = of_this
            .filter(|(spoke, _)| spoke.star == *star && holds(along(spoke.strip.ends_px)))
            .map(|(_, sfr)| sfr.curve.as_slice())
            .collect();
        let place = format!("{:.0},{:.0}", centre.x, centre.y);
        (!curves.is_empty()).then(|| Plane { place, field, name, edges: curves.len(), curve: mean_curve(&curves) })
    };
    if field < MIDDLE {
        return plane(EVERY, &|_| true).into_iter().collect();
    }
    let sagittal = plane(SAGITTAL, &|edge| edge.dot(radius).abs() >= NEAR);
    let tangential = plane(TANGENTIAL, &|edge| edge.perp_dot(radius).abs() >= NEAR);
    [sagittal, tangential].into_iter().flatten().collect()
}

/// Error of an edge that cannot be measured, with its image and position.
pub(super) fn failure(request: &SfrRequest, sought: &Sought, error: &SfrError) -> Error {
    let hint = shading_hint(request, error);
    refused(&request.picture, format!("edge at {},{}: {error}{hint}", sought.at[0], sought.at[1]))
}

/// Remedy if non-uniform sides prevent the detection of an edge.
pub(super) fn shading_hint(request: &SfrRequest, error: &SfrError) -> &'static str {
    match error {
        SfrError::NoEdge(_) if request.shading_degree == 0 => {
            "; if the illumination falls off along the surfaces, `shading_degree` 1 corrects it"
        }
        _ => "",
    }
}
