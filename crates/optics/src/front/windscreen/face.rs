//! Parameters of a windscreen.
//!
//! Faces of a windscreen: parallel surfaces at a constant distance from the inner one, except for the wedge.
//!
//! The upright section is a circle of radius R_u rotated about an upright axis at the distance R_a behind the vertex: a torus, a sphere for R_a =
//! R_u, a cylinder if one radius is infinite, a plane if both are. The height of a point over it, √((ρ − (R_a − R_u))² + y²) − R_u with ρ its
//! distance from the axis, is its true distance, so parallel faces are those of constant height.

use etendue_core::maths::f64::sin_cos;
use glam::{DMat3, DVec2, DVec3};

use crate::error::front::{FrontError, positive};
use crate::front::{MemberRay, Placement};
use crate::{front::placement::Curve, prescription::coating::Coating};

/// A layer of a windscreen.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    pub thickness_mm: f64,
    /// Refractive index against air.
    pub index: Curve,
}

/// Absorbing glass.
#[derive(Clone, Debug, PartialEq)]
pub struct Tint {
    /// Internal transmittance (without reflections) of the reference thickness.
    pub transmittance: Curve,
    /// The reference thickness, mm; `None`: the thickness of the windscreen.
    pub thickness_mm: Option<f64>,
}

/// Parameters of a windscreen.
#[derive(Clone, Debug, PartialEq)]
pub struct WindscreenParameters {
    /// Placement: the origin is on the inner face, z points outwards.
    pub placement: Placement,
    /// Horizontal radius of curvature of the inner face, mm, its centre on the camera's side; infinite for none.
    pub radius_across_mm: f64,
    /// Vertical radius of curvature, likewise.
    pub radius_upright_mm: f64,
    /// Layers, from the camera outwards.
    pub layers: Vec<Layer>,
    /// Angle by which the glass becomes thicker upwards, rad; it lies in the middle layer.
    pub wedge_rad: f64,
    /// Absorption.
    pub tint: Option<Tint>,
    /// Coating of the outer faces.
    pub coating: Coating,
    /// Fraction of samples that trace the double image; 0: no double image; `None`: its fraction of the light.
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
            return Err(FrontError::Fraction { name: "index", value, range: "above 1 and at most 4" });
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
    if let Some(fraction) = p.double_image_fraction.filter(|fraction| !(0.0..1.0).contains(fraction)) {
        return Err(FrontError::Number {
            name: "double_image_sample_fraction",
            value: fraction,
            range: "at least 0 and below 1",
        });
    }
    let Some(tint) = &p.tint else { return Ok(()) };
    tint.thickness_mm.map_or(Ok(1.0), |mm| positive("reference_thickness_mm", mm))?;
    let (low, high) = tint.transmittance.range();
    let value = if low >= 0.0 { high } else { low };
    let right = low >= 0.0 && high <= 1.0 && high > 0.0;
    let range = "0 and 1, not all 0";
    if right { Ok(()) } else { Err(FrontError::Fraction { name: "internal_transmittance", value, range }) }
}

/// Maximum Newton steps; four or five suffice.
const STEPS: usize = 24;
/// Maximum height of a point on a face, mm: rounding of lengths of metres.
const NEAR_MM: f64 = 1e-10;

/// One face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Face {
    across_mm: f64,
    upright_mm: f64,
    height_mm: f64,
    /// Rotation from the windscreen's frame to the inner face's, about the face's point on the z axis: the wedge.
    turn: DMat3,
}

/// The faces, from the camera outwards.
pub(super) fn faces(p: &WindscreenParameters) -> Vec<Face> {
    let middle = p.layers.len() / 2;
    let mut height_mm = 0.0;
    let heights = core::iter::once(0.0).chain(p.layers.iter().map(|layer| {
        height_mm += layer.thickness_mm;
        height_mm
    }));
    let face = |(i, height_mm): (usize, f64)| {
        let (s, c) = if i > middle { sin_cos(p.wedge_rad) } else { (0.0, 1.0) };
        let turn = DMat3::from_cols(DVec3::X, DVec3::new(0.0, c, s), DVec3::new(0.0, -s, c));
        Face { across_mm: p.radius_across_mm, upright_mm: p.radius_upright_mm, height_mm, turn }
    };
    heights.enumerate().map(face).collect()
}

impl Face {
    /// Distance of a point from the face, outwards positive, and its gradient, the outward normal.
    pub(super) fn height(&self, p: DVec3) -> (f64, DVec3) {
        if self.turn == DMat3::IDENTITY {
            let (height, normal) = self.untilted(p);
            return (height - self.height_mm, normal);
        }
        let vertex = DVec3::new(0.0, 0.0, self.height_mm);
        let (height, normal) = self.untilted(self.turn * (p - vertex) + vertex);
        (height - self.height_mm, self.turn.transpose() * normal)
    }

    fn untilted(&self, p: DVec3) -> (f64, DVec3) {
        let (across, upright) = (self.across_mm, self.upright_mm);
        // Outwards from the axis: the height without vertical curvature, and its direction.
        let (out, direction) = if across.is_finite() {
            let (x, z) = (p.x, p.z + across);
            let rho = (x * x + z * z).sqrt();
            // ρ − R_a without cancellation.
            ((x * x + p.z * (p.z + 2.0 * across)) / (rho + across), DVec3::new(x / rho, 0.0, z / rho))
        } else {
            (p.z, DVec3::Z)
        };
        if !upright.is_finite() {
            return (out, direction);
        }
        let z = out + upright;
        let length = (z * z + p.y * p.y).sqrt();
        let height = (p.y * p.y + out * (out + 2.0 * upright)) / (length + upright);
        (height, direction * (z / length) + DVec3::Y * (p.y / length))
    }

    /// The point of the face at the windscreen's x and y, mm, and its outward normal; `None` if there is none.
    pub(super) fn at(&self, place_mm: DVec2) -> Option<(DVec3, DVec3)> {
        let mut p = place_mm.extend(self.height_mm);
        for _ in 0..STEPS {
            let (height, normal) = self.height(p);
            if normal.z.is_nan() || normal.z <= 0.0 {
                return None;
            }
            if height.abs() < NEAR_MM {
                return Some((p, normal));
            }
            p.z -= height / normal.z;
        }
        None
    }

    /// The point where a ray crosses the face outwards (`sense` 1) or inwards (−1), and the outward normal.
    pub(super) fn crossed(&self, line: &MemberRay, sense: f64) -> Option<(DVec3, DVec3)> {
        let mut p = line.point_mm;
        for _ in 0..STEPS {
            let (height, normal) = self.height(p);
            let along = line.direction.dot(normal);
            if along * sense <= 0.0 {
                return None;
            }
            if height.abs() < NEAR_MM {
                return ((p - line.point_mm).dot(line.direction) >= -NEAR_MM).then_some((p, normal));
            }
            p -= line.direction * (height / along);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::Layer;
    use super::*;
    use crate::front::{Curve, Placement};
    use crate::prescription::coating::Coating;

    fn faces_of(across_mm: f64, upright_mm: f64, wedge_rad: f64) -> Vec<Face> {
        faces(&WindscreenParameters {
            placement: Placement::with_rotation_deg(DVec3::ZERO, [0.0; 3]),
            radius_across_mm: across_mm,
            radius_upright_mm: upright_mm,
            layers: vec![Layer { thickness_mm: 5.0, index: Curve::Constant(1.5) }],
            wedge_rad,
            tint: None,
            coating: Coating::Uncoated,
            double_image_fraction: None,
        })
    }

    #[test]
    fn heights_are_distances() {
        let inf = f64::INFINITY;
        for (across, upright) in [(inf, inf), (3000.0, inf), (inf, 8000.0), (3000.0, 3000.0), (3000.0, 8000.0)] {
            let face = faces_of(across, upright, 0.0)[1];
            let p = DVec3::new(210.0, -130.0, -20.0);
            let (height, normal) = face.height(p);
            assert!((normal.length() - 1.0).abs() < 1e-14);
            // The face lies straight below, along the normal.
            let (rest, below) = face.height(p - normal * height);
            assert!(rest.abs() < 1e-11 && (below - normal).length() < 1e-12, "{across} {upright}: {rest}");
        }
        let (height, _) = faces_of(3000.0, 3000.0, 0.0)[0].height(DVec3::new(100.0, 50.0, -7.0));
        // A sphere about (0, 0, −3000).
        let exact = (100.0_f64 * 100.0 + 50.0 * 50.0 + 2993.0 * 2993.0).sqrt() - 3000.0;
        assert!((height - exact).abs() < 1e-11);
    }

    #[test]
    fn a_positive_wedge_is_thicker_above() {
        let outer = faces_of(f64::INFINITY, f64::INFINITY, 0.001)[1];
        let (above, below) =
            (outer.height(DVec3::new(0.0, -100.0, 5.0)).0, outer.height(DVec3::new(0.0, 100.0, 5.0)).0);
        assert!((above + 0.1).abs() < 1e-6 && (below - 0.1).abs() < 1e-6, "{above} {below}: 100 mm by 1 mrad");
    }
}
