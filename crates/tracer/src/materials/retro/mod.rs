//! Retro-reflective sheeting: signs and number plates.
//!
//! f_r = k_d(λ)/π + c(λ) [R_A(α, β)/(cos β cos ν) − k̄_d/π]₊, 1/sr. α is the observation angle, between the directions to the lamp and to the viewer;
//! β the entrance angle, of the lamp to the normal; ν that of the viewer. R_A is the coefficient of retro-reflection, cd·lx⁻¹·m⁻² (CIE e-ILV
//! 17-24-103; measured by ASTM E810), so that a sheeting under E_⊥ lux has the luminance R_A E_⊥/cos ν. Measured R_A includes the diffuse base's
//! light, whose luminous reflectance under illuminant A is k̄_d. The lobe therefore adds the difference, and nothing if the base alone gives more. c
//! is the colour, of luminous mean 1 under CIE illuminant A, the illuminant of R_A measurements. The angle is computed from |ωᵢ − ωₒ|, exact for
//! close directions in f32. Light is sampled from about the viewer's direction by a table of R_A × solid angle, mixed with the cosine for the base.
//!
//! Outside the table R_A has the value of its nearest entry: below the first observation angle; beyond the last up to a cut-off, where it ends;
//! beyond the last entrance angle. The cut-off is 10°, or less if energy conservation requires it: at no incidence and wavelength is more reflected
//! than arrives. Beyond 60° from the normal, the largest entrance angle that ASTM E810 measures (or beyond the last entrance angle, if that is
//! larger), the BSDF is constant instead: R_A must vanish where no area is visible. [`Sheeting::limits`] describes this in words. A table that gains
//! energy even if cut off at its last observation angle is refused.
//!
//! Not reciprocal to the last digit: measured tables depend on β alone, not on ν. The two differ by at most α, by which R_A hardly changes.
//!
//! Left out: the rotation of sheets about their normal and of the observation plane (rotation and presentation angles); gloss of the front (mix with,
//! or coat, another material); dew.

mod lobe;
mod marking;
mod preset;
mod table;

use core::f32::consts::FRAC_1_PI;

use etendue_core::Spectral;
use etendue_core::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use etendue_spectra::{Spectrum, illuminant, observer};
use glam::{Vec2, Vec3};

use super::energy::{self, WeightedLobe};
use super::error::{EnergyGain, MaterialError};
use super::gloss::{Gloss, GlossLobe};
use super::model::{BsdfFlags, BsdfModel, BsdfSample, BsdfValue, DiscreteSampler, Event, Passage, SurfaceModel};
use super::parameter::{Parameter, Reflectance, ShadingPoint, TextureCheck};
use lobe::{GRAZING_DEG, MAX_CUT_OFF_DEG, RetroLobe};

pub use marking::{DaytimeBrightness, MarkingBsdf, MarkingError, RoadMarking, marking_class};
pub use preset::{SHEETING_CLASSES, SHEETING_COLOURS, SheetingPreset};
pub use table::{RetroTable, RetroTableError};

/// A retro-reflective sheeting over a diffuse base.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheeting {
    face: SheetingFace,
    table: RetroTable,
    lobe: RetroLobe,
}

/// Colour of a sheeting.
#[derive(Clone, Debug, PartialEq)]
enum SheetingFace {
    /// A reflectance by day, and the colour c.
    Plain(Spectrum, Spectrum),
    /// Reflectance of a white sheeting by day, and the print over it, which colours both that and the retro-reflected light.
    Printed(f32, Reflectance),
}

impl Sheeting {
    /// A sheeting of colour `colour` (a spectrum of any scale) whose own coefficients, measured in illuminant A, are `table`, with the
    /// diffuse reflectance `base` by day.
    ///
    /// # Errors
    /// If base or colour is invalid, or more is reflected than arrives.
    pub fn new(base: Spectrum, colour: &Spectrum, table: RetroTable) -> Result<Self, SheetingError> {
        if !energy::is_weight(&base) {
            return Err(SheetingError::Base);
        }
        let colour = photometric(colour).ok_or(SheetingError::Colour)?;
        let lobe = widest(&table, &base, &colour)?;
        Ok(Self { face: SheetingFace::Plain(base, colour), table, lobe })
    }

    /// A white sheeting of coefficients `table` and a reflectance `white` (0 to 1) by day, printed with transparent ink: `print` is the
    /// fraction of its light that is left at each wavelength. A texture turns it into a sign.
    ///
    /// # Errors
    /// If the reflectance is out of range, or more would be reflected than arrives.
    pub fn printed(white: f64, print: Reflectance, table: RetroTable) -> Result<Self, SheetingError> {
        if !(0.0..=1.0).contains(&white) {
            return Err(SheetingError::Base);
        }
        let lobe = widest(&table, &Spectrum::constant(white), &Spectrum::constant(1.0))?;
        Ok(Self { face: SheetingFace::Printed(white as f32, print), table, lobe })
    }

    /// The observation angle beyond which nothing is retro-reflected, degrees.
    #[must_use]
    pub fn cut_off_deg(&self) -> f64 {
        self.lobe.cut_off_deg()
    }

    /// Description of the extrapolation of the table.
    #[must_use]
    pub fn limits(&self) -> String {
        let (alpha, beta) = (self.table.observation_deg(), self.table.entrance_deg());
        let (first, last, deepest) = (alpha[0], alpha[alpha.len() - 1], beta[beta.len() - 1]);
        let cut = self.cut_off_deg();
        let why = if cut < MAX_CUT_OFF_DEG - 0.01 { " (limited by energy conservation)" } else { "" };
        format!(
            "the coefficient of retro-reflection R_A is constant below an observation angle of {first}° and from \
             {last}° to {cut:.2}°{why}, and 0 beyond; it is constant for entrance angles from {deepest}° to {}°, and \
             decreases beyond",
            deepest.max(GRAZING_DEG)
        )
    }
}

impl SurfaceModel for Sheeting {
    type Bsdf<'a, const N: usize> = SheetingBsdf<'a, N>;

    fn parameters(&self) -> Vec<Parameter<'_>> {
        match &self.face {
            SheetingFace::Plain(..) => Vec::new(),
            SheetingFace::Printed(_, print) => vec![Parameter::Reflectance(print)],
        }
    }

    fn passage(&self) -> Passage<'_> {
        Passage::None
    }

    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> SheetingBsdf<'_, N> {
        let (base, colour) = match &self.face {
            SheetingFace::Plain(base, colour) => (base.sample(point.wavelengths), colour.sample(point.wavelengths)),
            SheetingFace::Printed(white, print) => {
                let print = point.reflectance(print);
                (print * *white, print)
            }
        };
        SheetingBsdf { lobe: &self.lobe, base, colour }
    }

    fn check_energy(&self, _: &TextureCheck<'_>) -> Result<(), MaterialError> {
        Ok(())
    }

    fn straight_transmittance<const N: usize>(&self, _: &ShadingPoint<'_, N>, _: f32) -> Spectral<N> {
        Spectral::ZERO
    }
}

/// The widest lobe of a table that does not gain energy.
fn widest(table: &RetroTable, base: &Spectrum, colour: &Spectrum) -> Result<RetroLobe, EnergyGain> {
    let mut gain = Ok(());
    let beneath = luminous_mean(base) as f32 * FRAC_1_PI;
    for lobe in RetroLobe::widest_first(table, beneath) {
        gain = energy::check(base, &[WeightedLobe { weight: colour, albedo: &lobe.albedo }]);
        if gain.is_ok() {
            return Ok(lobe);
        }
    }
    Err(gain.expect_err("a table has a lobe"))
}

/// A spectrum scaled to a luminous mean of 1 under illuminant A; `None` for one that is negative or dark.
pub(super) fn photometric(colour: &Spectrum) -> Option<Spectrum> {
    let luminous = luminous_mean(colour);
    (energy::is_weight(colour) && luminous > 0.0).then(|| colour.scaled(1.0 / luminous))
}

/// Luminous mean of a spectrum under illuminant A.
fn luminous_mean(of: &Spectrum) -> f64 {
    observer::xyz_of_reflectance(of, illuminant::by_name("A").expect("A is in the list"))[1]
}

/// Error of a sheeting.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SheetingError {
    /// The base is invalid.
    #[error(
        "the sheeting's diffuse reflectance is negative or not finite at some wavelength; it must be between 0 and 1"
    )]
    Base,
    /// The colour is negative or dark.
    #[error(
        "the colour of the retro-reflected light is negative or 0 everywhere; give a spectrum of 0 or more, above 0 at some \
         visible wavelength"
    )]
    Colour,
    /// The table is invalid.
    #[error(transparent)]
    Table(#[from] RetroTableError),
    /// More is reflected than arrives, even if the table is cut off at its last observation angle.
    #[error(transparent)]
    Energy(#[from] EnergyGain),
}

/// A sheeting at one point and a path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct SheetingBsdf<'a, const N: usize> {
    lobe: &'a RetroLobe,
    base: Spectral<N>,
    colour: Spectral<N>,
}

impl<const N: usize> SheetingBsdf<'_, N> {
    fn discrete_sampler(&self, wo: Vec3) -> Option<DiscreteSampler<2>> {
        DiscreteSampler::new([self.base.mean(), self.colour.mean() * self.lobe.albedo.at(wo.z)])
    }

    fn value(&self, discrete_sampler: DiscreteSampler<2>, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        BsdfValue {
            value_cos: self.base * (wi.z * FRAC_1_PI) + self.colour * self.lobe.value_cos(wo, wi),
            pdf: discrete_sampler.probability(0) * cosine_hemisphere_pdf(wi.z)
                + discrete_sampler.probability(1) * self.lobe.pdf(wo, wi),
        }
    }
}

impl<const N: usize> BsdfModel<N> for SheetingBsdf<'_, N> {
    #[inline]
    fn flags(&self) -> BsdfFlags {
        BsdfFlags::LOBES
    }

    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        self.discrete_sampler(wo).map_or(BsdfValue::ZERO, |discrete_sampler| self.value(discrete_sampler, wo, wi))
    }

    fn gloss(&self, wo: Vec3) -> Gloss {
        let colour = self.colour.mean();
        let (peak, albedo) = (self.lobe.value_cos(wo, wo), self.lobe.albedo.at(wo.z));
        Gloss::from_diffuse(self.base.mean() * FRAC_1_PI).with(GlossLobe::from_albedo(
            wo,
            colour * peak,
            colour * albedo,
        ))
    }

    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        let discrete_sampler = self.discrete_sampler(wo)?;
        let wi = if discrete_sampler.sample(choice) == 0 { cosine_hemisphere(u) } else { self.lobe.sample(wo, u) };
        if wi.z <= 0.0 {
            return None;
        }
        let BsdfValue { value_cos, pdf } = self.value(discrete_sampler, wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value_cos / pdf, pdf, event: Event::Scatter })
    }
}
