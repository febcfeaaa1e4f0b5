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

use crate::measure::pictures::{MeasurementInput, refused};
use crate::measure::truth::place::{EdgeRegion, StarCentre};

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
    pub input: MeasurementInput,
}

impl SfrRequest {
    /// Creates a request with the program's defaults.
    pub fn new(image: impl Into<PathBuf>) -> Self {
        Self {
            picture: image.into(),
            edges: Vec::new(),
            edge_degree: 1,
            reach_px: None,
            shading_degree: 0,
            pixel_pitch_um: None,
            pixels_per_degree: 60.0,
            input: MeasurementInput::default(),
        }
    }
}

pub(super) struct MeasuredEdge<'a> {
    pub(super) region: &'a EdgeRegion,
    pub(super) field: f64,
    pub(super) sfr: Sfr,
}

pub(super) const SAGITTAL: &str = "sagittal";
const TANGENTIAL: &str = "tangential";
const EVERY_DIRECTION: &str = "every direction";
/// cos 22.5°.
const MIN_COSINE: f64 = 0.923_879_532_511_286_7;
/// Stars closer to the centre than this fraction of the half diagonal have no radius.
const CENTRE_FRACTION: f64 = 0.05;

/// Response of a star in a plane.
pub(super) struct StarPlane {
    /// The star's centre, px.
    pub place: String,
    /// Relative to the half diagonal.
    pub field: f64,
    pub name: &'static str,
    pub edges: usize,
    pub curve: Vec<SfrPoint>,
}

/// The planes of the stars among the results, star by star.
pub(super) fn planes(measured: &[MeasuredEdge<'_>], width: usize, height: usize) -> Vec<StarPlane> {
    let mut stars: Vec<StarCentre> = Vec::new();
    for star in measured.iter().filter_map(|one| one.region.spoke.as_ref().map(|spoke| spoke.star)) {
        if !stars.contains(&star) {
            stars.push(star);
        }
    }
    let half = 0.5 * DVec2::new(width as f64, height as f64);
    stars.iter().flat_map(|star| star_planes(star, measured, half)).collect()
}

fn star_planes(star: &StarCentre, measured: &[MeasuredEdge<'_>], half: DVec2) -> Vec<StarPlane> {
    let centre = DVec2::from(star.centre_px);
    let field = (centre - half).length() / half.length();
    let radius = (centre - half).normalize_or_zero();
    let along = |ends: [[f64; 2]; 2]| (DVec2::from(ends[1]) - DVec2::from(ends[0])).normalize_or_zero();
    let plane = |name: &'static str, includes: &dyn Fn(DVec2) -> bool| {
        let star_edges = measured.iter().filter_map(|one| one.region.spoke.as_ref().map(|spoke| (spoke, &one.sfr)));
        let curves: Vec<&[SfrPoint]> = star_edges
            .filter(|(spoke, _)| spoke.star == *star && includes(along(spoke.strip.ends_px)))
            .map(|(_, sfr)| sfr.curve.as_slice())
            .collect();
        let place = format!("{:.0},{:.0}", centre.x, centre.y);
        (!curves.is_empty()).then(|| StarPlane { place, field, name, edges: curves.len(), curve: mean_curve(&curves) })
    };
    if field < CENTRE_FRACTION {
        return plane(EVERY_DIRECTION, &|_| true).into_iter().collect();
    }
    let sagittal = plane(SAGITTAL, &|edge| edge.dot(radius).abs() >= MIN_COSINE);
    let tangential = plane(TANGENTIAL, &|edge| edge.perp_dot(radius).abs() >= MIN_COSINE);
    [sagittal, tangential].into_iter().flatten().collect()
}

/// Error of an edge that cannot be measured, with its image and position.
pub(super) fn failure(request: &SfrRequest, edge_region: &EdgeRegion, error: &SfrError) -> Error {
    let advice = shading_hint(request, error);
    refused(&request.picture, format!("edge at {},{}: {error}{advice}", edge_region.at[0], edge_region.at[1]))
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
