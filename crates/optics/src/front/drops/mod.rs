//! Drops of water on the outer face of a windscreen.
//!
//! **Modelled**: each drop is a spherical cap ([`Cap`]) on the tangent plane of the glass at the drop's centre. A ray that leaves the glass under a
//! drop is refracted into water and, where it meets the sphere, into air; one that leaves next to it may enter another drop from its side. Fresnel
//! losses apply at every surface; total reflection within a drop is followed. Touching drops have coalesced to one of their joint volume, so no two
//! overlap. Image inversion, dark edges and defocus of the drops follow from this.
//!
//! Drops that change over time ([`Course`]) are evaluated at one moment.
//!
//! **Left out**: light partially reflected within a drop or at its outside; light from inside the glass, into which some rays are reflected (they are
//! dark); absorption in the water (below 10⁻³ over a centimetre of it in the visible); gravity, which flattens drops above 2.7 mm and makes them sag;
//! wet trails.
//!
//! Ground truth ignores drops: depth, ids and flow are those of dry glass.

mod coalescence;
mod course;
mod evolution;
mod grid;
mod passage;
mod population;

use glam::{DVec2, DVec3};

use crate::error::FrontError;
use coalescence::reach_factor;
use grid::DiscGrid;

pub use coalescence::Cap;
pub use course::{Course, Droplet, Sliding, Wiper};
pub use population::DropsParameters;

/// Drops on the glass.
#[derive(Clone, Debug, PartialEq)]
pub struct Drops {
    parameters: DropsParameters,
    droplets: Vec<Droplet>,
    bodies: Vec<DropBody>,
    grid: DiscGrid,
    /// Height of the highest drop.
    height_mm: f64,
}

/// A cap in the glass's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DropBody {
    /// Centre of the base, on the glass, mm.
    foot_mm: DVec3,
    /// Outward normal of the glass there.
    normal: DVec3,
    /// Centre of the sphere, mm.
    centre_mm: DVec3,
    radius_mm: f64,
}

/// The glass under the drops: maps a position (x right, y down, mm) to the point of the outer face and the outward normal.
pub(super) type GlassFace<'a> = &'a dyn Fn(DVec2) -> Option<(DVec3, DVec3)>;

impl Drops {
    /// Places drops on a face.
    ///
    /// # Errors
    /// If a number is outside its range, or the glass does not reach as far as the drops.
    pub(super) fn new(parameters: DropsParameters, face: GlassFace<'_>) -> Result<Self, FrontError> {
        population::check(&parameters)?;
        let mut droplets = population::initial(&parameters);
        coalescence::coalesce(&mut droplets, reach_factor(parameters.contact_angle_rad));
        Self::with_droplets(parameters, droplets, face)
    }

    fn with_droplets(
        parameters: DropsParameters,
        droplets: Vec<Droplet>,
        face: GlassFace<'_>,
    ) -> Result<Self, FrontError> {
        let angle = parameters.contact_angle_rad;
        let reach = |d: &Droplet| (d.centre_mm, d.radius_mm * reach_factor(angle));
        let grid = DiscGrid::new(&droplets.iter().map(reach).collect::<Vec<_>>());
        let bodies: Option<Vec<DropBody>> = droplets.iter().map(|d| DropBody::new(d, angle, face)).collect();
        let bodies = bodies.ok_or(FrontError::DropsOffGlass)?;
        let heights = droplets.iter().map(|d| Cap::new(d.radius_mm, angle).height_mm());
        let height_mm = heights.fold(0.0, f64::max);
        Ok(Self { parameters, droplets, bodies, grid, height_mm })
    }

    /// The drops at a time, s, if they change; `down` is the direction of gravity in the glass's frame. Drops that slid off the glass are removed.
    pub(super) fn at(
        &self,
        course: &Course,
        time_s: f64,
        down: DVec3,
        face: GlassFace<'_>,
    ) -> Result<Self, FrontError> {
        let mut droplets = evolution::at(&self.parameters, course, time_s, down.truncate());
        droplets.retain(|drop| face(drop.centre_mm).is_some());
        Self::with_droplets(self.parameters.clone(), droplets, face)
    }

    /// Construction parameters.
    #[must_use]
    pub fn parameters(&self) -> &DropsParameters {
        &self.parameters
    }

    /// The drops on the glass, after coalescence.
    #[must_use]
    pub fn droplets(&self) -> &[Droplet] {
        &self.droplets
    }

    /// Fraction of their rectangle covered by drops (including those that overlap its edge).
    #[must_use]
    pub fn cover(&self) -> f64 {
        let squares: f64 = self.droplets.iter().map(|d| d.radius_mm * d.radius_mm).sum();
        core::f64::consts::PI * squares / (self.parameters.size_mm.x * self.parameters.size_mm.y)
    }

    /// True if a point of the glass lies in their rectangle.
    pub(super) fn is_over(&self, point_mm: DVec3) -> bool {
        let p = &self.parameters;
        ((point_mm.truncate() - p.offset_mm).abs() * 2.0).cmple(p.size_mm).all()
    }
}

impl DropBody {
    fn new(droplet: &Droplet, contact_angle_rad: f64, face: GlassFace<'_>) -> Option<Self> {
        let (foot_mm, normal) = face(droplet.centre_mm)?;
        let cap = Cap::new(droplet.radius_mm, contact_angle_rad);
        let centre_mm = foot_mm + normal * cap.centre_height_mm();
        Some(Self { foot_mm, normal, centre_mm, radius_mm: cap.sphere_radius_mm() })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::front::Curve;
    use core::f64::consts::PI;

    pub(crate) fn parameters() -> DropsParameters {
        DropsParameters {
            offset_mm: DVec2::new(10.0, -20.0),
            size_mm: DVec2::new(200.0, 100.0),
            count: 500,
            radius_mm: [0.3, 2.0],
            size_exponent: 8.0 / 3.0,
            contact_angle_rad: PI / 3.0,
            index: Curve::Constant(1.333),
            seed: 7,
            course: None,
        }
    }

    #[test]
    fn drops_are_those_of_their_seed() {
        let plane = |at: DVec2| Some((at.extend(5.0), DVec3::Z));
        let of = |seed| Drops::new(DropsParameters { seed, ..parameters() }, &plane).expect("legal drops");
        assert_eq!(of(7), of(7));
        assert_ne!(of(7).droplets(), of(8).droplets());
        // Coverage by the law: n π <a²>/A, less the loss of coverage by coalescence at equal volume.
        let cover = of(7).cover();
        assert!(cover > 0.005 && cover < 0.05, "{cover}");
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        let plane = |at: DVec2| Some((at.extend(5.0), DVec3::Z));
        let refused = |p: DropsParameters, name: &str| {
            let error = Drops::new(p, &plane).expect_err("out of range").to_string();
            assert!(error.contains(name), "{error}");
        };
        refused(DropsParameters { count: 0, ..parameters() }, "count");
        refused(DropsParameters { radius_mm: [2.0, 1.0], ..parameters() }, "min_radius_mm");
        refused(DropsParameters { contact_angle_rad: 0.05, ..parameters() }, "contact_angle_deg");
        refused(DropsParameters { contact_angle_rad: 2.7, ..parameters() }, "contact_angle_deg");
        refused(DropsParameters { index: Curve::Constant(1.0), ..parameters() }, "index");
        refused(DropsParameters { size_mm: DVec2::new(10.0, 0.0), ..parameters() }, "size_mm");
        refused(DropsParameters { size_exponent: 7.0, ..parameters() }, "size_exponent");
        assert_eq!(Drops::new(parameters(), &|_| None), Err(FrontError::DropsOffGlass));
    }
}
