//! The light of a point at one field position, as samples on the sensor.

use core::fmt;

use etendue_projection::Raster;
use glam::{DMat2, DVec2};

use crate::effects::error::{EffectsError, positive};
use crate::effects::psf::{MAX_PX, MM_PER_UM};

/// The largest distance between samples, px; the rest is rounding.
const MAX_STEP_PX: f64 = 1.0 + 1e-9;
/// Distances from the axis up to this count as zero, mm.
const ON_AXIS_MM: f64 = 1e-6;

/// The light of a point at one field position.
#[derive(Clone, PartialEq)]
pub struct FieldSpread {
    /// Position of the point on the sensor relative to the axis, mm, in the samples' axes: x along their rows, y down their columns.
    pub place_mm: DVec2,
    /// Pitch of the samples on the sensor, µm.
    pub pitch_um: f64,
    /// Samples in a row.
    pub width: usize,
    /// Light of the samples, row by row, linear, in any unit.
    pub light: Vec<f32>,
    /// The sample at the point: column and row, from 0.
    pub point: [usize; 2],
}

impl fmt::Debug for FieldSpread {
    /// Omits the samples, which come from a file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { place_mm, pitch_um, width, light, point } = self;
        write!(f, "FieldSpread({place_mm} mm, {} of {width} a row, {pitch_um:?} µm, {point:?})", light.len())
    }
}

impl FieldSpread {
    /// Checks that the samples suit the pixels of an image.
    ///
    /// # Errors
    /// If they are not valid light, are farther apart than pixels, or reach beyond 512 px.
    pub fn check(&self, image: &Raster) -> Result<(), EffectsError> {
        let step_mm = positive("spacing", self.pitch_um)? * MM_PER_UM;
        let (width, count) = (self.width, self.light.len());
        if width == 0 || count == 0 || count % width != 0 {
            return Err(EffectsError::Samples { count, width });
        }
        if let Some(i) = self.light.iter().position(|v| !(v.is_finite() && *v >= 0.0)) {
            return Err(EffectsError::NoLight { column: i % width, row: i / width, value: self.light[i] });
        }
        if self.light.iter().all(|v| *v == 0.0) {
            return Err(EffectsError::Dark);
        }
        let pixel_mm = image.pitch_mm().min_element();
        if step_mm > MAX_STEP_PX * pixel_mm {
            return Err(EffectsError::CoarseFunction { step_um: step_mm / MM_PER_UM, pixel_um: pixel_mm / MM_PER_UM });
        }
        let reach_px = (self.reach_mm() / pixel_mm).ceil() as usize;
        if reach_px > MAX_PX { Err(EffectsError::WideFunction { reach_px, most_px: MAX_PX }) } else { Ok(()) }
    }

    /// Offsets of the lit samples from the point, mm, in the samples' axes, and their light.
    fn samples(&self) -> impl Iterator<Item = (DVec2, f64)> {
        let point = DVec2::new(self.point[0] as f64, self.point[1] as f64);
        let place = move |i: usize| DVec2::new((i % self.width) as f64, (i / self.width) as f64) - point;
        let step_mm = self.pitch_um * MM_PER_UM;
        let lit = self.light.iter().enumerate().filter(|(_, light)| **light > 0.0);
        lit.map(move |(i, light)| (place(i) * step_mm, f64::from(*light)))
    }

    /// Maximum distance of the light from the point.
    pub(super) fn reach_mm(&self) -> f64 {
        self.samples().map(|(offset, _)| offset.length_squared()).fold(0.0, f64::max).sqrt()
    }

    pub(super) fn radius_mm(&self) -> f64 {
        let radius = self.place_mm.length();
        if radius > ON_AXIS_MM { radius } else { 0.0 }
    }

    /// Direction away from the axis, in the samples' axes; `None` on the axis.
    pub(super) fn outwards(&self) -> Option<DVec2> {
        (self.radius_mm() > 0.0).then(|| self.place_mm.normalize())
    }
}

/// A function prepared for rotation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RadialFunction {
    spread: FieldSpread,
    pub(super) radius_mm: f64,
    pub(super) reach_mm: f64,
    /// Rotation from the samples' axes to those along the radius and across it.
    turn: DMat2,
    sum: f64,
    /// Distance of the centroid outwards from the point, mm.
    pub(super) centroid_mm: f64,
    /// Second moments about the point along the radius and across it, mm².
    moments: DMat2,
}

impl RadialFunction {
    /// `outwards_on_axis` is the direction away from the axis for a function on the axis.
    pub(super) fn new(spread: FieldSpread, outwards_on_axis: DVec2) -> Self {
        let outwards = spread.outwards().unwrap_or(outwards_on_axis);
        let turn = axes(outwards).transpose();
        let (mut sum, mut centroid_mm, mut moments) = (0.0, 0.0, DMat2::ZERO);
        for (offset, light) in spread.samples() {
            let along = turn * offset;
            sum += light;
            centroid_mm += along.x * light;
            moments += DMat2::from_cols(along * along.x, along * along.y) * light;
        }
        let (radius_mm, reach_mm) = (spread.radius_mm(), spread.reach_mm());
        let (centroid_mm, moments) = (centroid_mm / sum, moments * (1.0 / sum));
        Self { spread, radius_mm, reach_mm, turn, sum, centroid_mm, moments }
    }

    /// Offsets of the light about a position on the sensor, mm, and fractions of the total.
    pub(super) fn splats(&self, outwards: DVec2) -> impl Iterator<Item = (DVec2, f64)> {
        let turn = axes(outwards) * self.turn;
        self.spread.samples().map(move |(offset, light)| (turn * offset, light / self.sum))
    }

    pub(super) fn samples(&self) -> usize {
        self.spread.light.len()
    }

    /// Second moments about the point in the image, mm².
    pub(super) fn moments(&self, outwards: DVec2) -> DMat2 {
        let turn = axes(outwards);
        turn * self.moments * turn.transpose()
    }
}

/// The axes along a direction and across it, from x towards y.
fn axes(outwards: DVec2) -> DMat2 {
    DMat2::from_cols(outwards, outwards.perp())
}

/// Centroid and second moments of a function's light about its point, mm and mm².
#[derive(Clone, Copy)]
pub(super) struct SpreadShape {
    pub(super) centroid: DVec2,
    pub(super) moments: DMat2,
}

/// Maximum default number of patches across.
const MAX_PATCHES: usize = 11;
/// Tolerance of second moments midway between patches: relative to their sum, and px².
const RELATIVE: f64 = 0.005;
const ABSOLUTE_PX2: f64 = 0.005;
/// Tolerance of the centroid: relative to the root of that sum, and px.
const RELATIVE_CENTROID: f64 = 0.01;
const CENTROID_PX: f64 = 0.01;

/// The smallest odd numbers of patches that keep centroid and second moments (by the position on the sensor, mm) between them, so that one patch is
/// at the centre; and whether the maximum suffices.
pub(super) fn patches_needed(image: &Raster, shape: impl Fn(DVec2) -> SpreadShape) -> ([usize; 2], bool) {
    let mut counts = (1..=MAX_PATCHES).step_by(2).map(|across| [across, down(across, image)]);
    let is_kept = |counts: &[usize; 2]| keeps_shapes(*counts, image, &shape);
    counts.find(is_kept).map_or(([MAX_PATCHES, down(MAX_PATCHES, image)], false), |counts| (counts, true))
}

/// True if centroids and second moments at patches and midway between them are close to the mean of the nearest patches.
pub(super) fn keeps_shapes([across, down]: [usize; 2], image: &Raster, shape: impl Fn(DVec2) -> SpreadShape) -> bool {
    let size = DVec2::new(image.width() as f64, image.height() as f64);
    let at = |x: f64, y: f64| shape(image.sensor_mm(size * DVec2::new(x, y)));
    let rows = stations(down);
    stations(across).into_iter().all(|(x, columns)| {
        rows.iter().all(|(y, rows)| {
            let around = columns.iter().flat_map(|x| rows.iter().map(|y| at(*x, *y)));
            let none = SpreadShape { centroid: DVec2::ZERO, moments: DMat2::ZERO };
            let mean = around.fold(none, |sum, one| SpreadShape {
                centroid: sum.centroid + one.centroid * 0.25,
                moments: sum.moments + one.moments * 0.25,
            });
            is_near(&at(x, *y), &mean, image)
        })
    })
}

/// Positions along an axis, as fractions of its length, each with the two patches around it: at the patches and midway between them; for a single
/// patch, which holds from edge to edge, the edges and the centre.
fn stations(count: usize) -> Vec<(f64, [f64; 2])> {
    if count == 1 {
        return [0.0, 0.5, 1.0].map(|place| (place, [0.5; 2])).to_vec();
    }
    let fraction = |half_steps: usize| half_steps as f64 / (2 * (count - 1)) as f64;
    (0..2 * count - 1).map(|i| (fraction(i), [i - i % 2, i + i % 2].map(fraction))).collect()
}

fn is_near(exact: &SpreadShape, approximate: &SpreadShape, image: &Raster) -> bool {
    let off = approximate.moments - exact.moments;
    let pixel_mm = image.pitch_mm().min_element();
    let trace = exact.moments.x_axis.x + exact.moments.y_axis.y;
    let maximum = RELATIVE * trace + ABSOLUTE_PX2 * pixel_mm * pixel_mm;
    let aside = (approximate.centroid - exact.centroid).length();
    let is_in_place = aside <= RELATIVE_CENTROID * trace.sqrt() + CENTROID_PX * pixel_mm;
    is_in_place && off.to_cols_array().into_iter().all(|v| v.abs() <= maximum)
}

/// Patches down for the number across: about square, an odd number.
fn down(across: usize, image: &Raster) -> usize {
    let aspect = image.height() as f64 * image.pitch_mm().y / (image.width() as f64 * image.pitch_mm().x);
    let half = 0.5 * (across - 1) as f64 * aspect;
    1 + 2 * (half.ceil() as usize).min((MAX_PATCHES - 1) / 2)
}
