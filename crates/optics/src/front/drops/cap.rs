//! The shape of a drop on glass: a spherical cap.

use core::f64::consts::{FRAC_PI_2, PI};
use etendue_core::maths::f64::sin_cos;

/// A spherical cap of liquid: base radius a and contact angle θ, the angle within the liquid between glass and surface. The
/// sphere has R = a/sin θ, the cap the height h = R(1 − cos θ) and the volume π h (3a² + h²)/6.
///
/// A drop of water keeps this shape while gravity bends it little: for a well below the capillary length √(γ/ρg) = 2.7 mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cap {
    base_mm: f64,
    sine: f64,
    cosine: f64,
}

impl Cap {
    /// A cap of a base radius, mm, and a contact angle, rad, above 0 and below π.
    #[must_use]
    pub fn new(base_mm: f64, contact_angle_rad: f64) -> Self {
        let (sine, cosine) = sin_cos(contact_angle_rad);
        Self { base_mm, sine, cosine }
    }

    /// Radius of the wetted disc, mm.
    #[must_use]
    pub fn base_radius_mm(&self) -> f64 {
        self.base_mm
    }

    /// Radius of the sphere, mm.
    #[must_use]
    pub fn sphere_radius_mm(&self) -> f64 {
        self.base_mm / self.sine
    }

    /// Height above the glass, mm.
    #[must_use]
    pub fn height_mm(&self) -> f64 {
        self.sphere_radius_mm() * (1.0 - self.cosine)
    }

    /// Height of the sphere's centre above the glass, mm; below 0 for contact angles below 90°.
    #[must_use]
    pub fn centre_height_mm(&self) -> f64 {
        -self.sphere_radius_mm() * self.cosine
    }

    /// Volume, mm³ (µl).
    #[must_use]
    pub fn volume_mm3(&self) -> f64 {
        let (a, h) = (self.base_mm, self.height_mm());
        PI * h * (3.0 * a * a + h * h) / 6.0
    }

    /// Focal length R/(n − 1) of the cap as a plano-convex lens in air, paraxially, mm.
    #[must_use]
    pub fn focal_length_mm(&self, index: f64) -> f64 {
        self.sphere_radius_mm() / (index - 1.0)
    }
}

/// How far a cap reaches aside, by its base radius: 1 up to 90°, beyond that the sphere bulges over its base.
pub(super) fn reach_factor(contact_angle_rad: f64) -> f64 {
    if contact_angle_rad > FRAC_PI_2 { 1.0 / sin_cos(contact_angle_rad).0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Figures of a drop of 1 mm at 60°: R 1.1547 mm, h 0.57735 mm, 1.0077 µl, and 3.467 mm of focal length in water of 1.333.
    #[test]
    fn a_drop_of_a_millimetre_at_60_degrees() {
        let cap = Cap::new(1.0, PI / 3.0);
        assert!((cap.sphere_radius_mm() - 1.154_700_538).abs() < 1e-9);
        assert!((cap.height_mm() - 0.577_350_269).abs() < 1e-9);
        assert!((cap.volume_mm3() - 1.007_666).abs() < 1e-6, "{}", cap.volume_mm3());
        assert!((cap.focal_length_mm(1.333) - 3.467_569).abs() < 1e-6, "{}", cap.focal_length_mm(1.333));
        // The circle through the rim and the apex.
        let depth = cap.sphere_radius_mm() - cap.height_mm();
        assert!((depth + cap.centre_height_mm()).abs() < 1e-12);
        assert!((depth * depth + 1.0 - cap.sphere_radius_mm() * cap.sphere_radius_mm()).abs() < 1e-12);
    }

    #[test]
    fn a_half_sphere_and_what_lies_beyond() {
        let half = Cap::new(2.0, FRAC_PI_2);
        assert!((half.volume_mm3() - 16.0 * PI / 3.0).abs() < 1e-12 && (half.height_mm() - 2.0).abs() < 1e-12);
        // At 150° the sphere has twice the base radius.
        assert!((reach_factor(5.0 * PI / 6.0) - 2.0).abs() < 1e-12 && reach_factor(1.0) == 1.0);
        assert!(Cap::new(2.0, 5.0 * PI / 6.0).centre_height_mm() > 0.0);
    }
}
