//! A lens known only by its ray-transfer functions: from a ray on a plane before the lens to the ray that leaves it.
//!
//! T. Goossens, Z. Lyu, J. Ko, G. C. Wan, J. Farrell and B. Wandell, "Ray-transfer functions for camera simulation of 3D scenes with hidden lens
//! design", Optics Express 30 (2022) 24031. For a lens of revolution three numbers describe a ray from the sensor: its height ρ on the input plane,
//! and dx and dy of its unit direction in the frame whose y axis goes through the point of that height. Polynomials in them give the point and the
//! direction behind the lens, in the same frame, wavelength by wavelength; a region of a plane defines the rays that pass.
//!
//! Frame: z from the sensor to the scene, mm, x right and y up as seen from behind. The **rear vertex** is the last surface of the lens before the
//! sensor; the input plane lies `input_offset_mm` before it towards the sensor, the front vertex `thickness_mm` behind it. A fitted point's z counts
//! from the front vertex.

mod error;

use glam::{DVec2, DVec3};

pub use error::RayTransferError;

/// The functions of one wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    pub wavelength_nm: f64,
    /// The rays that pass.
    pub pass: RayPass,
    /// x, y and z of the point (mm), z from the front vertex.
    pub point: [Polynomial; 3],
    /// dx and dy of the unit direction.
    pub direction: [Polynomial; 2],
    /// A polynomial with the sign of dz; `None` if all rays go forwards.
    pub forwards: Option<Polynomial>,
}

/// Ray-transfer functions of a lens.
#[derive(Clone, Debug, PartialEq)]
pub struct RayTransfer {
    thickness_mm: f64,
    input_offset_mm: f64,
    transfers: Vec<Transfer>,
    max_power: usize,
}

/// A ray from the sensor, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransferRay {
    /// A point on the ray.
    pub point_mm: DVec3,
    /// Unit direction.
    pub direction: DVec3,
}

impl RayTransfer {
    /// Creates the functions from transfers by increasing wavelength.
    ///
    /// # Errors
    /// If there are none, or their wavelengths do not increase.
    pub fn new(thickness_mm: f64, input_offset_mm: f64, transfers: Vec<Transfer>) -> Result<Self, RayTransferError> {
        let rising = transfers.windows(2).all(|pair| pair[1].wavelength_nm > pair[0].wavelength_nm);
        let first = transfers.first().is_some_and(|t| t.wavelength_nm > 0.0);
        if !(first && rising && thickness_mm.is_finite() && input_offset_mm.is_finite()) {
            return Err(RayTransferError::Wavelengths);
        }
        let powers = |t: &Transfer| {
            t.point.iter().chain(&t.direction).chain(&t.forwards).map(Polynomial::max_power).max().unwrap_or(0)
        };
        let max_power = transfers.iter().map(powers).max().unwrap_or(0);
        Ok(Self { thickness_mm, input_offset_mm, transfers, max_power })
    }

    /// Distance from the rear vertex to the front vertex, mm.
    #[must_use]
    pub fn thickness_mm(&self) -> f64 {
        self.thickness_mm
    }

    /// Distance from the rear vertex to the input plane, towards the sensor, mm.
    #[must_use]
    pub fn input_offset_mm(&self) -> f64 {
        self.input_offset_mm
    }

    /// The functions, by increasing wavelength.
    #[must_use]
    pub fn transfers(&self) -> &[Transfer] {
        &self.transfers
    }

    /// The index of the functions nearest to a wavelength.
    #[must_use]
    pub fn nearest(&self, nm: f64) -> usize {
        let off = |i: &usize| (self.transfers[*i].wavelength_nm - nm).abs();
        (0..self.transfers.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
    }

    /// Distance from the sensor to the plane on which pupil points are chosen, mm; the sensor is `sensor_mm` behind the rear vertex.
    pub(crate) fn pupil_distance_mm(&self, sensor_mm: f64) -> f64 {
        sensor_mm - self.input_offset_mm + self.transfers[0].pass.plane_mm
    }

    /// True if the functions of an index pass a ray from a sensor point to a point of the pupil plane (mm).
    #[inline]
    pub(crate) fn passes(&self, index: usize, from: &Entry) -> bool {
        let pass = &self.transfers[index].pass;
        let at = DVec2::new(0.0, from.height_mm) + from.direction.truncate() * (pass.plane_mm / from.direction.z);
        pass.passes(from.height_mm, at)
    }

    /// The ray that leaves the lens at a wavelength, whether it passes or not. Linear between two wavelengths, constant beyond the ends. `None` if
    /// the functions give no direction.
    #[inline]
    pub(crate) fn exit_ray(&self, from: &Entry, sensor_mm: f64, nm: f64) -> Option<TransferRay> {
        let numbers = [from.height_mm, from.direction.x, from.direction.y];
        let powers = Powers::new(numbers, self.max_power);
        let after = self.transfers.partition_point(|t| t.wavelength_nm < nm);
        let (first, last) = (after.saturating_sub(1), after.min(self.transfers.len() - 1));
        let [a, b] = [first, last].map(|i| &self.transfers[i]);
        let (mut point, mut slope, mut sign) = a.at(&powers);
        if first != last {
            let fraction = (nm - a.wavelength_nm) / (b.wavelength_nm - a.wavelength_nm);
            let (other_point, other_slope, other_sign) = b.at(&powers);
            (point, slope) = (point.lerp(other_point, fraction), slope.lerp(other_slope, fraction));
            sign = if fraction < 0.5 { sign } else { other_sign };
        }
        let rest = 1.0 - slope.length_squared();
        let direction = from.to_frame(slope).extend(if rest > 0.0 { rest.sqrt() * sign } else { return None });
        let across = from.to_frame(point.truncate());
        let point_mm = across.extend(sensor_mm + self.thickness_mm + point.z);
        (point_mm.is_finite() && direction.is_finite()).then_some(TransferRay { point_mm, direction })
    }

    /// The point on the input plane of a ray from a sensor point (mm) to a point of the pupil plane.
    #[inline]
    pub(crate) fn entry(&self, sensor_point_mm: DVec2, pupil_mm: DVec2, sensor_mm: f64) -> Entry {
        let distance_mm = self.pupil_distance_mm(sensor_mm);
        let across = pupil_mm - sensor_point_mm;
        let at = sensor_point_mm + across * ((sensor_mm - self.input_offset_mm) / distance_mm);
        let height_mm = at.length();
        let meridian = if height_mm > 0.0 { at / height_mm } else { DVec2::Y };
        let direction = across.extend(distance_mm).normalize();
        let turned =
            DVec2::new(direction.x * meridian.y - direction.y * meridian.x, direction.truncate().dot(meridian));
        Entry { height_mm, meridian, direction: turned.extend(direction.z) }
    }
}

impl Transfer {
    /// Point, dx and dy, and the sign of dz.
    #[inline]
    fn at(&self, powers: &Powers) -> (DVec3, DVec2, f64) {
        let [x, y, z] = [0, 1, 2].map(|i| self.point[i].at(powers));
        let [dx, dy] = [0, 1].map(|i| self.direction[i].at(powers));
        let sign = self.forwards.as_ref().map_or(1.0, |polynomial| polynomial.at(powers).signum());
        (DVec3::new(x, y, z), DVec2::new(dx, dy), sign)
    }
}

/// A ray on the input plane, in the frame whose y axis goes through it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Entry {
    height_mm: f64,
    /// The y axis of the frame.
    meridian: DVec2,
    /// Unit direction in that frame.
    pub(crate) direction: DVec3,
}

impl Entry {
    /// Transforms a vector from this frame to that of the lens.
    fn to_frame(self, v: DVec2) -> DVec2 {
        DVec2::new(self.meridian.y, -self.meridian.x) * v.x + self.meridian * v.y
    }
}

/// The ellipse passed by rays of one height, its axes along the meridian (y) and across it (x), mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassEllipse {
    /// Height on the input plane, mm.
    pub height_mm: f64,
    pub centre_mm: DVec2,
    /// Semi-axes.
    pub radii_mm: DVec2,
}

/// A circle passed by rays, its centre on the meridian in proportion to the height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassCircle {
    pub radius_mm: f64,
    /// Height of its centre over the height on the input plane.
    pub sensitivity: f64,
}

/// The open region of the plane.
#[derive(Clone, Debug, PartialEq)]
pub enum PassRegion {
    /// One ellipse, interpolated linearly between the tabulated heights; nothing passes beyond the last.
    Ellipses(Vec<PassEllipse>),
    /// The intersection of circles.
    Circles(Vec<PassCircle>),
}

/// The rays that pass.
#[derive(Clone, Debug, PartialEq)]
pub struct RayPass {
    /// Position of the plane, from the input plane towards the scene, mm.
    plane_mm: f64,
    region: PassRegion,
}

impl RayPass {
    /// Creates the region of the plane at `plane_mm` from the input plane.
    ///
    /// # Errors
    /// If the heights do not increase from 0, the region is empty or a value is not a number.
    pub fn new(plane_mm: f64, region: PassRegion) -> Result<Self, RayTransferError> {
        let legal = match &region {
            PassRegion::Ellipses(list) => {
                let finite = |e: &PassEllipse| {
                    e.centre_mm.is_finite() && e.radii_mm.is_finite() && e.radii_mm.min_element() >= 0.0
                };
                let rising = list.windows(2).all(|pair| pair[1].height_mm > pair[0].height_mm);
                let first = list.first().is_some_and(|e| e.height_mm == 0.0 && e.radii_mm.min_element() > 0.0);
                first && rising && list.iter().all(|e| finite(e) && e.height_mm.is_finite())
            }
            PassRegion::Circles(list) => {
                let legal = |c: &PassCircle| c.radius_mm > 0.0 && c.radius_mm.is_finite() && c.sensitivity.is_finite();
                !list.is_empty() && list.iter().all(legal)
            }
        };
        if legal && plane_mm.is_finite() { Ok(Self { plane_mm, region }) } else { Err(RayTransferError::Pass) }
    }

    /// True if a ray of a height passes that meets the plane at this point (y along the meridian).
    #[inline]
    fn passes(&self, height_mm: f64, at_mm: DVec2) -> bool {
        match &self.region {
            PassRegion::Ellipses(list) => ellipse(list, height_mm)
                .is_some_and(|(centre, radii)| ((at_mm - centre) / radii).length_squared() <= 1.0),
            PassRegion::Circles(list) => list.iter().all(|circle| {
                let centre = DVec2::new(0.0, circle.sensitivity * height_mm);
                (at_mm - centre).length_squared() < circle.radius_mm * circle.radius_mm
            }),
        }
    }

    /// The height on the input plane beyond which nothing passes, mm; infinite if there is none.
    #[must_use]
    pub fn max_height_mm(&self) -> f64 {
        match &self.region {
            PassRegion::Ellipses(list) => list.last().map_or(0.0, |last| last.height_mm),
            PassRegion::Circles(_) => f64::INFINITY,
        }
    }

    /// Radius of the region for rays of height 0, mm.
    pub(crate) fn radius_on_axis_mm(&self) -> f64 {
        match &self.region {
            PassRegion::Ellipses(list) => list.first().map_or(0.0, |e| e.radii_mm.max_element() + e.centre_mm.length()),
            PassRegion::Circles(list) => list.iter().map(|c| c.radius_mm).fold(f64::INFINITY, f64::min),
        }
    }
}

/// Centre and semi-axes at a height.
#[inline]
fn ellipse(list: &[PassEllipse], height_mm: f64) -> Option<(DVec2, DVec2)> {
    let after = list.partition_point(|e| e.height_mm < height_mm);
    let right = list.get(after)?;
    let Some(left) = after.checked_sub(1).map(|i| &list[i]) else { return Some((right.centre_mm, right.radii_mm)) };
    let fraction = (height_mm - left.height_mm) / (right.height_mm - left.height_mm);
    Some((left.centre_mm.lerp(right.centre_mm, fraction), left.radii_mm.lerp(right.radii_mm, fraction)))
}

/// The highest power that is evaluated.
pub const MAX_POWER: usize = 32;

/// c ρ^a dx^b dy^d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// The coefficient, in the unit of the value over mm^a.
    pub coefficient: f64,
    /// Powers of the height ρ (mm), of dx and of dy.
    pub powers: [u8; 3],
}

/// A polynomial in the height ρ on the input plane (mm) and in the direction's components dx and dy.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polynomial {
    terms: Vec<Term>,
}

impl Polynomial {
    /// Creates the sum of terms.
    ///
    /// # Errors
    /// If a coefficient is not finite or a power is above [`MAX_POWER`].
    pub fn new(terms: Vec<Term>) -> Result<Self, RayTransferError> {
        let legal = |t: &Term| t.coefficient.is_finite() && t.powers.iter().all(|p| usize::from(*p) <= MAX_POWER);
        if terms.iter().all(legal) { Ok(Self { terms }) } else { Err(RayTransferError::Polynomial) }
    }

    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self { terms: vec![Term { coefficient: value, powers: [0; 3] }] }
    }

    #[inline]
    fn at(&self, powers: &Powers) -> f64 {
        let value = |t: &Term| t.coefficient * powers.power(0, t) * powers.power(1, t) * powers.power(2, t);
        self.terms.iter().map(value).sum()
    }

    fn max_power(&self) -> usize {
        self.terms.iter().flat_map(|t| t.powers).max().map_or(0, usize::from)
    }
}

/// Powers of ρ, dx and dy.
struct Powers([[f64; MAX_POWER + 1]; 3]);

impl Powers {
    #[inline]
    fn new(numbers: [f64; 3], maximum: usize) -> Self {
        Self(numbers.map(|number| {
            let mut powers = [1.0; MAX_POWER + 1];
            (1..=maximum).for_each(|i| powers[i] = powers[i - 1] * number);
            powers
        }))
    }

    #[inline]
    fn power(&self, which: usize, term: &Term) -> f64 {
        self.0[which][usize::from(term.powers[which])]
    }
}
