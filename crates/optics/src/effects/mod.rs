//! Irradiance effects: from the spectral irradiance on the sensor plane to the same.
//!
//! # Contract
//!
//! - Effects act on band means of the irradiance (W·m⁻²·nm⁻¹), one band after the other, in the order of the table. Each
//!   says whether a camera needs it and why (`status`), beside what it does.
//! - They need light from outside the picture: the film is wider by a margin on every side ([`Effects::margin_px`]), which
//!   is cut off at the end. Nothing comes from beyond the margin, and what leaves it is lost.
//! - All are linear with weights that are not negative. Variances go through the squared weights: errors of different pixels
//!   are taken as independent, before every effect.
//! - What is absent costs nothing: no margin, no spectrum.
//!
//! | order | effect | on |
//! | --- | --- | --- |
//! | 1 | [point spread](psf) | diffraction of the aperture, wavefront error; or [a picture](spread_image) |
//! | 2 | [veiling glare](glare) | scatters a share of the light over the plane |
//! | 3 | [ghosts](crate::ghosts) | adds light that two surfaces of the lens reflect |
//!
//! Ghosts are made of the film's own light, before the other effects, of all bands at once ([`crate::ghosts::layer`]), and are
//! added behind them: they are out of focus, and what scatters of them is of second order.

mod band;
mod convolve;
mod error;
mod fourier;
pub mod glare;
mod kernel;
mod point_spread;
pub mod psf;
pub mod spread_image;
mod work;

pub use error::EffectsError;
pub use glare::{Glare, GlareParameters};
pub use point_spread::PointSpread;
pub use psf::{Psf, PsfParameters, WavefrontTerm, Zernike};
pub use spread_image::{SpreadImage, SpreadImageParameters};
pub use work::Work;

use crate::ghosts::GhostSettings;
use convolve::{Convolver, Field, Region};
use etendue_core::quantity::{Irradiance, Quantity, Variance};
use etendue_core::{Bands, EffectStatus, Plane};
use etendue_projection::Raster;
use glam::DVec2;
use kernel::Kernel;
use point_spread::ReadySpread;

/// The widest margin that is chosen without being asked for, as a share of the picture's width and height.
pub const MARGIN_CAP: f64 = 0.25;

/// The effects that there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Diffraction and wavefront error.
    PointSpread,
    /// Light scattered in the lens.
    Glare,
    /// Light that two surfaces reflect.
    Ghosts,
}

impl Effect {
    /// All effects, in their order.
    pub const ALL: [Self; 3] = [Self::PointSpread, Self::Glare, Self::Ghosts];

    /// The effect's name in a plan.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::PointSpread => "point spread",
            Self::Glare => "veiling glare",
            Self::Ghosts => "ghosts",
        }
    }
}

/// The effects of a camera.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects {
    psf: Option<PointSpread>,
    glare: Option<Glare>,
    ghosts: Option<GhostSettings>,
    margin_px: [usize; 2],
}

/// The members that a camera can have, and its margin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EffectsParameters {
    /// Diffraction and wavefront error, or a picture.
    pub psf: Option<PointSpread>,
    /// Light scattered in the lens.
    pub glare: Option<Glare>,
    /// Light that two surfaces reflect.
    pub ghosts: Option<GhostSettings>,
    /// Width of the margin on every side as a share of the picture's width and height, 0 to 1; `None` for as far as the
    /// effects reach, at most a quarter.
    pub margin: Option<f64>,
}

impl Effects {
    /// The effects behind a picture.
    ///
    /// # Errors
    /// Where the margin is out of range or serves nothing.
    pub fn new(parameters: EffectsParameters, picture: &Raster) -> Result<Self, EffectsError> {
        let EffectsParameters { psf, glare, ghosts, margin } = parameters;
        let mut effects = Self { psf, glare, ghosts, margin_px: [0, 0] };
        effects.margin_px = match margin {
            Some(margin) if !(0.0..=1.0).contains(&margin) => return Err(EffectsError::Margin { margin }),
            Some(_) if effects.is_idle() => return Err(EffectsError::IdleMargin),
            Some(margin) => share(margin, picture),
            None => effects.reach_px(picture),
        };
        Ok(effects)
    }

    /// How far the effects reach, at most a quarter of the picture.
    fn reach_px(&self, picture: &Raster) -> [usize; 2] {
        let cap = share(MARGIN_CAP, picture);
        let glare = self.needs_glare().map(|glare| glare.reach_px(picture.pitch_mm()).unwrap_or(cap));
        let psf = self.psf.as_ref().map(|psf| psf.reach_px(picture.pitch_mm()));
        // Ghosts of sources beside the picture fall anywhere in it.
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

    /// Whether nothing is to be done.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        !Effect::ALL.into_iter().any(|effect| self.status(effect).is_modelled())
    }

    /// Columns and rows that the film needs beyond the picture, on every side.
    #[must_use]
    pub fn margin_px(&self) -> [usize; 2] {
        self.margin_px
    }

    /// The pixels of the film: the picture's with the margin.
    #[must_use]
    pub fn film(&self, picture: &Raster) -> Raster {
        picture.widened(self.margin_px)
    }

    /// The point-spread function, as described.
    #[must_use]
    pub fn psf(&self) -> Option<&PointSpread> {
        self.psf.as_ref()
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

    /// What the point spread and the veiling glare of a picture have to do, of its bands and, if asked for, their variances.
    /// (Ghosts: [`crate::ghosts::work`].)
    #[must_use]
    pub fn work(&self, picture: &Raster, bands: Bands, with_variance: bool) -> [(Effect, Work); 2] {
        let canvas = Canvas::new(picture, self.margin_px);
        let pictures = if with_variance { 2.0 } else { 1.0 };
        let psf = self.psf.as_ref().map(|psf| psf.work(&canvas, bands, pictures));
        let glare = self.needs_glare().map(|glare| glare.work(&canvas, pictures * bands.count() as f64));
        [(Effect::PointSpread, psf.unwrap_or_default()), (Effect::Glare, glare.unwrap_or_default())]
    }

    /// The effects made ready for a picture and a range of wavelengths (nm): what does not depend on the band.
    #[must_use]
    pub fn prepared(&self, picture: &Raster, range_nm: (f64, f64)) -> Prepared {
        let canvas = Canvas::new(picture, self.margin_px);
        let glare = self.needs_glare().map(|glare| Spread::new(&glare.kernel(&canvas), &canvas));
        let psf = self.psf.as_ref().map(|psf| psf.ready(&canvas, range_nm));
        Prepared { canvas, psf, glare }
    }
}

fn share(margin: f64, picture: &Raster) -> [usize; 2] {
    [(margin * picture.width() as f64).ceil() as usize, (margin * picture.height() as f64).ceil() as usize]
}

/// The film and the picture in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Canvas {
    film: Raster,
    margin_px: [usize; 2],
}

impl Canvas {
    pub(crate) fn new(picture: &Raster, margin_px: [usize; 2]) -> Self {
        Self { film: picture.widened(margin_px), margin_px }
    }

    /// Columns and rows of the film.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.film.width(), self.film.height()]
    }

    /// The point of the sensor at a point of the film.
    fn sensor_mm(&self, film_px: DVec2) -> DVec2 {
        self.film.sensor_mm(film_px)
    }

    pub(crate) fn pitch_mm(&self) -> DVec2 {
        self.film.pitch_mm()
    }

    /// All of the film.
    fn whole(&self) -> Region {
        Region { x: 0..self.film.width(), y: 0..self.film.height() }
    }

    /// The picture in the film.
    fn picture(&self) -> Region {
        let [x, y] = self.margin_px;
        Region { x: x..self.film.width() - x, y: y..self.film.height() - y }
    }
}

/// A kernel for means and, squared, for variances.
#[derive(Debug)]
struct Spread {
    mean: Convolver,
    variance: Convolver,
}

impl Spread {
    fn new(kernel: &Kernel, canvas: &Canvas) -> Self {
        let of = |kernel: &Kernel| Convolver::new(kernel, canvas.size(), canvas.whole());
        Self { mean: of(kernel), variance: of(&kernel.squared()) }
    }

    fn apply(&self, light: &Field, variance: Option<&Field>) -> (Field, Option<Field>) {
        (self.mean.apply(light), variance.map(|variance| self.variance.apply(variance)))
    }
}

/// Effects that are ready to be applied.
#[derive(Debug)]
pub struct Prepared {
    canvas: Canvas,
    psf: Option<ReadySpread>,
    glare: Option<Spread>,
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

    fn spread(&self, band_nm: (f64, f64), mut light: Field, mut variance: Option<Field>) -> (Field, Option<Field>) {
        if let Some(psf) = &self.psf {
            (light, variance) = psf.apply(band_nm, &light, variance.as_ref());
        }
        if let Some(glare) = &self.glare {
            (light, variance) = glare.apply(&light, variance.as_ref());
        }
        (light, variance)
    }

    /// The picture of a film. Rounding of the transforms below zero is no light.
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
