//! A wind-screen: laminated, tilted, curved glass between the camera and the scene.
//!
//! **Modelled**: Snell's law at every face (lateral offset, and the deflection by curvature and by a wedge); Fresnel's losses (or a
//! coating's) at the two outer faces and Fresnel's at the faces between layers; absorption in the bulk, the internal
//! transmittance τ of a reference thickness d taken to a path ℓ by τ^(ℓ/d) (Beer and Lambert); the double image: light that
//! is reflected once at each outer face inside the glass, R² of what comes straight.
//!
//! **Left out**: light reflected more than twice (R⁴, some 10⁻⁶ at normal incidence) or between the layers (n 1.52 to 1.48: 2·10⁻⁴);
//! polarisation (the mean is taken at each face); coherence; edges: the glass has none; scatter.
//!
//! Frame: origin on the inner face, z outwards along its normal, x to the right, y down. Positive tilt leans the upper edge
//! towards the camera, as in cars.

mod face;
mod trace;

use super::curve::Curve;
use super::error::{FrontError, positive};
use super::{Fate, Line, Stand};
use crate::error::PRINCIPAL_NM;
use crate::prescription::coating::Coating;
use face::Face;
use glam::DVec3;

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
    pub stand: Stand,
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

/// About R² of glass in air, twice 4 %.
const USUAL_SHARE: f64 = 0.002;

/// By which way light comes through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Refracted only.
    Straight,
    /// Reflected at the outer, then (seen from the camera) at the inner face.
    Doubled,
}

/// A wind-screen.
#[derive(Clone, Debug, PartialEq)]
pub struct Windscreen {
    parameters: WindscreenParameters,
    faces: Vec<Face>,
    thickness_mm: f64,
    double_image_fraction: f64,
}

impl Windscreen {
    /// A wind-screen.
    ///
    /// # Errors
    /// Where a number is outside its range, or it stands behind or in the camera.
    pub fn new(parameters: WindscreenParameters) -> Result<Self, FrontError> {
        check(&parameters)?;
        let faces = face::faces(&parameters);
        let thickness_mm = parameters.layers.iter().map(|layer| layer.thickness_mm).sum();
        let mut glass = Self { parameters, faces, thickness_mm, double_image_fraction: 0.0 };
        glass.double_image_fraction = match glass.parameters.double_image_fraction {
            Some(share) => share,
            None => glass.untinted().share_of_double(),
        };
        Ok(glass)
    }

    /// What it was made of.
    #[must_use]
    pub fn parameters(&self) -> &WindscreenParameters {
        &self.parameters
    }

    /// Thickness along the normal, mm.
    #[must_use]
    pub fn thickness_mm(&self) -> f64 {
        self.thickness_mm
    }

    /// Share of samples that look for the double image.
    #[must_use]
    pub fn double_image_fraction(&self) -> f64 {
        self.double_image_fraction
    }

    /// Transmittances on the camera's axis at 587.56 nm: straight, and of the double image; `None` where it is not met.
    #[must_use]
    pub fn axial_transmittances(&self) -> Option<[f64; 2]> {
        let axis = Line { point_mm: DVec3::ZERO, direction: DVec3::Z };
        match (self.through(axis, PRINCIPAL_NM, Way::Straight), self.through(axis, PRINCIPAL_NM, Way::Doubled)) {
            (Fate::On(_, straight), Fate::On(_, doubled)) => Some([straight, doubled]),
            (Fate::On(_, straight), _) => Some([straight, 0.0]),
            _ => None,
        }
    }

    /// The glass without its tint, which may be opaque at the wavelength of the axis's transmittances and not at others.
    fn untinted(&self) -> Self {
        let parameters = WindscreenParameters { tint: None, ..self.parameters.clone() };
        Self { parameters, ..self.clone() }
    }

    /// The double image's share of the light on the axis; of usual glass where the axis does not meet this one.
    fn share_of_double(&self) -> f64 {
        let share = |[straight, doubled]: [f64; 2]| (straight > 0.0).then(|| doubled / (straight + doubled));
        self.axial_transmittances().and_then(share).unwrap_or(USUAL_SHARE)
    }

    /// Whether a ray or its weight depends on the wavelength.
    #[must_use]
    pub fn disperses(&self) -> bool {
        let p = &self.parameters;
        p.layers.iter().any(|layer| layer.index.varies())
            || p.tint.as_ref().is_some_and(|tint| tint.transmittance.varies())
            || matches!(p.coating, Coating::QuarterWave { .. })
    }

    /// Which way a sample looks, by its first number; what is left of that number, and the inverse of the probability.
    pub(super) fn choose(&self, u: f64) -> (Way, f64, f64) {
        let q = self.double_image_fraction;
        if u < q { (Way::Doubled, u / q, 1.0 / q) } else { (Way::Straight, (u - q) / (1.0 - q), 1.0 / (1.0 - q)) }
    }

    /// Whether a point of the camera frame is on the camera's side.
    pub(super) fn is_before(&self, point_mm: DVec3) -> bool {
        let local = self.parameters.stand.inward(Line { point_mm, direction: DVec3::Z });
        self.faces[0].height(local.point_mm).0 < 0.0
    }

    /// Whether `points` of the lens are before the glass and any of `lines` goes through.
    pub(super) fn check(&self, points: &[DVec3], lines: &[Line]) -> Result<(), FrontError> {
        if !points.iter().all(|point| self.is_before(*point)) {
            return Err(FrontError::ThroughLens);
        }
        let mut goes = false;
        for line in lines {
            match self.through(*line, PRINCIPAL_NM, Way::Straight) {
                Fate::Lost => return Err(FrontError::FacesCross),
                Fate::On(..) => goes = true,
                Fate::Past => {}
            }
        }
        if goes { Ok(()) } else { Err(FrontError::NotLookedThrough) }
    }

    /// A ray from the camera, beyond the glass.
    pub(super) fn through(&self, line: Line, nm: f64, way: Way) -> Fate {
        let stand = &self.parameters.stand;
        match trace::through(self, stand.inward(line), nm, way) {
            Fate::On(out, share) => Fate::On(stand.outward(out), share),
            other => other,
        }
    }

    /// Internal transmittance of a path in the glass.
    fn bulk(&self, path_mm: f64, nm: f64) -> f64 {
        match &self.parameters.tint {
            None => 1.0,
            Some(tint) => {
                let reference_mm = tint.thickness_mm.unwrap_or(self.thickness_mm);
                etendue_core::maths::f64::pow(tint.transmittance.at(nm), path_mm / reference_mm)
            }
        }
    }
}

fn check(p: &WindscreenParameters) -> Result<(), FrontError> {
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
