//! Mean and variance of a uniform patch, with uncertainties that are also valid for developed images.
//!
//! Demosaicing, filters and JPEG correlate neighbours: n pixels then carry as much information as fewer independent ones. With ρ
//! the correlation of the deviations from the mean at a distance of d pixels,
//!
//! ```text
//! u²(mean) = σ²/n Σ ρ(d)      |d_x|, |d_y| ≤ 3, no less than 1      u²(σ²) = 2 σ⁴/(n − 1) Σ ρ(d)
//! ```
//!
//! (The first is exact if correlations have no longer range, Priestley 1981; the second is an upper bound, as Σ ρ² would be
//! exact.)
//!
//! Rendered images with path reuse in blocks of b × b pixels have correlations of up to b − 1 pixels, and nearly equal errors
//! within a block. There the sum extends that far. As the mean is that of the same pixels, the sum is divided by 1 − m/n to
//! correct its bias, with m = (2 max(3, b − 1) + 1)² distances; patches of fewer than 2 m pixels use the bound, Σ ρ = b².
//!
//! Assumption: no longer correlations, except row and column noise. τ² is the mean product of deviations in one row at distances
//! beyond that reach (the next six), less the same off rows and columns (non-uniform light) and less two standard deviations for
//! independent noise. For h rows u²(mean) increases by τ²/h, if positive, and Σ ρ is reduced by the same variance. Columns are
//! treated likewise; neither is done with path reuse. u²(σ²) ignores rows and columns. A slope within the patch counts as noise.
//!
//! The image of a disc: offset of its centroid from the image of its centre.
//!
//! The two differ under perspective and distortion (Heikkilä 2000; Mallon & Whelan 2007), for a disc of radius r by about r²/8
//! times the second derivatives of the map, a tenth of a pixel for large dots in a wide-angle image. The disc's outline is mapped
//! at 64 points, and the centroid of the polygon computed; a polygon of n corners has all but 2π²/(3 n²), here 0.2 %, of the
//! shift.

use core::f64::consts::TAU;

use etendue_core::{Plane, maths::f64::sin_cos, quantity::Quantity};
use etendue_stats::Moments;
use glam::DVec2;

use crate::Estimate;

/// Maximum distance of neighbours, px.
const MAX_DISTANCE_PX: usize = 3;
/// Distances beyond the reach at which pixels of a line are compared.
const REFERENCE_DISTANCES: usize = 6;
/// Maximum side, px, of the central part from which correlations are computed: tens of thousands of pixels determine them to a
/// few per cent.
const MAX_SIDE_PX: usize = 256;

/// Statistics of a uniform patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchStatistics {
    /// Mean reading.
    pub mean: Estimate,
    /// Variance of a pixel.
    pub variance: Estimate,
}

/// Mean and variance of a patch with equal errors in blocks of `shared_px` × `shared_px` pixels (1: none).
#[must_use]
pub fn patch_statistics(patch: &Image, shared_px: usize) -> PatchStatistics {
    let moments = Moments::from_values(patch.samples().iter().map(|s| f64::from(*s)));
    let (count, variance) = (moments.count() as f64, moments.variance().unwrap_or(0.0));
    let deviations = Deviations::from_patch(patch);
    // Few blocks look like lines: rendered images have no line noise except the sensor's.
    let lines = if shared_px > 1 { LineVariances::default() } else { LineVariances::from_deviations(&deviations) };
    let correlation = if shared_px > 1 {
        block_correlation_sum(patch, &deviations, shared_px)
    } else {
        correlation_sum(&deviations, MAX_DISTANCE_PX, lines)
    };
    let line_correlation = lines.rows / patch.height() as f64 + lines.columns / patch.width() as f64;
    PatchStatistics {
        mean: Estimate::new(moments.mean(), (variance * (correlation / count + line_correlation)).sqrt()),
        variance: Estimate::new(variance, variance * (2.0 / (count - 1.0) * correlation).sqrt()),
    }
}

/// Σ ρ for equal errors in blocks.
fn block_correlation_sum(patch: &Image, deviations: &Deviations, shared_px: usize) -> f64 {
    let reach = MAX_DISTANCE_PX.max(shared_px - 1);
    let distances = ((2 * reach + 1) * (2 * reach + 1)) as f64;
    let count = (patch.width().min(MAX_SIDE_PX) * patch.height().min(MAX_SIDE_PX)) as f64;
    if count < 2.0 * distances || patch.width().min(patch.height()) <= 2 * reach {
        return (shared_px * shared_px) as f64;
    }
    correlation_sum(deviations, reach, LineVariances::default()) / (1.0 - distances / count)
}

/// Σ ρ over neighbours up to a reach, 1 or more, without row and column noise: the number of pixels equivalent to one independent
/// pixel.
fn correlation_sum(deviations: &Deviations, reach: usize, lines: LineVariances) -> f64 {
    let own = deviations.products(0, 0);
    if own <= 0.0 || deviations.width <= 2 * reach || deviations.height <= 2 * reach {
        return 1.0;
    }
    let far = reach as isize;
    // Each distance and its opposite.
    let along = (1..=far).map(|dx| deviations.products(dx, 0)).sum::<f64>();
    let across = (1..=far).flat_map(|dy| (-far..=far).map(move |dx| (dx, dy)));
    let sum = along + across.map(|(dx, dy)| deviations.products(dx, dy)).sum::<f64>();
    let line_variance = (2 * reach + 1) as f64 * (lines.rows + lines.columns);
    (1.0 + 2.0 * sum / own - line_variance).max(1.0)
}

/// Variance shared by the pixels of a row, and of a column, relative to the variance of a pixel.
#[derive(Clone, Copy, Debug, Default)]
struct LineVariances {
    rows: f64,
    columns: f64,
}

impl LineVariances {
    /// 0 if the patch is too small.
    fn from_deviations(deviations: &Deviations) -> Self {
        let own = deviations.mean_product(0, 0);
        if own <= 0.0 || deviations.width.min(deviations.height) < 2 * (MAX_DISTANCE_PX + REFERENCE_DISTANCES) {
            return Self::default();
        }
        let reference_shifts = || (MAX_DISTANCE_PX + 1..=MAX_DISTANCE_PX + REFERENCE_DISTANCES).map(|d| d as isize);
        let mean = |all: &[f64]| all.iter().sum::<f64>() / (all.len() as f64 * own);
        let products = |places: &mut dyn Iterator<Item = (isize, isize)>| {
            mean(&places.map(|(dx, dy)| deviations.mean_product(dx, dy)).collect::<Vec<_>>())
        };
        let uneven = products(&mut reference_shifts().flat_map(|d| [(d, d), (-d, d)]));
        let pairs = (deviations.width * deviations.height * REFERENCE_DISTANCES) as f64;
        let shared = |place: fn(isize) -> (isize, isize)| {
            (products(&mut reference_shifts().map(place)) - uneven - 2.0 / pairs.sqrt()).max(0.0)
        };
        Self { rows: shared(|d| (d, 0)), columns: shared(|d| (0, d)) }
    }
}

/// Deviations from the mean in the centre of a patch.
struct Deviations {
    width: usize,
    height: usize,
    values: Vec<f64>,
}

impl Deviations {
    fn from_patch(patch: &Image) -> Self {
        let middle = |length: usize| (length.saturating_sub(MAX_SIDE_PX) / 2, length.min(MAX_SIDE_PX));
        let ((left, width), (top, height)) = (middle(patch.width()), middle(patch.height()));
        let part = patch.part(left, top, width, height);
        let mean = Moments::from_values(part.samples().iter().map(|s| f64::from(*s))).mean();
        Self { width, height, values: part.samples().iter().map(|s| f64::from(*s) - mean).collect() }
    }

    /// The sum of the products of deviations at this offset in columns and rows.
    fn products(&self, dx: isize, dy: isize) -> f64 {
        let (right, down, up) = (dx.unsigned_abs(), dy.max(0).unsigned_abs(), dy.min(0).unsigned_abs());
        let (columns, rows) = (self.width.saturating_sub(right), self.height.saturating_sub(down + up));
        let (from, to) = if dx < 0 { (right, 0) } else { (0, right) };
        let row = |y: usize| {
            let (a, b) = ((y + up) * self.width + from, (y + down) * self.width + to);
            self.values[a..a + columns].iter().zip(&self.values[b..b + columns]).map(|(p, q)| p * q).sum::<f64>()
        };
        if columns == 0 { 0.0 } else { (0..rows).map(row).sum() }
    }

    fn mean_product(&self, dx: isize, dy: isize) -> f64 {
        let pairs = self.width.saturating_sub(dx.unsigned_abs()) * self.height.saturating_sub(dy.unsigned_abs());
        self.products(dx, dy) / pairs.max(1) as f64
    }
}

/// Value of one pixel of one channel: a digital number, or a linear quantity in the unit that the owner states. Digital numbers
/// of up to 24 bits are exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading;

impl Quantity for Reading {
    type Sample = f32;
    const NAME: &'static str = "reading";
    const UNIT: &'static str = "DN or 1";
}

/// One channel of an image.
pub type Image = Plane<Reading>;

/// Maximum fraction of saturated pixels that a measurement accepts.
pub(crate) const MAX_SATURATED_FRACTION: f64 = 1e-3;

/// Fraction of pixels at or above full scale. If full scale is unknown, fraction of pixels at the largest reading: a plateau
/// indicates clipping, unless the image has a single value.
pub(crate) fn saturated_fraction(samples: &[f32], full_scale: Option<f64>) -> f64 {
    let count = |level: f64| samples.iter().filter(|s| f64::from(**s) >= level).count() as f64 / samples.len() as f64;
    if let Some(full) = full_scale {
        return count(full);
    }
    let max_sample = samples.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let plateau = count(f64::from(max_sample));
    // One pixel in a hundred at exactly the largest reading is not due to noise.
    if plateau > 0.01 && plateau < 1.0 { plateau } else { 0.0 }
}

/// Percentage of the pixels at or above a known full scale, for the worst part of an image, if that is more than a measurement
/// accepts.
#[must_use]
pub fn saturated_percent<'a>(parts: impl IntoIterator<Item = &'a Image>, full_scale: Option<f64>) -> Option<f64> {
    let full = full_scale?;
    let fraction = parts.into_iter().map(|part| saturated_fraction(part.samples(), Some(full))).fold(0.0, f64::max);
    (fraction > MAX_SATURATED_FRACTION).then_some(100.0 * fraction)
}

/// A sixth of the squared second differences of neighbours in a row, at the middle one: unbiased for independent noise on a
/// linearly varying level.
pub(crate) fn neighbour_variances(image: &Image) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
    let rows = image.samples().chunks_exact(image.width()).enumerate();
    rows.flat_map(|(y, row)| {
        row.windows(3).enumerate().map(move |(x, three)| {
            let [a, b, c] = [three[0], three[1], three[2]].map(f64::from);
            let difference = a - 2.0 * b + c;
            (x + 1, y, difference * difference / 6.0)
        })
    })
}

/// Centroid of a disc's image less the image of its centre; `None` if the map is undefined at one of the points.
pub fn centroid_shift(map: impl Fn(DVec2) -> Option<DVec2>, centre: DVec2, radius: f64) -> Option<DVec2> {
    const CORNERS: usize = 64;
    let middle = map(centre)?;
    let corner = |i: usize| {
        let (sin, cos) = sin_cos(TAU * i as f64 / CORNERS as f64);
        map(centre + radius * DVec2::new(cos, sin)).map(|p| p - middle)
    };
    let outline: Vec<DVec2> = (0..CORNERS).map(corner).collect::<Option<_>>()?;
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    for (a, b) in outline.iter().zip(outline.iter().cycle().skip(1)) {
        let part = a.perp_dot(*b);
        area += part;
        moment += part * (*a + *b) / 3.0;
    }
    Some(moment / area).filter(|shift| shift.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every pixel twice horizontally and twice vertically: four pixels count as one.
    #[test]
    fn repeated_pixels_count_once() {
        let noise = |x: usize, y: usize| ((x * 7919 + y * 104_729 + x * y * 31) % 97) as f32;
        let test_image =
            |f: &dyn Fn(usize) -> f32| Image::from_samples(96, 96, (0..96 * 96).map(f).collect()).expect("a square");
        let (single, double) = (test_image(&|i| noise(i % 96, i / 96)), test_image(&|i| noise(i % 96 / 2, i / 96 / 2)));
        let [one, four] = [&single, &double]
            .map(|image| correlation_sum(&Deviations::from_patch(image), MAX_DISTANCE_PX, LineVariances::default()));
        assert!((four / one - 4.0).abs() < 1.0, "{four} {one}");
        let [a, b] = [patch_statistics(&single, 1), patch_statistics(&double, 1)].map(|e| e.mean.standard_uncertainty);
        assert!((b / a - 2.0).abs() < 0.3, "{a} {b}");
    }

    #[test]
    fn a_patch_of_one_value_is_known() {
        let patch = patch_statistics(&Image::filled(12, 12, 7.0), 1);
        assert_eq!((patch.mean, patch.variance), (Estimate::new(7.0, 0.0), Estimate::new(0.0, 0.0)));
    }

    /// A number from −1/2 to 1/2 for a position and an image.
    fn scatter(x: usize, y: usize, picture: usize) -> f64 {
        let mixed =
            (x as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (y as u64 + 1).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
        let mixed =
            (mixed ^ (picture as u64 + 1).wrapping_mul(0x1656_67b1_9e37_79f9)).wrapping_mul(0xff51_afd7_ed55_8ccd);
        let mixed = (mixed ^ (mixed >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
        ((mixed ^ (mixed >> 33)) >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }

    /// Means over patches of blocks with nearly equal errors: 95 % intervals have their nominal coverage at every patch size.
    #[test]
    fn means_over_shared_blocks_know_it() {
        const PICTURES: usize = 400;
        for (shared, side) in [(4, 10), (4, 16), (4, 24), (4, 64), (8, 24), (8, 40)] {
            let reading = |i: usize, image: usize| {
                let (x, y) = (i % side + 3, i / side + 1);
                100.0 + scatter(x / shared, y / shared, image) + 0.3 * scatter(x, y, image + PICTURES)
            };
            let means: Vec<Estimate> = (0..PICTURES)
                .map(|image| {
                    let samples = (0..side * side).map(|i| reading(i, image) as f32).collect();
                    patch_statistics(&Image::from_samples(side, side, samples).expect("a square"), shared).mean
                })
                .collect();
            let inside = means.iter().filter(|m| (m.value - 100.0).abs() <= 2.0 * m.standard_uncertainty).count();
            let covered = inside as f64 / PICTURES as f64;
            assert!(covered >= 0.9, "blocks of {shared}, patch of {side}: {covered}");
            // Stated variances relative to that of the means: not much larger. Patches of few blocks use a bound.
            let stated =
                means.iter().map(|m| m.standard_uncertainty * m.standard_uncertainty).sum::<f64>() / PICTURES as f64;
            let scattered = means.iter().map(|m| (m.value - 100.0) * (m.value - 100.0)).sum::<f64>() / PICTURES as f64;
            assert!(
                (0.8..1.6).contains(&(stated / scattered)),
                "blocks of {shared}, patch of {side}: {stated} {scattered}"
            );
        }
    }

    #[test]
    fn a_tilted_disc_s_image_is_an_ellipse_whose_centre_is_known() {
        // x′ = x/(1 + h x): a disc about the origin maps to an ellipse from −r/(1 − h r) to r/(1 + h r).
        let (h, r) = (0.02, 3.0);
        let map = |p: DVec2| Some(p / (1.0 + h * p.x));
        let shift = centroid_shift(map, DVec2::ZERO, r).expect("finite");
        let centre = 0.5 * (r / (1.0 + h * r) - r / (1.0 - h * r));
        // The polygon of 64 corners: 0.2 %.
        assert!((shift.x / centre - 1.0).abs() < 2e-3 && shift.y.abs() < 1e-12, "{shift} {centre}");
        assert_eq!(centroid_shift(|p| Some(2.0 * p), DVec2::ONE, r).map(|s| s.length() < 1e-12), Some(true));
    }
}
