//! The body of an opening, and its projected area.

use core::f64::consts::{PI, TAU};

use etendue_core::maths::f64::sin_cos;
use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::mesh::{self, SIDES, polygon_area};
use crate::{geometry::Mesh, lights::profile::Profile};

/// Minimum and maximum extent of an opening, m.
const EXTENT_RANGE_M: [f64; 2] = [1e-4, 100.0];

/// Minimum cosine at which the area of a flat face is evaluated; closer to its plane, the area is that at this cosine.
const MIN_COS: f32 = 1e-3;

/// Maximum fraction of the flux that a flat opening may lose towards its own plane. An isotropic lamp loses half of [`MIN_COS`].
const MAX_LOST_FRACTION: f64 = 0.01;

/// Directions in the plane of a flat opening over which its loss is summed: steps of 0.1°.
const LOSS_DIRECTIONS: u32 = 3600;

/// Error of an opening.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OpeningError {
    /// An extent is out of range.
    #[error(
        "the opening is {} × {} × {} m (along the light's x, y, z); each extent must be between 0.0001 and 100 m, or 0 for one \
         extent of a flat opening",
        extents_m[0], extents_m[1], extents_m[2]
    )]
    Extents {
        /// Along the lamp's axes, m.
        extents_m: [f64; 3],
    },
    /// The lamp emits along the plane of its opening.
    #[error(
        "{:.1} % of the light is emitted along the plane of the flat opening, where the opening has no projected area: turn the \
         opening towards the emission, or give a body (sphere, tube)",
        100.0 * fraction
    )]
    EdgeOn {
        /// Fraction of the flux that would be lost.
        fraction: f64,
    },
}

/// Body of an opening.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OpeningBody {
    /// A box, or a rectangle if it has no extent along one axis.
    Box,
    /// A cylinder along the lamp's axis of this number (0 x, 1 y, 2 z), or a disc if it has no extent along it. Elliptic if its other
    /// extents differ.
    Cylinder(usize),
    /// A sphere, or an ellipsoid.
    Ellipsoid,
}

/// A luminous opening about the lamp's position, in the lamp's frame (x forward, y left, z up).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    pub(super) body: OpeningBody,
    /// Half extents along the lamp's axes, m.
    pub(super) half_m: DVec3,
    /// Area of one side of the faces across x, y and z, m²; 0 if there is no such face.
    faces_m2: Vec3,
}

impl Opening {
    /// An opening with extents along the lamp's x, y and z, m.
    ///
    /// # Errors
    /// If an extent is not 0.0001 to 100 m, except one of a flat opening, which is 0.
    pub fn new(body: OpeningBody, extents_m: [f64; 3]) -> Result<Self, OpeningError> {
        let [min_m, max_m] = EXTENT_RANGE_M;
        let legal = |axis: usize| (min_m..=max_m).contains(&extents_m[axis]);
        let may_be_flat = |axis: usize| match body {
            OpeningBody::Box => (0..3).all(|other| other == axis || legal(other)),
            OpeningBody::Cylinder(along) => axis == along,
            OpeningBody::Ellipsoid => false,
        };
        if (0..3).all(|axis| legal(axis) || (extents_m[axis] == 0.0 && may_be_flat(axis))) {
            let half_m = DVec3::from_array(extents_m) * 0.5;
            Ok(Self { body, half_m, faces_m2: faces_m2(body, half_m) })
        } else {
            Err(OpeningError::Extents { extents_m })
        }
    }

    /// Checks that `profile` can leave the opening.
    ///
    /// # Errors
    /// If more than a hundredth of the light would leave along the plane of a flat opening.
    pub fn check(&self, profile: &Profile) -> Result<(), OpeningError> {
        let fraction = self.lost_fraction(profile);
        if fraction > MAX_LOST_FRACTION { Err(OpeningError::EdgeOn { fraction }) } else { Ok(()) }
    }

    /// Fraction of a profile's flux that is lost along the plane of a flat opening, ∫ (1 − |c|/10⁻³) dc dφ over |c| < 10⁻³ with the cosine
    /// c from the plane's normal; 0 for bodies.
    #[must_use]
    pub fn lost_fraction(&self, profile: &Profile) -> f64 {
        let Some(axis) = self.flat_axis().filter(|_| profile.flux_sr() > 0.0) else { return 0.0 };
        let value = |k: u32| {
            let (sin, cos) = sin_cos(TAU * f64::from(k) / f64::from(LOSS_DIRECTIONS));
            let mut direction = DVec3::ZERO;
            (direction[(axis + 1) % 3], direction[(axis + 2) % 3]) = (cos, sin);
            // Thirds of the triangle's base are approximately its root mean square.
            let at = |cos: f64| {
                let mut aside = direction;
                aside[axis] = cos;
                f64::from(profile.value(aside.normalize().as_vec3()))
            };
            let min_cos = f64::from(MIN_COS);
            (at(-min_cos / 3.0) + at(0.0) + at(min_cos / 3.0)) / 3.0
        };
        let mean = (0..LOSS_DIRECTIONS).map(value).sum::<f64>() / f64::from(LOSS_DIRECTIONS);
        f64::from(MIN_COS) * TAU * mean / profile.flux_sr()
    }

    /// The axis across a flat opening.
    pub(in crate::lights) fn flat_axis(&self) -> Option<usize> {
        (0..3).find(|axis| self.half_m[*axis] == 0.0)
    }

    /// Projected area seen from far along the unit `direction` of the lamp's frame, m²: positive.
    #[must_use]
    pub fn projected_area_m2(&self, direction: Vec3) -> f32 {
        let faces = self.faces_m2;
        let half = self.half_m.as_vec3();
        match (self.body, self.flat_axis()) {
            (OpeningBody::Ellipsoid, _) => (faces * direction).length(),
            (_, Some(axis)) => faces[axis] * direction[axis].abs().max(MIN_COS),
            (OpeningBody::Box, None) => faces.dot(direction.abs()),
            (OpeningBody::Cylinder(along), None) => {
                let (p, q) = ((along + 1) % 3, (along + 2) % 3);
                let across = glam::Vec2::new(half[q] * direction[p], half[p] * direction[q]);
                4.0 * half[along] * across.length() + faces[along] * direction[along].abs()
            }
        }
    }

    /// Minimum of these areas, m².
    pub(in crate::lights) fn min_projected_area_m2(&self) -> f32 {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        // Projected areas of bodies are smallest along an axis, those of flat openings in their plane.
        axes.into_iter().map(|axis| self.projected_area_m2(axis)).fold(f32::INFINITY, f32::min)
    }

    /// Radius of the sphere about the lamp's position that holds it, m.
    pub(in crate::lights) fn reach_m(&self) -> f64 {
        match self.body {
            OpeningBody::Ellipsoid => self.half_m.max_element(),
            OpeningBody::Box => self.half_m.length(),
            OpeningBody::Cylinder(along) => {
                let radius_m = self.half_m[(along + 1) % 3].max(self.half_m[(along + 2) % 3]);
                // The corners of a polygon as large as a circle lie outside of it.
                let corner = mesh::disc_reach().max(mesh::tube_reach());
                (corner * corner * radius_m * radius_m + self.half_m[along] * self.half_m[along]).sqrt()
            }
        }
    }

    /// Its surface in the frame that [`Opening::to_lamp`] transforms to the lamp's; `None` for a sphere of radius 1.
    #[must_use]
    pub fn mesh(&self) -> Option<Mesh> {
        match self.body {
            OpeningBody::Ellipsoid => None,
            OpeningBody::Box => Some(mesh::cuboid(self.half_m)),
            OpeningBody::Cylinder(along) => Some(mesh::cylinder(self.half_m, along)),
        }
    }

    /// Number of parallelograms of two triangles with which its mesh begins; polygons of [`SIDES`] triangles follow.
    pub(super) fn parallelograms(&self) -> usize {
        match (self.body, self.flat_axis()) {
            (OpeningBody::Box, Some(_)) => 1,
            (OpeningBody::Box, None) => 6,
            (OpeningBody::Cylinder(_), None) => SIDES as usize,
            (OpeningBody::Cylinder(_), Some(_)) | (OpeningBody::Ellipsoid, _) => 0,
        }
    }

    /// Transform from the frame of its mesh or sphere to the lamp's.
    #[must_use]
    pub fn to_lamp(&self) -> DAffine3 {
        match self.body {
            OpeningBody::Ellipsoid => DAffine3::from_mat3(DMat3::from_diagonal(self.half_m)),
            OpeningBody::Box | OpeningBody::Cylinder(_) => DAffine3::IDENTITY,
        }
    }
}

/// Areas across x, y and z of one side of the faces; for an ellipsoid those of its sections.
fn faces_m2(body: OpeningBody, half: DVec3) -> Vec3 {
    let across = |axis: usize| half[(axis + 1) % 3] * half[(axis + 2) % 3];
    let areas = DVec3::new(across(0), across(1), across(2));
    match body {
        OpeningBody::Ellipsoid => (areas * PI).as_vec3(),
        OpeningBody::Box => (areas * 4.0).as_vec3(),
        OpeningBody::Cylinder(along) => {
            let mut faces = Vec3::ZERO;
            let reach = if half[along] == 0.0 { mesh::disc_reach() } else { mesh::tube_reach() };
            faces[along] = (areas[along] * polygon_area(reach)) as f32;
            faces
        }
    }
}
