//! Effects made ready for a picture, band after band.

use super::canvas::Canvas;
use super::convolve::{Field, Region};
use super::point_spread::ReadySpread;
use super::spread::Spread;
use etendue_core::Plane;
use etendue_core::quantity::{Irradiance, Quantity, Variance};

/// Effects that are ready to be applied.
#[derive(Debug)]
pub struct Prepared {
    pub(super) canvas: Canvas,
    pub(super) psf: Option<ReadySpread>,
    pub(super) glare: Option<Spread>,
}

impl Prepared {
    /// The picture's irradiance in the band from `band_nm.0` to `band_nm.1`, of the film's; and its variance, of the film's.
    ///
    /// A pixel of the film that is not finite makes others so: none that holds a number has met it.
    #[must_use]
    pub fn apply(
        &self,
        band_nm: (f64, f64),
        film: &Plane<Irradiance>,
        variance: Option<&Plane<Variance>>,
    ) -> (Plane<Irradiance>, Option<Plane<Variance>>) {
        // One replicate knows no variance.
        let known = variance.filter(|plane| plane.samples().iter().all(|v| !v.is_nan())).map(field);
        let (mean, spread) = self.spread(band_nm, field(film), known);
        let variance = variance.map(|_| spread.map_or_else(|| self.unknown(), |v| self.cut(&v)));
        (self.cut(&mean), variance)
    }

    pub(super) fn spread(
        &self,
        band_nm: (f64, f64),
        mut light: Field,
        mut variance: Option<Field>,
    ) -> (Field, Option<Field>) {
        if let Some(psf) = &self.psf {
            (light, variance) = psf.apply(band_nm, &light, variance.as_ref());
        }
        if let Some(glare) = &self.glare {
            (light, variance) = glare.apply(&light, variance.as_ref());
        }
        (light, variance)
    }

    /// The picture of a film. Rounding of the transforms below zero is no light.
    pub(super) fn cut<Q: Quantity<Sample = f32>>(&self, film: &Field) -> Plane<Q> {
        let Region { x, y } = self.canvas.picture();
        let (width, height) = (x.len(), y.len());
        let positive = |v: &f64| if *v < 0.0 { 0.0 } else { *v as f32 };
        let samples = y.flat_map(|y| film.row(y)[x.clone()].iter().map(positive)).collect();
        Plane::from_samples(width, height, samples).expect("a sample a pixel")
    }

    pub(super) fn unknown(&self) -> Plane<Variance> {
        let Region { x, y } = self.canvas.picture();
        Plane::filled(x.len(), y.len(), f32::NAN)
    }
}

pub(super) fn field<Q: Quantity<Sample = f32>>(plane: &Plane<Q>) -> Field {
    Field { width: plane.width(), values: plane.samples().iter().map(|v| f64::from(*v)).collect() }
}
