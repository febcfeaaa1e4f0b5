//! Sagittal and tangential responses of slanted stars (after ISO 12233:2023): the means of a star's edges that lie within 22.5° of the radius
//! from the picture's middle (sagittal: structure across the radius is told by edges along it), and within 22.5° of its perpendicular (tangential).
//! A star in the middle has neither: its plane is every direction.

use super::found::Found;
use crate::measure::truth::place::Star;
use etendue_metrology::sfr::{SfrPoint, mean_curve};
use glam::DVec2;

pub(super) const SAGITTAL: &str = "sagittal";
const TANGENTIAL: &str = "tangential";
const EVERY: &str = "every direction";
/// cos 22.5°.
const NEAR: f64 = 0.923_879_532_511_286_7;
/// Stars nearer to the middle than this share of the half diagonal have no radius.
const MIDDLE: f64 = 0.05;

/// A star's response in a plane.
pub(super) struct Plane {
    /// The star's centre, px.
    pub place: String,
    /// Of the half diagonal.
    pub field: f64,
    pub name: &'static str,
    pub edges: usize,
    pub curve: Vec<SfrPoint>,
}

/// The planes of the stars among what was found, star by star.
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
