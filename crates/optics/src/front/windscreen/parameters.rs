//! What a wind-screen is made of.

use crate::error::front::{FrontError, positive};
use crate::front::Placement;
use crate::front::curve::Curve;
use crate::prescription::coating::Coating;

/// A layer of a wind-screen.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Thickness, mm.
    pub thickness_mm: f64,
    /// Refractive index against air.
    pub index: Curve,
}

/// Glass that absorbs.
#[derive(Clone, Debug, PartialEq)]
pub struct Tint {
    /// Internal transmittance (without reflections) of the reference thickness.
    pub transmittance: Curve,
    /// The reference thickness, mm; `None` for that of the wind-screen.
    pub thickness_mm: Option<f64>,
}

/// What a wind-screen is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct WindscreenParameters {
    /// Where it stands: the origin on its inner face, z outwards.
    pub placement: Placement,
    /// Radius of curvature of the inner face to left and right, mm, its centre on the camera's side; infinite for none.
    pub radius_across_mm: f64,
    /// The same upwards and downwards.
    pub radius_upright_mm: f64,
    /// Layers, from the camera outwards.
    pub layers: Vec<Layer>,
    /// Angle by which the glass grows thicker upwards, rad; it lies in the middle layer.
    pub wedge_rad: f64,
    /// Absorption.
    pub tint: Option<Tint>,
    /// What the outer faces let through.
    pub coating: Coating,
    /// Share of samples that look for the double image; 0 for no double image, `None` for as much as it has light.
    pub double_image_fraction: Option<f64>,
}

pub(super) fn check(p: &WindscreenParameters) -> Result<(), FrontError> {
    if p.layers.is_empty() {
        return Err(FrontError::NoLayers);
    }
    for layer in &p.layers {
        positive("thickness_mm", layer.thickness_mm)?;
        let (low, high) = layer.index.range();
        if !(low > 1.0 && high <= 4.0) {
            let value = if low > 1.0 { high } else { low };
            return Err(FrontError::Share { name: "index", value, range: "above 1 and at most 4" });
        }
    }
    for (name, radius) in [("radius_across_mm", p.radius_across_mm), ("radius_upright_mm", p.radius_upright_mm)] {
        if radius.is_nan() || radius <= 0.0 {
            return Err(FrontError::Number { name, value: radius, range: "above 0" });
        }
    }
    if p.wedge_rad.is_nan() || p.wedge_rad.abs() > 0.1 {
        return Err(FrontError::Number {
            name: "wedge_mrad", value: 1e3 * p.wedge_rad, range: "within −100 and 100"
        });
    }
    if let Some(share) = p.double_image_fraction.filter(|share| !(0.0..1.0).contains(share)) {
        return Err(FrontError::Number {
            name: "double_image_sample_fraction",
            value: share,
            range: "at least 0 and below 1",
        });
    }
    let Some(tint) = &p.tint else { return Ok(()) };
    tint.thickness_mm.map_or(Ok(1.0), |mm| positive("reference_thickness_mm", mm))?;
    let (low, high) = tint.transmittance.range();
    let value = if low >= 0.0 { high } else { low };
    let right = low >= 0.0 && high <= 1.0 && high > 0.0;
    let range = "0 and 1, not all 0";
    if right { Ok(()) } else { Err(FrontError::Share { name: "internal_transmittance", value, range }) }
}
