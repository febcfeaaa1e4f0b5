//! What drops on glass are made of.

use super::course::Course;
use crate::error::front::{FrontError, positive};
use crate::front::curve::Curve;
use core::f64::consts::PI;
use glam::DVec2;

/// Drops at the beginning, at most.
const MAX_COUNT: u32 = 1_000_000;

/// What drops on glass are made of.
#[derive(Clone, Debug, PartialEq)]
pub struct DropsParameters {
    /// Middle of the rectangle that they lie in, in the glass's frame (x right, y down), mm.
    pub offset_mm: DVec2,
    /// Its width and height, mm.
    pub size_mm: DVec2,
    /// How many fell on it before the beginning, before those that touch become one; 1 to 1 000 000, or 0 where others arrive.
    pub count: u32,
    /// Radii of their bases: least and greatest, mm, before those that touch become one.
    pub radius_mm: [f64; 2],
    /// The size law: numbers by base radius a fall as a^(−exponent) between the two, 0 … 6.
    pub size_exponent: f64,
    /// Angle within the water between glass and surface, rad, 5° … 150°.
    pub contact_angle_rad: f64,
    /// Refractive index of the water against air.
    pub index: Curve,
    /// Seed of places and sizes.
    pub seed: u64,
    /// What changes them over time; `None` for drops that stay as they are.
    pub course: Option<Course>,
}

pub(super) fn check(p: &DropsParameters) -> Result<(), FrontError> {
    let within = |name, value: f64, low: f64, high: f64, range| match (low..=high).contains(&value) {
        true => Ok(()),
        false => Err(FrontError::Number { name, value, range }),
    };
    positive("size_mm", p.size_mm.min_element())?;
    positive("size_mm", p.size_mm.max_element())?;
    let arrive = p.course.is_some_and(|course| course.arrivals_hz > 0.0);
    let least_count = if arrive { 0.0 } else { 1.0 };
    within(
        "count",
        f64::from(p.count),
        least_count,
        f64::from(MAX_COUNT),
        "1 to 1 000 000 drops, or 0 where others arrive",
    )?;
    let [least, greatest] = p.radius_mm;
    positive("min_radius_mm", least)?;
    positive("max_radius_mm", greatest)?;
    within("min_radius_mm", least, 0.0, greatest, "at most max_radius_mm")?;
    p.course.map_or(Ok(()), |course| course.check(greatest))?;
    within("size_exponent", p.size_exponent, 0.0, 6.0, "0 to 6")?;
    let degrees = p.contact_angle_rad * 180.0 / PI;
    within("contact_angle_deg", degrees, 5.0 - 1e-9, 150.0 + 1e-9, "5 to 150")?;
    let (low, high) = p.index.range();
    if low > 1.0 && high <= 4.0 {
        return Ok(());
    }
    let value = if low > 1.0 { high } else { low };
    Err(FrontError::Share { name: "the water's index", value, range: "above 1 and at most 4" })
}
