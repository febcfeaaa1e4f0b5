//! A point's light at one place of the field, as samples on the sensor.

use crate::effects::error::{EffectsError, positive};
use crate::effects::psf::{MAX_PX, MM_PER_UM};
use core::fmt;
use etendue_projection::Raster;
use glam::{DMat2, DVec2};

/// The farthest that samples lie apart, px; the rest is rounding.
const WIDEST_STEP_PX: f64 = 1.0 + 1e-9;
/// Distances from the axis that count as on it, mm.
const ON_AXIS_MM: f64 = 1e-6;

/// A point's light at one place of the field.
#[derive(Clone, PartialEq)]
pub struct FieldSpread {
    /// Where the point is on the sensor from the axis, mm, by the samples' own axes: x along their rows, y down their columns.
    pub place_mm: DVec2,
    /// Distance of samples on the sensor, µm.
    pub pitch_um: f64,
    /// Samples in a row.
    pub width: usize,
    /// Light of the samples, row by row, linear, in any unit.
    pub light: Vec<f32>,
    /// The sample at the point: column and row, from 0.
    pub point: [usize; 2],
}

impl fmt::Debug for FieldSpread {
    /// Without the samples, which are those of a file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { place_mm, pitch_um, width, light, point } = self;
        write!(f, "FieldSpread({place_mm} mm, {} of {width} a row, {pitch_um:?} µm, {point:?})", light.len())
    }
}

impl FieldSpread {
    /// Whether the samples can stand on the pixels of a picture.
    ///
    /// # Errors
    /// Where they are no light, are farther apart than pixels, or reach beyond 512 px.
    pub fn check(&self, picture: &Raster) -> Result<(), EffectsError> {
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
        let pixel_mm = picture.pitch_mm().min_element();
        if step_mm > WIDEST_STEP_PX * pixel_mm {
            return Err(EffectsError::CoarseFunction { step_um: step_mm / MM_PER_UM, pixel_um: pixel_mm / MM_PER_UM });
        }
        let reach_px = (self.reach_mm() / pixel_mm).ceil() as usize;
        if reach_px > MAX_PX { Err(EffectsError::WideFunction { reach_px, most_px: MAX_PX }) } else { Ok(()) }
    }

    /// Where lit samples lie from the point, mm, by the samples' own axes, and their light.
    fn lit(&self) -> impl Iterator<Item = (DVec2, f64)> {
        let point = DVec2::new(self.point[0] as f64, self.point[1] as f64);
        let place = move |i: usize| DVec2::new((i % self.width) as f64, (i / self.width) as f64) - point;
        let step_mm = self.pitch_um * MM_PER_UM;
        let lit = self.light.iter().enumerate().filter(|(_, light)| **light > 0.0);
        lit.map(move |(i, light)| (place(i) * step_mm, f64::from(*light)))
    }

    /// How far from the point light falls.
    pub(super) fn reach_mm(&self) -> f64 {
        self.lit().map(|(offset, _)| offset.length_squared()).fold(0.0, f64::max).sqrt()
    }

    pub(super) fn radius_mm(&self) -> f64 {
        let radius = self.place_mm.length();
        if radius > ON_AXIS_MM { radius } else { 0.0 }
    }

    /// Away from the axis, by the samples' own axes; `None` on the axis.
    pub(super) fn outwards(&self) -> Option<DVec2> {
        (self.radius_mm() > 0.0).then(|| self.place_mm.normalize())
    }
}

/// A function made ready to be turned.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Function {
    spread: FieldSpread,
    pub(super) radius_mm: f64,
    pub(super) reach_mm: f64,
    /// From the samples' axes to those along the radius and across it.
    turn: DMat2,
    sum: f64,
    /// How far the centroid lies outwards of the point, mm.
    pub(super) centroid_mm: f64,
    /// Second moments about the point along the radius and across it, mm².
    moments: DMat2,
}

impl Function {
    /// With the direction that is away from the axis for one on it.
    pub(super) fn new(spread: FieldSpread, outwards_on_axis: DVec2) -> Self {
        let outwards = spread.outwards().unwrap_or(outwards_on_axis);
        let turn = axes(outwards).transpose();
        let (mut sum, mut centroid_mm, mut moments) = (0.0, 0.0, DMat2::ZERO);
        for (offset, light) in spread.lit() {
            let along = turn * offset;
            sum += light;
            centroid_mm += along.x * light;
            moments += DMat2::from_cols(along * along.x, along * along.y) * light;
        }
        let (radius_mm, reach_mm) = (spread.radius_mm(), spread.reach_mm());
        let (centroid_mm, moments) = (centroid_mm / sum, moments * (1.0 / sum));
        Self { spread, radius_mm, reach_mm, turn, sum, centroid_mm, moments }
    }

    /// Where light lands around a place of the sensor, mm, and which share of all.
    pub(super) fn landings(&self, outwards: DVec2) -> impl Iterator<Item = (DVec2, f64)> {
        let turn = axes(outwards) * self.turn;
        self.spread.lit().map(move |(offset, light)| (turn * offset, light / self.sum))
    }

    pub(super) fn samples(&self) -> usize {
        self.spread.light.len()
    }

    /// Second moments about the point in the picture, mm².
    pub(super) fn moments(&self, outwards: DVec2) -> DMat2 {
        let turn = axes(outwards);
        turn * self.moments * turn.transpose()
    }
}

/// The axes along a direction and across it, from x towards y.
fn axes(outwards: DVec2) -> DMat2 {
    DMat2::from_cols(outwards, outwards.perp())
}
