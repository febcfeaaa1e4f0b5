//! Parameters of drops on glass, and drops as they arrive on it.
//!
//! Arriving drops are independent of each other and uniform over the rectangle; their sizes follow a power law.
//!
//! The number density by base radius falls as a^(−exponent). The usual exponent, 8/3, is that of drops that condense and coalesce: the fraction of
//! the area under drops above a is 1 − (a/a_max)^(1/3) (E. J. Le Fevre and J. W. Rose, "A theory of heat transfer by dropwise condensation", Third
//! International Heat Transfer Conference, 1966).

use core::f64::consts::PI;

use etendue_core::{maths::f64::pow, random::philox4x32};
use glam::DVec2;

use super::course::{Course, Droplet};
use crate::error::front::{FrontError, positive};
use crate::front::placement::Curve;

/// Maximum number of initial drops.
const MAX_COUNT: u32 = 1_000_000;

/// Parameters of drops on glass.
#[derive(Clone, Debug, PartialEq)]
pub struct DropsParameters {
    /// Centre of the drops' rectangle in the glass's frame (x right, y down), mm.
    pub offset_mm: DVec2,
    /// Width and height of the rectangle, mm.
    pub size_mm: DVec2,
    /// Number of initial drops before coalescence; 1 to 1 000 000, or 0 if others arrive.
    pub count: u32,
    /// Smallest and largest base radius, mm, before coalescence.
    pub radius_mm: [f64; 2],
    /// The size law: the number density by base radius falls as a^(−exponent) between the two, 0 … 6.
    pub size_exponent: f64,
    /// Angle within the water between glass and surface, rad, 5° … 150°.
    pub contact_angle_rad: f64,
    /// Refractive index of the water against air.
    pub index: Curve,
    /// Seed of positions and sizes.
    pub seed: u64,
    /// Change over time; `None` for static drops.
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
    let min_count = if arrive { 0.0 } else { 1.0 };
    within(
        "count",
        f64::from(p.count),
        min_count,
        f64::from(MAX_COUNT),
        "1 to 1 000 000 drops, or 0 if others arrive",
    )?;
    let [minimum, maximum] = p.radius_mm;
    positive("min_radius_mm", minimum)?;
    positive("max_radius_mm", maximum)?;
    within("min_radius_mm", minimum, 0.0, maximum, "at most max_radius_mm")?;
    p.course.map_or(Ok(()), |course| course.check(maximum))?;
    within("size_exponent", p.size_exponent, 0.0, 6.0, "0 to 6")?;
    let degrees = p.contact_angle_rad * 180.0 / PI;
    within("contact_angle_deg", degrees, 5.0 - 1e-9, 150.0 + 1e-9, "5 to 150")?;
    let (low, high) = p.index.range();
    if low > 1.0 && high <= 4.0 {
        return Ok(());
    }
    let value = if low > 1.0 { high } else { low };
    Err(FrontError::Fraction { name: "the water's refractive index", value, range: "above 1 and at most 4" })
}

/// Batch of drops that an address belongs to.
#[derive(Clone, Copy, Debug)]
pub(super) enum Batch {
    /// Initial drops.
    First = 0,
    /// Drops that arrive later.
    Later = 1,
}

/// Separates these random numbers from others of the same seed.
const DOMAIN: u32 = 0x6472_6f70;

/// The drop of a number, and a further number of its own in (0, 1): a pure function of it and the seed.
pub(super) fn droplet(p: &DropsParameters, batch: Batch, number: u64) -> (Droplet, f64) {
    let word = |w: u32| (f64::from(w) + 0.5) / 4_294_967_296.0;
    let counter = [number as u32, (number >> 32) as u32, batch as u32, DOMAIN];
    let [x, y, size, further] = philox4x32(counter, [p.seed as u32, (p.seed >> 32) as u32]).map(word);
    let centre_mm = p.offset_mm + (DVec2::new(x, y) - 0.5) * p.size_mm;
    (Droplet { centre_mm, radius_mm: radius_mm(p, size) }, further)
}

/// Initial drops before coalescence.
pub(super) fn initial(p: &DropsParameters) -> Vec<Droplet> {
    (0..u64::from(p.count)).map(|number| droplet(p, Batch::First, number).0).collect()
}

/// The base radius, mm, below which the fraction `u` of drops lies.
fn radius_mm(p: &DropsParameters, u: f64) -> f64 {
    let [minimum, maximum] = p.radius_mm;
    let power = 1.0 - p.size_exponent;
    let radius = if power.abs() < 1e-9 {
        minimum * pow(maximum / minimum, u)
    } else {
        let (low, high) = (pow(minimum, power), pow(maximum, power));
        pow(low + u * (high - low), 1.0 / power)
    };
    radius.clamp(minimum, maximum)
}

#[cfg(test)]
mod tests {
    use super::super::tests::parameters;
    use super::*;

    /// The fraction of drops below a radius is that of the truncated power law; 4 σ of the binomial spread.
    #[test]
    fn sizes_follow_the_law() {
        for exponent in [0.0, 1.0, 8.0 / 3.0] {
            let p = DropsParameters { count: 20_000, radius_mm: [0.2, 2.0], size_exponent: exponent, ..parameters() };
            let drops = initial(&p);
            for radius in [0.3_f64, 0.7, 1.5] {
                let fraction = match exponent {
                    1.0 => etendue_core::maths::f64::ln(radius / 0.2) / etendue_core::maths::f64::ln(10.0),
                    _ => {
                        let power = |r: f64| pow(r, 1.0 - exponent);
                        (power(radius) - power(0.2)) / (power(2.0) - power(0.2))
                    }
                };
                let below = drops.iter().filter(|d| d.radius_mm < radius).count() as f64;
                let sigma = (20_000.0 * fraction * (1.0 - fraction)).sqrt();
                assert!((below - 20_000.0 * fraction).abs() < 4.0 * sigma, "{exponent} {radius}: {below}");
            }
            let left = drops.iter().filter(|d| d.centre_mm.x < p.offset_mm.x).count() as f64;
            assert!((left - 10_000.0).abs() < 4.0 * 70.7);
        }
    }
}
