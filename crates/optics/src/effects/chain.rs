//! The effects of a camera, one behind the other, and the margin that they need.

use etendue_core::quantity::{Irradiance, Quantity, Variance};
use etendue_core::{Bands, EffectStatus, Plane, WavelengthRange};
use etendue_projection::Raster;

use super::canvas::{Canvas, Spread};
use super::convolve::{Field, OperationCounts, Region};
use super::film_part::{FilmPart, SpreadBy, SpreadWidth};
use super::point_spread::{PointSpread, ReadySpread};
use super::{Effect, error::EffectsError, glare::Glare, sample_spread::SampleSpread};
use crate::ghosts::GhostSettings;

/// The widest margin that is chosen without being requested, as a fraction of the image's width and height.
pub const MARGIN_CAP: f64 = 0.25;

/// The effects of a camera.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects {
    psf: Option<PointSpread>,
    spread_by: Option<(SpreadBy, SpreadWidth)>,
    glare: Option<Glare>,
    ghosts: Option<GhostSettings>,
    margin_px: [usize; 2],
}

/// The members that a camera can have, and its margin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EffectsParameters {
    /// Diffraction and wavefront error, or an image.
    pub psf: Option<PointSpread>,
    /// By what the point-spread function spreads light where samples come through the lens; `None` for what keeps its modulation.
    pub spread_by: Option<SpreadBy>,
    /// Light scattered in the lens.
    pub glare: Option<Glare>,
    /// Light that two surfaces reflect.
    pub ghosts: Option<GhostSettings>,
    /// Width of the margin on every side as a fraction of the image's width and height, 0 to 1; `None` for as far as the
    /// effects reach, at most a quarter.
    pub margin: Option<f64>,
}

impl Effects {
    /// The effects behind an image.
    ///
    /// # Errors
    /// If the margin is out of range or serves nothing, or samples are requested and the function is wide.
    pub fn new(parameters: EffectsParameters, picture: &Raster) -> Result<Self, EffectsError> {
        let EffectsParameters { psf, spread_by: asked, glare, ghosts, margin } = parameters;
        let mut effects = Self { psf, spread_by: None, glare, ghosts, margin_px: [0, 0] };
        if let Some(psf) = &effects.psf {
            let width = psf.width(&Canvas::new(picture, [0, 0]));
            effects.spread_by = Some((SpreadBy::choose(asked, width)?, width));
        }
        effects.margin_px = match margin {
            Some(margin) if !(0.0..=1.0).contains(&margin) => return Err(EffectsError::Margin { margin }),
            Some(_) if effects.is_idle() => return Err(EffectsError::IdleMargin),
            Some(margin) => share(margin, picture),
            None => effects.reach_px(picture),
        };
        Ok(effects)
    }

    /// How far the effects reach, at most a quarter of the image.
    fn reach_px(&self, picture: &Raster) -> [usize; 2] {
        let cap = share(MARGIN_CAP, picture);
        let glare = self.needs_glare().map(|glare| glare.reach_px(picture.pitch_mm()).unwrap_or(cap));
        let psf = self.psf.as_ref().map(|psf| psf.reach_px(picture.pitch_mm()));
        // Ghosts of sources beside the image fall anywhere in it.
        let ghosts = self.ghosts.map(|_| cap);
        let reach = [psf, glare, ghosts].into_iter().flatten().fold([0, 0], |a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        [reach[0].min(cap[0]), reach[1].min(cap[1])]
    }

    /// Whether an effect is modelled, and why.
    #[must_use]
    pub fn status(&self, effect: Effect) -> EffectStatus {
        match effect {
            Effect::PointSpread => PointSpread::status(self.psf.as_ref()),
            Effect::Glare => Glare::status(self.glare.as_ref()),
            Effect::Ghosts => GhostSettings::status(self.ghosts.as_ref()),
        }
    }

    /// True if nothing is to be done.
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
    pub fn film(&self, picture: &Raster) -> Raster {
        picture.widened(self.margin_px)
    }

    /// The point-spread function, as described.
    #[must_use]
    pub fn psf(&self) -> Option<&PointSpread> {
        self.psf.as_ref()
    }

    /// By what the point-spread function spreads light where samples come through the lens, and how narrow it is; `None` if there is none.
    #[must_use]
    pub fn spread_by(&self) -> Option<(SpreadBy, SpreadWidth)> {
        self.spread_by
    }

    /// By what samples are displaced that come through the lens to the film of an image; `None` if the film spreads all light.
    #[must_use]
    pub fn sample_spread(&self, picture: &Raster, range: WavelengthRange) -> Option<SampleSpread> {
        self.displacing()?.sample_spread(&Canvas::new(picture, self.margin_px), range)
    }

    /// The function that samples through the lens are displaced by, where they are.
    #[must_use]
    pub fn displacing(&self) -> Option<&PointSpread> {
        self.psf.as_ref().filter(|_| self.spread_by.is_some_and(|(by, _)| by == SpreadBy::Samples))
    }

    /// What of the point-spread function is left to a film, whose samples came through the lens or did not.
    #[must_use]
    pub fn film_part(&self, through_lens: bool) -> FilmPart {
        match self.spread_by {
            Some((SpreadBy::Samples, _)) if through_lens => FilmPart::Tails,
            _ => FilmPart::Whole,
        }
    }

    /// Veiling glare, as described.
    #[must_use]
    pub fn glare(&self) -> Option<&Glare> {
        self.glare.as_ref()
    }

    /// Ghosts, where they are made.
    #[must_use]
    pub fn ghosts(&self) -> Option<GhostSettings> {
        self.ghosts
    }

    fn needs_glare(&self) -> Option<&Glare> {
        self.glare.as_ref().filter(|glare| Glare::status(Some(glare)).is_modelled())
    }

    /// What the point spread and the veiling glare of an image have to do, of its bands and, if requested, their variances.
    /// (Ghosts: [`crate::ghosts::operation_counts`].)
    #[must_use]
    pub fn operation_counts(
        &self,
        picture: &Raster,
        bands: Bands,
        with_variance: bool,
    ) -> [(Effect, OperationCounts); 2] {
        let canvas = Canvas::new(picture, self.margin_px);
        let pictures = if with_variance { 2.0 } else { 1.0 };
        let psf = self.psf.as_ref().map(|psf| psf.operation_counts(&canvas, bands, pictures));
        let glare = self.needs_glare().map(|glare| glare.operation_counts(&canvas, pictures * bands.count() as f64));
        [(Effect::PointSpread, psf.unwrap_or_default()), (Effect::Glare, glare.unwrap_or_default())]
    }

    /// The effects prepared for an image and a range of wavelengths (nm), with this part of the point-spread function: what does not depend
    /// on the band.
    #[must_use]
    pub fn prepared(&self, picture: &Raster, range: WavelengthRange, part: FilmPart) -> Prepared {
        let canvas = Canvas::new(picture, self.margin_px);
        let glare = self.needs_glare().map(|glare| Spread::new(&glare.kernel(&canvas), &canvas));
        let psf = self.psf.as_ref().map(|psf| psf.ready(&canvas, range, part));
        Prepared { canvas, psf, glare }
    }
}

pub(super) fn share(margin: f64, picture: &Raster) -> [usize; 2] {
    [(margin * picture.width() as f64).ceil() as usize, (margin * picture.height() as f64).ceil() as usize]
}

/// Effects that are ready to be applied.
#[derive(Debug)]
pub struct Prepared {
    canvas: Canvas,
    psf: Option<ReadySpread>,
    glare: Option<Spread>,
}

impl Prepared {
    /// The image's irradiance in the band from `band.low_nm` to `band.high_nm`, of the film's; and its variance, of the film's.
    ///
    /// A pixel of the film that is not finite makes others so: none that holds a number has met it.
    #[must_use]
    pub fn apply(
        &self,
        band: WavelengthRange,
        film: &Plane<Irradiance>,
        variance: Option<&Plane<Variance>>,
    ) -> (Plane<Irradiance>, Option<Plane<Variance>>) {
        // One replicate knows no variance.
        let known = variance.filter(|plane| plane.samples().iter().all(|v| !v.is_nan())).map(field);
        let (mean, spread) = self.spread(band, field(film), known);
        let variance = variance.map(|_| spread.map_or_else(|| self.unknown(), |v| self.cut(&v)));
        (self.cut(&mean), variance)
    }

    fn spread(&self, band: WavelengthRange, mut light: Field, mut variance: Option<Field>) -> (Field, Option<Field>) {
        if let Some(psf) = &self.psf {
            (light, variance) = psf.apply(band, &light, variance.as_ref());
        }
        if let Some(glare) = &self.glare {
            (light, variance) = glare.apply(&light, variance.as_ref());
        }
        (light, variance)
    }

    /// The image of a film. Rounding of the transforms below zero is no light.
    fn cut<Q: Quantity<Sample = f32>>(&self, film: &Field) -> Plane<Q> {
        let Region { x, y } = self.canvas.picture();
        let (width, height) = (x.len(), y.len());
        let positive = |v: &f64| if *v < 0.0 { 0.0 } else { *v as f32 };
        let samples = y.flat_map(|y| film.row(y)[x.clone()].iter().map(positive)).collect();
        Plane::from_samples(width, height, samples).expect("a sample a pixel")
    }

    fn unknown(&self) -> Plane<Variance> {
        let Region { x, y } = self.canvas.picture();
        Plane::filled(x.len(), y.len(), f32::NAN)
    }
}

fn field<Q: Quantity<Sample = f32>>(plane: &Plane<Q>) -> Field {
    Field { width: plane.width(), values: plane.samples().iter().map(|v| f64::from(*v)).collect() }
}
