//! The radial polynomial r′ = r (1 + k₁ r² + k₂ r⁴) of [`RadialDistortion`], in either direction, after a perspective.
//!
//! Lengths are principal distances here, where [`RadialDistortion`] says mm: a unit of 1 makes r the tangent of the
//! field angle.

use etendue_core::maths::f64::atan;
use glam::{DVec2, DVec3};

use super::profile::{Edge, Projection, Sight};
use crate::radial::RadialDistortion;

impl Projection for RadialDistortion {
    fn edge(&self) -> Edge {
        let fold = self.fold_ideal_mm();
        if fold.is_finite() { Edge::fold(atan(fold)) } else { Edge::FRONT }
    }

    fn project(&self, direction: DVec3) -> Option<DVec2> {
        let in_front = direction.z > 0.0;
        in_front.then(|| self.observed(direction.truncate() / direction.z))?.filter(|p| p.is_finite())
    }

    fn unproject(&self, point: DVec2) -> Option<DVec3> {
        Some(self.ideal(point)?.extend(1.0).normalize())
    }

    fn solid_angle_per_area(&self, point: DVec2) -> Option<f64> {
        per_area(self, point, self.ideal(point)?)
    }

    fn sight(&self, point: DVec2) -> Option<Sight> {
        let ideal = self.ideal(point)?;
        Some(Sight { direction: ideal.extend(1.0).normalize(), sr_per_area: per_area(self, point, ideal)? })
    }
}

/// dΩ/dA of an image point whose gnomonic point is known.
fn per_area(distortion: &RadialDistortion, point: DVec2, ideal: DVec2) -> Option<f64> {
    let square = 1.0 + ideal.length_squared();
    Some(distortion.ideal_area_per_observed(point.length())? / (square * square.sqrt()))
}
