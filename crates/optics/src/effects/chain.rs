//! The chain of effects of a camera, and the margin it needs.

use etendue_core::quantity::{Irradiance, Quantity, Variance};
use etendue_core::{Bands, EffectStatus, Plane, WavelengthRange};
use etendue_projection::Raster;

use super::canvas::{Canvas, KernelPair};
use super::convolve::{NumberField, OperationCounts, Region};
use super::film_part::{FilmPart, SpreadMethod, SpreadWidth};
use super::point_spread::{PointSpread, PreparedSpread};
use super::{Effect, error::EffectsError, glare::Glare, sample_spread::SampleSpread};
use crate::ghosts::GhostSettings;

/// The largest default margin, as a fraction of the image's width and height.
pub const MAX_MARGIN: f64 = 0.25;

/// The effects of a camera.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects {
    psf: Option<PointSpread>,
    spread_by: Option<(SpreadMethod, SpreadWidth)>,
    glare: Option<Glare>,
    ghosts: Option<GhostSettings>,
    margin_px: [usize; 2],
}

/// Parameters of a camera's effects and its margin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EffectsParameters {
    /// Diffraction and wavefront error, or an image.
    pub psf: Option<PointSpread>,
    /// Method of applying the point-spread function where samples come through the lens; `None`: the one that preserves modulation.
    pub spread_by: Option<SpreadMethod>,
    /// Light scattered in the lens.
    pub glare: Option<Glare>,
    /// Light reflected by two surfaces.
    pub ghosts: Option<GhostSettings>,
    /// Width of the margin on every side as a fraction of the image's width and height, 0 to 1; `None`: the reach of the effects, at most a quarter.
    pub margin: Option<f64>,
}

impl Effects {
    /// Prepares the effects of an image.
    ///
    /// # Errors
    /// If the margin is out of range or has no purpose, or sample displacement is requested and the function is wide.
    pub fn new(parameters: EffectsParameters, image: &Raster) -> Result<Self, EffectsError> {
        let EffectsParameters { psf, spread_by: requested, glare, ghosts, margin } = parameters;
        let mut effects = Self { psf, spread_by: None, glare, ghosts, margin_px: [0, 0] };
        if let Some(psf) = &effects.psf {
            let width = psf.width(&Canvas::new(image, [0, 0]));
            effects.spread_by = Some((SpreadMethod::choose(requested, width)?, width));
        }
        effects.margin_px = match margin {
            Some(margin) if !(0.0..=1.0).contains(&margin) => return Err(EffectsError::Margin { margin }),
            Some(_) if effects.is_idle() => return Err(EffectsError::IdleMargin),
            Some(margin) => margin_of_fraction(margin, image),
            None => effects.reach_px(image),
        };
        Ok(effects)
    }

    /// The reach of the effects, at most a quarter of the image.
    fn reach_px(&self, image: &Raster) -> [usize; 2] {
        let cap = margin_of_fraction(MAX_MARGIN, image);
        let glare = self.needs_glare().map(|glare| glare.reach_px(image.pitch_mm()).unwrap_or(cap));
        let psf = self.psf.as_ref().map(|psf| psf.reach_px(image.pitch_mm()));
        // Ghosts of sources outside the image fall anywhere in it.
        let ghosts = self.ghosts.map(|_| cap);
        let reach = [psf, glare, ghosts].into_iter().flatten().fold([0, 0], |a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        [reach[0].min(cap[0]), reach[1].min(cap[1])]
    }

    /// Status of an effect (modelled or not) with the reason.
    #[must_use]
    pub fn status(&self, effect: Effect) -> EffectStatus {
        match effect {
            Effect::PointSpread => PointSpread::status(self.psf.as_ref()),
            Effect::Glare => Glare::status(self.glare.as_ref()),
            Effect::Ghosts => GhostSettings::status(self.ghosts.as_ref()),
        }
    }

    /// True if there is no effect to apply.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        !Effect::ALL.into_iter().any(|effect| self.status(effect).is_modelled())
    }

    /// Columns and rows that the film needs beyond the image, on every side.
    #[must_use]
    pub fn margin_px(&self) -> [usize; 2] {
        self.margin_px
    }

    /// The pixels of the film: the image's with the margin.
    #[must_use]
    pub fn film(&self, image: &Raster) -> Raster {
        image.widened(self.margin_px)
    }

    /// The point-spread function, as described.
    #[must_use]
    pub fn psf(&self) -> Option<&PointSpread> {
        self.psf.as_ref()
    }

    /// The method of applying the point-spread function where samples come through the lens, and the width of the function; `None` if there is none.
    #[must_use]
    pub fn spread_by(&self) -> Option<(SpreadMethod, SpreadWidth)> {
        self.spread_by
    }

    /// The sample displacement for rays through the lens to the film of an image; `None` if the film spreads all light.
    #[must_use]
    pub fn sample_spread(&self, image: &Raster, range: WavelengthRange) -> Option<SampleSpread> {
        self.displacing()?.sample_spread(&Canvas::new(image, self.margin_px), range)
    }

    /// The function that displaces samples through the lens, if any.
    #[must_use]
    pub fn displacing(&self) -> Option<&PointSpread> {
        self.psf.as_ref().filter(|_| self.spread_by.is_some_and(|(by, _)| by == SpreadMethod::Samples))
    }

    /// The part of the point-spread function left to the film, for samples through the lens or not.
    #[must_use]
    pub fn film_part(&self, through_lens: bool) -> FilmPart {
        match self.spread_by {
            Some((SpreadMethod::Samples, _)) if through_lens => FilmPart::Tails,
            _ => FilmPart::Whole,
        }
    }

    /// Veiling glare, as described.
    #[must_use]
    pub fn glare(&self) -> Option<&Glare> {
        self.glare.as_ref()
    }

    /// Ghosts, if enabled.
    #[must_use]
    pub fn ghosts(&self) -> Option<GhostSettings> {
        self.ghosts
    }

    fn needs_glare(&self) -> Option<&Glare> {
        self.glare.as_ref().filter(|glare| Glare::status(Some(glare)).is_modelled())
    }

    /// Operation counts of the point spread and the veiling glare of an image: its bands and, if requested, their variances. (Ghosts:
    /// [`crate::ghosts::operation_counts`].)
    #[must_use]
    pub fn operation_counts(
        &self,
        image: &Raster,
        bands: Bands,
        with_variance: bool,
    ) -> [(Effect, OperationCounts); 2] {
        let canvas = Canvas::new(image, self.margin_px);
        let images = if with_variance { 2.0 } else { 1.0 };
        let psf = self.psf.as_ref().map(|psf| psf.operation_counts(&canvas, bands, images));
        let glare = self.needs_glare().map(|glare| glare.operation_counts(&canvas, images * bands.count() as f64));
        [(Effect::PointSpread, psf.unwrap_or_default()), (Effect::Glare, glare.unwrap_or_default())]
    }

    /// The effects prepared for an image, a range of wavelengths (nm) and this part of the point-spread function: everything that does not depend on
    /// the band.
    #[must_use]
    pub fn prepared(&self, image: &Raster, range: WavelengthRange, part: FilmPart) -> PreparedEffects {
        let canvas = Canvas::new(image, self.margin_px);
        let glare = self.needs_glare().map(|glare| KernelPair::new(&glare.kernel(&canvas), &canvas));
        let psf = self.psf.as_ref().map(|psf| psf.prepare(&canvas, range, part));
        PreparedEffects { canvas, psf, glare }
    }
}

pub(super) fn margin_of_fraction(margin: f64, image: &Raster) -> [usize; 2] {
    [(margin * image.width() as f64).ceil() as usize, (margin * image.height() as f64).ceil() as usize]
}

#[derive(Debug)]
pub struct PreparedEffects {
    canvas: Canvas,
    psf: Option<PreparedSpread>,
    glare: Option<KernelPair>,
}

impl PreparedEffects {
    /// The image's irradiance in the band from `band.low_nm` to `band.high_nm`, from that of the film, with the variance.
    ///
    /// A non-finite pixel of the film affects others: every pixel with a finite number is free of it.
    #[must_use]
    pub fn apply(
        &self,
        band: WavelengthRange,
        film: &Plane<Irradiance>,
        variance: Option<&Plane<Variance>>,
    ) -> (Plane<Irradiance>, Option<Plane<Variance>>) {
        // A single replicate has no variance.
        let known = variance.filter(|plane| plane.samples().iter().all(|v| !v.is_nan())).map(field);
        let (mean, spread) = self.spread(band, field(film), known);
        let variance = variance.map(|_| spread.map_or_else(|| self.unknown(), |v| self.cut(&v)));
        (self.cut(&mean), variance)
    }

    fn spread(
        &self,
        band: WavelengthRange,
        mut light: NumberField,
        mut variance: Option<NumberField>,
    ) -> (NumberField, Option<NumberField>) {
        if let Some(psf) = &self.psf {
            (light, variance) = psf.apply(band, &light, variance.as_ref());
        }
        if let Some(glare) = &self.glare {
            (light, variance) = glare.apply(&light, variance.as_ref());
        }
        (light, variance)
    }

    /// The image cut from a film. Values below zero are rounding of the transforms and become 0.
    fn cut<Q: Quantity<Sample = f32>>(&self, film: &NumberField) -> Plane<Q> {
        let Region { x, y } = self.canvas.image_region();
        let (width, height) = (x.len(), y.len());
        let positive = |v: &f64| if *v < 0.0 { 0.0 } else { *v as f32 };
        let samples = y.flat_map(|y| film.row(y)[x.clone()].iter().map(positive)).collect();
        Plane::from_samples(width, height, samples).expect("one sample per pixel")
    }

    fn unknown(&self) -> Plane<Variance> {
        let Region { x, y } = self.canvas.image_region();
        Plane::filled(x.len(), y.len(), f32::NAN)
    }
}

fn field<Q: Quantity<Sample = f32>>(plane: &Plane<Q>) -> NumberField {
    NumberField { width: plane.width(), values: plane.samples().iter().map(|v| f64::from(*v)).collect() }
}
