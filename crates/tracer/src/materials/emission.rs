//! Emission of surfaces, and its change over time.
//!
//! Radiance is the same in every direction of an emitting side (Lambert): a surface of radiance L emits π L per area.
//!
//! A texture multiplies it colour by colour, and may be above 1: an image in real units (HDR) is its colours times a radiance. With D65 of 1 cd/m² as
//! the radiance, colours in cd/m² give the same spectra as [`etendue_spectra::upsample::emission`].

use core::num::NonZeroU32;
use std::sync::Arc;

use etendue_core::{Spectral, TimeInterval, Waveform, Wavelengths};
use etendue_spectra::{Spectrum, upsample};
use glam::{Vec2, Vec3};

use crate::ALL_EFFECTS;
use crate::textures::{ImageTexture, Lookup, TextureId};

/// Emitting sides of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmissionSides {
    /// The side that the geometric normal points to: by the winding of a triangle, outwards for a sphere.
    Front,
    /// Both, each with the stated radiance.
    Both,
}

/// Emission of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Emission {
    /// Spectral radiance, W·m⁻²·sr⁻¹·nm⁻¹.
    pub radiance: Spectrum,
    /// A factor on the radiance over the surface: linear sRGB colours of a texture, converted to spectra like reflectances (white is 1 at
    /// every wavelength).
    pub factor: Option<TextureId>,
    /// Emitting sides.
    pub sides: EmissionSides,
    /// Change of its strength over time; `None` if it is constant.
    pub modulation: Option<Modulation>,
}

/// Arguments of an emission: point, direction, wavelengths and time.
#[derive(Clone, Copy, Debug)]
pub struct EmissionQuery<'a, const N: usize> {
    pub wavelengths: &'a Wavelengths<N>,
    /// The interval over which strengths that change over time are averaged.
    pub interval: &'a TimeInterval,
}

impl Emission {
    /// True if light leaves along `direction` from a surface of this geometric normal.
    #[must_use]
    pub fn emits_towards(&self, geometric_normal: Vec3, direction: Vec3) -> bool {
        self.sides == EmissionSides::Both || geometric_normal.dot(direction) > 0.0
    }

    pub(crate) fn at<const N: usize>(
        &self,
        textures: &[ImageTexture],
        lookup: &Lookup,
        query: EmissionQuery<'_, N>,
    ) -> Spectral<N> {
        let EmissionQuery { wavelengths, interval } = query;
        let radiance = self.radiance.sample(wavelengths);
        let radiance = match self.factor {
            None => radiance,
            Some(_) if !ALL_EFFECTS => unreachable!("no textures"),
            Some(id) => radiance * upsample::reflectance(textures[id.0 as usize].sample(lookup), wavelengths),
        };
        match &self.modulation {
            None => radiance,
            Some(_) if !ALL_EFFECTS => unreachable!("nothing changes over time"),
            Some(modulation) => radiance * modulation.mean(lookup.uv, *interval),
        }
    }

    /// Mean radiance over a range of wavelengths and over the texture, for light selection, at the level 1.
    pub(crate) fn mean_radiance(&self, textures: &[ImageTexture], low_nm: f64, high_nm: f64) -> f64 {
        let texture = self.factor.map_or(1.0, |id| f64::from(textures[id.0 as usize].mean().element_sum()) / 3.0);
        self.radiance.band_mean(low_nm, high_nm) * texture
    }
}

/// Minimum weight of a light in light selection, over its maximum level in the view's interval. In rows of the image that the light
/// illuminates at its strongest, it is sampled at least a sixteenth as often as it should be.
const MIN_LEVEL_FRACTION: f64 = 1.0 / 16.0;

/// Strength of a light in light selection for a whole `interval`: its mean, but not less than a sixteenth of its maximum level; 0 only if
/// it is dark throughout.
#[must_use]
pub fn selection_level(waveform: &Waveform, interval: TimeInterval) -> f64 {
    waveform.mean(interval).max(MIN_LEVEL_FRACTION * waveform.max_over(interval))
}

/// Change of the strength of a surface's light over time: uniformly, or row by row like the multiplexed rows of a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Modulation {
    waveform: Arc<Waveform>,
    /// Number of rows that take turns, from the top (v = 1) of the texture coordinates down, and the delay from one to the next, s.
    rows: Option<(NonZeroU32, f64)>,
}

impl Modulation {
    /// One waveform for the whole surface.
    #[must_use]
    pub fn new(waveform: impl Into<Arc<Waveform>>) -> Self {
        Self { waveform: waveform.into(), rows: None }
    }

    /// A panel of this number of rows, equal bands of the texture coordinate v from 1 down to 0 (repeated beyond). Each is delayed against
    /// the one above by an equal part of the period. `None` if the waveform does not recur.
    #[must_use]
    pub fn in_rows(waveform: impl Into<Arc<Waveform>>, rows: NonZeroU32) -> Option<Self> {
        let waveform = waveform.into();
        let step_s = waveform.period_s()? / f64::from(rows.get());
        Some(Self { waveform, rows: Some((rows, step_s)) })
    }

    /// The same delayed by `delay_s`, which is finite.
    #[must_use]
    pub fn later(self, delay_s: f64) -> Self {
        Self { waveform: Arc::new(self.waveform.as_ref().clone().later(delay_s)), ..self }
    }

    /// Mean level over a time at texture coordinates.
    pub(crate) fn mean(&self, uv: Vec2, interval: TimeInterval) -> f32 {
        let over = match self.rows {
            None => interval,
            Some((rows, step_s)) => interval.later(-step_s * f64::from(row(uv.y, rows))),
        };
        self.waveform.mean(over) as f32
    }

    /// Its weight in light selection; for a panel the mean over its rows.
    pub(crate) fn selection_level(&self, interval: TimeInterval) -> f64 {
        let Some((rows, step_s)) = self.rows else { return selection_level(&self.waveform, interval) };
        let of = |row: u32| selection_level(&self.waveform, interval.later(-step_s * f64::from(row)));
        (0..rows.get()).map(of).sum::<f64>() / f64::from(rows.get())
    }

    /// Maximum level at any time.
    #[must_use]
    pub fn max_level(&self) -> f64 {
        self.waveform.max_level()
    }

    /// The waveform; for a panel that of its topmost row.
    #[must_use]
    pub fn waveform(&self) -> &Waveform {
        &self.waveform
    }

    /// Rows that take turns; `None` if the whole surface has one waveform.
    #[must_use]
    pub fn rows(&self) -> Option<NonZeroU32> {
        self.rows.map(|(rows, _)| rows)
    }
}

/// The row of a texture coordinate, from the top.
fn row(v: f32, rows: NonZeroU32) -> u32 {
    let below_top = 1.0 - v;
    let part = below_top - below_top.floor();
    ((part * rows.get() as f32) as u32).min(rows.get() - 1)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::textures::{Sampling, Texels};

    #[test]
    fn an_image_in_candelas_emits_in_candelas() {
        let colour = [1200.0, 35.0, 400.0];
        let image =
            ImageTexture::new(1, 1, Texels::Float(vec![colour]), Sampling::default()).expect("a picture above 1");
        let unit = upsample::emission_spectrum([1.0; 3]);
        let emission =
            Emission { radiance: unit, factor: Some(TextureId(0)), sides: EmissionSides::Front, modulation: None };
        let wavelengths = Wavelengths::<8>::uniform(380.0, 780.0, 0.3);
        let query = EmissionQuery { wavelengths: &wavelengths, interval: &TimeInterval::default() };
        let radiance = emission.at(&[image], &Lookup::point(Vec2::ZERO), query);
        let expected = upsample::emission(colour, &wavelengths);
        for i in 0..8 {
            // Products of interpolated spectra, and the product interpolated: tables of D65 curve by 1e-3 over a nanometre.
            assert!((radiance[i] / expected[i] - 1.0).abs() < 2e-3, "{} {}", radiance[i], expected[i]);
        }
    }
}
