//! From the picture of an edge to its response.

use super::curve::{SfrPoint, crossing};
use super::edge::Edge;
use super::error::SfrError;
use super::profile::Profile;
use super::response::Sfr;
use super::settings::SfrSettings;
use super::shading::levelled;
use super::{fit, shading};
use crate::Image;

/// The response of the slanted edge that fills a picture.
///
/// # Errors
/// Where there is no such edge, its angle cannot be measured, or it is clipped.
pub fn measure_edge(image: &Image, settings: &SfrSettings) -> Result<Sfr, SfrError> {
    check(image, settings)?;
    let start = Edge::from_gradients(image)?;
    let upright = start.upright(image);
    let by_degree = |shading_degree: usize| {
        let settings = &SfrSettings { shading_degree, ..*settings };
        let image = &levelled(&upright, &start, settings)?;
        let (edge, profile) = fit::fitted(image, &vec![true; image.samples().len()], start.clone(), settings)?;
        Ok::<_, SfrError>(told(&edge, &profile, settings))
    };
    let found = by_degree(settings.shading_degree)?;
    let further = settings.shading_degree + 1;
    let other = (further <= shading::MAX_DEGREE).then(|| by_degree(further)).and_then(Result::ok);
    Ok(match other {
        Some(other) => found.with_choice_of_shading(&other),
        None => found,
    })
}

/// Points of a curve but the first.
pub(super) const POINTS: usize = 100;

pub(super) fn told(edge: &Edge, profile: &Profile, settings: &SfrSettings) -> Sfr {
    let frequency = |i: usize| settings.last_frequency * i as f64 / POINTS as f64;
    let curve: Vec<SfrPoint> = (0..=POINTS).map(frequency).map(|f| profile.response(f)).collect();
    Sfr {
        angle_deg: edge.angle_deg(),
        orientation: edge.orientation(),
        levels: profile.levels(),
        noise: profile.noise(),
        step_px: profile.step_px(),
        mtf50: crossing(&curve, 0.5),
        mtf10: crossing(&curve, 0.1),
        curve,
        shading: 0.0,
        profile: profile.samples(),
    }
}

pub(super) fn check(image: &Image, settings: &SfrSettings) -> Result<(), SfrError> {
    let (width, height) = (image.width(), image.height());
    if width < 16 || height < 16 {
        return Err(SfrError::TooSmall { width, height });
    }
    if image.samples().iter().any(|s| !s.is_finite()) {
        return Err(SfrError::NotFinite);
    }
    if !(1..=5).contains(&settings.edge_degree) {
        return Err(SfrError::Settings("the edge's degree must be 1 to 5"));
    }
    if settings.reach_px.is_some_and(|reach| reach.is_nan() || reach < 2.0) {
        return Err(SfrError::Settings("the profile's reach must be 2 pixels or more"));
    }
    if settings.shading_degree > shading::MAX_DEGREE {
        return Err(SfrError::Settings("the degree of the shading must be 0 to 2"));
    }
    if settings.last_frequency.is_nan() || settings.last_frequency <= 0.0 {
        return Err(SfrError::Settings("the last frequency must be above zero"));
    }
    let Some(full) = settings.full_scale else { return Ok(()) };
    let clipped = image.samples().iter().filter(|s| f64::from(**s) >= full).count();
    let percent = 100.0 * clipped as f64 / image.samples().len() as f64;
    if percent > 1.0 {
        return Err(SfrError::Saturated { percent });
    }
    // Whole numbers and what is decoded from them end at 0, too.
    let dark = image.samples().iter().filter(|s| **s <= 0.0).count();
    let percent = 100.0 * dark as f64 / image.samples().len() as f64;
    if percent > 1.0 { Err(SfrError::Dark { percent }) } else { Ok(()) }
}
