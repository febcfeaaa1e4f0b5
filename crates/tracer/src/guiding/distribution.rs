//! A density of directions in bins of equal cosine-weighted solid angle.
//!
//! The hemisphere is seen from above as a disc, where the cosine's density is uniform (Nusselt's analogue). It has sixteen sectors of equal angle
//! with eight rings of equal area each. Finding the bin of a direction takes only comparisons.

use core::f32::consts::FRAC_PI_4;

use etendue_core::maths::f32::{cos, sin};
use glam::{Vec2, Vec3};

/// Rings, from the normal outwards.
const RINGS: usize = 8;
/// Sectors about the normal, anticlockwise from x.
const SECTORS: usize = 16;
/// All bins.
pub(super) const BINS: usize = RINGS * SECTORS;
/// tan 22.5°.
const TAN_SIXTEENTH: f32 = 0.414_213_56;
/// The largest f32 below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// The bin of a unit direction above a surface, in its shading frame.
#[inline(always)]
pub(crate) fn bin_of(wi: Vec3) -> usize {
    let (quarter, x, y) = in_first_quarter(wi.x, wi.y);
    let is_steep = y > x;
    let (less, more) = if is_steep { (x, y) } else { (y, x) };
    let from_axis = usize::from(less > more * TAN_SIXTEENTH);
    let sector = 4 * quarter + if is_steep { 3 - from_axis } else { from_axis };
    let ring = ((wi.x * wi.x + wi.y * wi.y) * RINGS as f32) as usize;
    sector * RINGS + ring.min(RINGS - 1)
}

/// The quadrant of a point, and the point rotated to the first quadrant.
#[inline(always)]
fn in_first_quarter(x: f32, y: f32) -> (usize, f32, f32) {
    if x > 0.0 && y >= 0.0 {
        (0, x, y)
    } else if x <= 0.0 && y > 0.0 {
        (1, y, -x)
    } else if x < 0.0 {
        (2, -x, -y)
    } else {
        (3, -y, x)
    }
}

/// Neighbouring bins: two in its ring, one or two in its sector.
pub(super) fn neighbours(bin: usize) -> impl Iterator<Item = usize> {
    let (sector, ring) = (bin / RINGS, bin % RINGS);
    let side_bins = [(sector + 1) % SECTORS, (sector + SECTORS - 1) % SECTORS].map(|s| s * RINGS + ring);
    let within = (ring > 0).then(|| bin - 1);
    let beyond = (ring + 1 < RINGS).then_some(bin + 1);
    side_bins.into_iter().chain(within).chain(beyond)
}

/// A density of directions above a diffuse surface, in integers: a path reads one cache line to choose a sector and one for the ring.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct DirectionDistribution {
    /// End of each sector, as a cumulative sum of weights.
    ends: [u32; SECTORS],
    /// Weights of the rings of each sector, 1 or more.
    weights: [[u16; RINGS]; SECTORS],
}

impl DirectionDistribution {
    /// The density proportional to positive `weights` of bins; weights below 1/65 535 of the maximum are raised to it.
    pub(super) fn new(weights: &[f64; BINS]) -> Self {
        let maximum = weights.iter().copied().fold(0.0, f64::max);
        let scaled = weights.map(|weight| (weight / maximum * f64::from(u16::MAX)).round().max(1.0) as u16);
        let weights: [[u16; RINGS]; SECTORS] =
            core::array::from_fn(|sector| core::array::from_fn(|ring| scaled[sector * RINGS + ring]));
        let mut sum = 0;
        let ends = core::array::from_fn(|sector| {
            sum += sum_of(&weights[sector]);
            sum
        });
        Self { ends, weights }
    }

    /// Density of a unit direction above the surface (shading frame) over that of the cosine.
    #[inline(always)]
    pub(crate) fn relative_density(&self, wi: Vec3) -> f32 {
        let bin = bin_of(wi);
        self.relative(self.weights[bin / RINGS][bin % RINGS])
    }

    /// Density of a bin over that of the cosine.
    #[inline(always)]
    fn relative(&self, weight: u16) -> f32 {
        f32::from(weight) * (BINS as f32 / self.ends[SECTORS - 1] as f32)
    }

    /// The direction (unit, shading frame) of a point of the unit square, and its density over that of the cosine.
    #[inline(always)]
    pub(crate) fn sample(&self, u: Vec2) -> (Vec3, f32) {
        let (sector, across) = self.sector(u.x);
        let (ring, out) = self.ring(sector, u.y);
        let squared = (ring as f32 + out) / RINGS as f32;
        let direction = at_angle((sector as f32 + across) * 0.5) * squared.sqrt();
        let wi = Vec3::new(direction.x, direction.y, (1.0 - squared).sqrt());
        (wi, self.relative(self.weights[sector][ring]))
    }

    /// The sector of a number in [0, 1), and its position within it, in [0, 1).
    #[inline(always)]
    fn sector(&self, u: f32) -> (usize, f32) {
        let at = f64::from(u) * f64::from(self.ends[SECTORS - 1]);
        let integer = at as u32;
        let sector = self.ends.iter().map(|end| usize::from(*end <= integer)).sum::<usize>().min(SECTORS - 1);
        let begin = if sector == 0 { 0 } else { self.ends[sector - 1] };
        let part = (at - f64::from(begin)) / f64::from(self.ends[sector] - begin);
        (sector, (part as f32).clamp(0.0, BELOW_ONE))
    }

    /// The ring within a sector, and the position within it.
    #[inline(always)]
    fn ring(&self, sector: usize, u: f32) -> (usize, f32) {
        let weights = &self.weights[sector];
        let at = u * sum_of(weights) as f32;
        let (mut ring, mut begin) = (0, 0.0);
        // The last ring takes the remainder of rounding.
        while ring < RINGS - 1 && at >= begin + f32::from(weights[ring]) {
            begin += f32::from(weights[ring]);
            ring += 1;
        }
        (ring, ((at - begin) / f32::from(weights[ring])).clamp(0.0, BELOW_ONE))
    }
}

/// The sum of a sector's weights.
#[inline(always)]
fn sum_of(weights: &[u16; RINGS]) -> u32 {
    weights.iter().map(|weight| u32::from(*weight)).sum()
}

/// The unit vector at an angle in eighths of a turn, from 0 to 8.
#[inline(always)]
fn at_angle(eighths: f32) -> Vec2 {
    let eighth = eighths as usize;
    let part = eighths - eighth as f32;
    let is_even = eighth.is_multiple_of(2);
    let from_axis = FRAC_PI_4 * if is_even { part } else { 1.0 - part };
    let (along, across) = (cos(from_axis), sin(from_axis));
    let (x, y) = if is_even { (along, across) } else { (across, along) };
    // Rounding may reach the full turn.
    match eighth / 2 % 4 {
        0 => Vec2::new(x, y),
        1 => Vec2::new(-y, x),
        2 => Vec2::new(-x, -y),
        _ => Vec2::new(y, -x),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::random::{Draw, FrameAddress, PathStream, Pixel, PixelAddress};

    fn uneven() -> DirectionDistribution {
        DirectionDistribution::new(&core::array::from_fn(|bin| 0.25 + ((bin * 37) % 23) as f64))
    }

    fn points(count: u32) -> impl Iterator<Item = Vec2> {
        let address = PixelAddress { frame: FrameAddress::default(), pixel: Pixel { x: 3, y: 1 }, replicate: 0 };
        (0..count).map(move |sample| PathStream::new(&address, sample).two(Draw::BsdfDirection, 0))
    }

    /// Every direction is sampled by the stated density, except those that rounding moves over a bin's edge.
    #[test]
    fn sampled_directions_are_unit_and_have_the_density_that_is_reported_of_them() {
        let density = uneven();
        let mut over_an_edge = 0;
        for u in points(1 << 16) {
            let (wi, relative) = density.sample(u);
            assert!((wi.length() - 1.0).abs() < 1e-6 && wi.z >= 0.0, "{wi}");
            over_an_edge += u32::from(density.relative_density(wi) != relative);
        }
        assert!(over_an_edge <= 16, "{over_an_edge}");
    }

    /// χ² of 2¹⁶ stratified samples, so that it is less than that of independent ones: below its 99.9th percentile of 127 degrees of
    /// freedom.
    #[test]
    fn bins_are_sampled_as_often_as_their_density_says() {
        let (density, count) = (uneven(), 1 << 16);
        let mut counts = [0.0_f64; BINS];
        points(count).for_each(|u| counts[bin_of(density.sample(u).0)] += 1.0);
        let weights = density.weights.as_flattened();
        let all = f64::from(density.ends[SECTORS - 1]);
        let squared = |(observed, weight): (&f64, &u16)| {
            let expected = f64::from(*weight) / all * f64::from(count);
            (observed - expected) * (observed - expected) / expected
        };
        let squares: f64 = counts.iter().zip(weights).map(squared).sum();
        assert!(squares < 181.0, "{squares}");
    }

    /// The mean of 1/p of a sampled direction is the measure of the domain, here 1 in units of the cosine's density; and every bin of a
    /// uniform density is the cosine's.
    #[test]
    fn densities_integrate_to_one() {
        let density = uneven();
        let mean = points(1 << 16).map(|u| f64::from(1.0 / density.sample(u).1)).sum::<f64>() / f64::from(1 << 16);
        assert!((mean - 1.0).abs() < 1e-3, "{mean}");
        let even = DirectionDistribution::new(&[3.0; BINS]);
        assert!(points(256).all(|u| even.sample(u).1 == 1.0));
    }

    /// Bins have equal parts of cosine-weighted solid angle: directions sampled by the cosine hit all equally.
    #[test]
    fn bins_are_of_equal_cosine_weighted_solid_angle() {
        let mut counts = [0_u32; BINS];
        let count = 1 << 17;
        points(count).for_each(|u| counts[bin_of(etendue_core::warp::cosine_hemisphere(u))] += 1);
        // Independent samples would scatter by 32 about 1024.
        assert!(counts.iter().all(|bin_count| bin_count.abs_diff(count / BINS as u32) < 100), "{counts:?}");
    }

    #[test]
    fn bins_of_a_neighbourhood_name_each_other() {
        for bin in 0..BINS {
            assert!(neighbours(bin).all(|other| other != bin && neighbours(other).any(|back| back == bin)), "{bin}");
        }
    }

    #[test]
    fn the_ends_of_the_square_and_the_axes_have_bins() {
        let density = uneven();
        for u in [Vec2::ZERO, Vec2::splat(BELOW_ONE), Vec2::new(0.0, BELOW_ONE), Vec2::new(BELOW_ONE, 0.0)] {
            let (wi, relative) = density.sample(u);
            assert!(wi.is_finite() && relative > 0.0, "{u}");
            assert!(wi.x >= 0.9 * wi.truncate().length(), "by the axis where sectors begin: {wi}");
        }
        let axes = [Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::NEG_Y].map(|axis| bin_of(axis) / RINGS);
        assert_eq!(axes, [0, 4, 8, 12]);
        assert!(bin_of(Vec3::Z) < BINS);
    }
}
