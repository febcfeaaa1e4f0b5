//! The strongest ghosts of a point at infinity, without an image.

use core::f64::consts::PI;

use etendue_core::maths::f64::sin;
use glam::DVec2;

use super::footprint::{Footprint, GhostBeam};
use super::{GhostSettings, mirrored};
use crate::{lens::PrescriptionLens, overlap::PRINCIPAL_NM, prescription::ghost::GhostPair};

/// Solid angle of the sun's disc, sr (radius 959.63″, Auwers 1891).
const SUN_SR: f64 = 6.8e-5;

/// The ghost of a source at infinity by a pair of surfaces, at 587.56 nm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GhostReport {
    pub pair: GhostPair,
    /// Light of the ghost over light of the image.
    pub light: f64,
    /// Position of its centroid: mm from the axis towards the image, negative on the other side.
    pub height_mm: f64,
    /// Radius of the uniform disc of the same root-mean-square size, mm.
    pub radius_mm: f64,
    /// Mean irradiance of the sun's ghost over that of the sun's image.
    pub sun_irradiance: f64,
}

/// The `most` brightest ghosts of a source at infinity whose image lies at a height; empty if the height has no principal ray or no light.
#[must_use]
pub fn strongest(lens: &PrescriptionLens, height_mm: f64, settings: GhostSettings, maximum: usize) -> Vec<GhostReport> {
    let (Some(angle), Some(image_mm2)) = (lens.field_angle(height_mm), image_mm2(lens, height_mm)) else {
        return Vec::new();
    };
    let projected_solid_angle_sr = lens.projected_solid_angle_sr(DVec2::new(height_mm, 0.0));
    let prescription = lens.prescription();
    let beam = GhostBeam::new(prescription, angle);
    let report = |pair: GhostPair| {
        let (window, _) = beam.survey(pair, PRINCIPAL_NM)?;
        let landed = beam.footprint(pair, PRINCIPAL_NM, window);
        let Moments { area_mm2, centre_mm, radius_mm } = moments(&landed)?;
        let area_mm2 = area_mm2 * mirrored(lens, pair.rear, settings);
        let throw_mm = prescription.ghost_first_order(pair, PRINCIPAL_NM).throw_mm;
        let size_mm2 = PI * radius_mm * radius_mm + SUN_SR * throw_mm * throw_mm;
        let sun_irradiance = SUN_SR * area_mm2 / (size_mm2 * projected_solid_angle_sr);
        Some(GhostReport { pair, light: area_mm2 / image_mm2, height_mm: centre_mm, radius_mm, sun_irradiance })
    };
    let pairs = prescription.ghost_pairs(settings.sensor_reflectance > 0.0);
    let mut reports: Vec<GhostReport> = pairs.into_iter().filter_map(report).collect();
    reports.sort_by(|a, b| b.light.total_cmp(&a.light));
    reports.truncate(maximum);
    reports
}

/// The beam's cross-section that forms the image of a point at infinity at a height, times its transmittance, mm²: étendue per area over solid angle
/// per area.
fn image_mm2(lens: &PrescriptionLens, height_mm: f64) -> Option<f64> {
    let step_mm = 1e-3 * lens.lit_radius_mm();
    let inner = (height_mm - 0.5 * step_mm).max(0.0);
    let outer = inner + step_mm;
    let [a, b] = [lens.field_angle(inner)?, lens.field_angle(outer)?];
    let sr_per_mm2 = 4.0 * sin(0.5 * (a + b)) * sin(0.5 * (b - a)) / (outer * outer - inner * inner);
    Some(lens.projected_solid_angle_sr(DVec2::new(height_mm, 0.0)) / sr_per_mm2).filter(|area| *area > 0.0)
}

struct Moments {
    area_mm2: f64,
    centre_mm: f64,
    radius_mm: f64,
}

/// Light, centroid and size of a footprint.
fn moments(footprint: &Footprint) -> Option<Moments> {
    let (mut area, mut first, mut second) = (0.0, 0.0, 0.0);
    footprint.each(f32::INFINITY, |landed| {
        let [x, y, weight] = [landed.x, landed.y, landed.area_mm2].map(f64::from);
        area += weight;
        first += weight * x;
        second += weight * (x * x + y * y);
    });
    let centre_mm = first / area;
    let square = (second / area - centre_mm * centre_mm).max(0.0);
    // The mean square distance of a uniform disc from its centre is half its radius squared.
    (area > 0.0).then(|| Moments { area_mm2: area, centre_mm, radius_mm: (2.0 * square).sqrt() })
}
