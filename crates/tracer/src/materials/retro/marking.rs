//! Road markings with glass beads.
//!
//! f = k_d/π + κ c(λ) r(α)/max(cos β, cos ν), r = 1/(1 + d²/h²)², 1/sr. The first term is the marking by day. In the second, each bead reflects light
//! into a lobe about the direction of incidence. α is the angle between the directions to lamp and viewer, d = 2 sin(α/2) their distance on the unit
//! sphere, h the distance at which r has fallen to a quarter. The lower both directions are, the more beads hide one another. The beads that the
//! lower direction reaches are the same that the higher one sees: the fraction of active beads falls as the lesser cosine, which leaves the greater
//! one in the BSDF (cos β cos ν in the denominator, min of both in the numerator). Reciprocal; at no incidence is the lobe's albedo more than κ ∫ r
//! dω = κ π h²/(1 + h²/4). c has the luminous mean 1 under illuminant A.
//!
//! κ is set so that at the 30 m geometry of EN 1436 (entrance angle 88.76°, observation angle 1.05°, the lamp and viewer above one another) L = R_L
//! E_⊥ holds exactly, E_⊥ on a plane across the beam, base included. For a lamp and a viewer of fixed heights R_L thus depends on distance by r(α)
//! alone, as manufacturers' curves nearly do.
//!
//! The default h of 3° is an assumption: beads of index 1.5 in diffuse paint spread light over a few degrees, and no standard states it. Lobes are
//! sampled exactly: d² = h² u/(1 − u), cut at the opposite direction.
//!
//! Left out: the wet film itself (a wet marking is one of its wet R_L), structure of the marking, wear of beads.

use core::f32::consts::{FRAC_1_PI, PI, TAU};

use etendue_core::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use etendue_core::{Basis, Spectral, maths, maths::f32::sin_cos};
use etendue_spectra::{Spectrum, illuminant, observer};
use glam::{Vec2, Vec3};

use super::photometric;
use crate::materials::energy::{self, AlbedoTable, WeightedLobe};
use crate::materials::error::{EnergyGain, MaterialError};
use crate::materials::gloss::{Gloss, GlossLobe, LobeCentre};
use crate::materials::model::{
    BsdfFlags, BsdfModel, BsdfSample, BsdfValue, DiscreteSampler, Event, Passage, SurfaceModel,
};
use crate::materials::parameter::{Parameter, ShadingPoint, TextureCheck};

/// The 30 m geometry of EN 1436: the lamp's elevation, degrees.
const LAMP_DEG: f64 = 1.24;
/// The viewer's elevation, degrees.
const VIEWER_DEG: f64 = 2.29;

/// Default angle at which the lobe has fallen to a quarter, degrees.
const LOBE_DEG: f64 = 3.0;

/// Brightness of a marking by day.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DaytimeBrightness {
    /// Luminance coefficient under diffuse light Q_d, mcd·m⁻²·lx⁻¹: for a diffuse surface 1000/π times its reflectance.
    Qd(f64),
    /// Luminance factor β, 0 to 1.
    LuminanceFactor(f64),
}

impl DaytimeBrightness {
    fn reflectance(self) -> f64 {
        match self {
            Self::Qd(mcd) => mcd * 1e-3 * core::f64::consts::PI,
            Self::LuminanceFactor(factor) => factor,
        }
    }
}

/// A class of EN 1436 as its minimum R_L, mcd·m⁻²·lx⁻¹: dry white R2 to R5 and yellow R1, R3 and R5 (as `yellow-r3`),
/// wet (RW1 to RW6). `None` for other names.
#[must_use]
pub fn marking_class(name: &str) -> Option<f64> {
    Some(match name {
        "r2" => 100.0,
        "r3" | "yellow-r3" => 150.0,
        "r4" | "yellow-r5" => 200.0,
        "r5" => 300.0,
        "yellow-r1" => 80.0,
        "rw1" => 25.0,
        "rw2" => 35.0,
        "rw3" => 50.0,
        "rw4" => 75.0,
        "rw5" => 100.0,
        "rw6" => 150.0,
        _ => return None,
    })
}

#[derive(Clone, Debug, PartialEq)]
pub struct RoadMarking {
    base: Spectrum,
    colour: Spectrum,
    lobe: MarkingLobe,
    albedo: AlbedoTable,
}

impl RoadMarking {
    /// A marking of coefficient `r_l` (mcd·m⁻²·lx⁻¹), brightness `day` and colour `colour` (a spectrum of any scale), with beads of the
    /// default spread.
    ///
    /// # Errors
    /// If a number is out of range, the colour is invalid, or more is reflected than arrives.
    pub fn new(r_l: f64, day: DaytimeBrightness, colour: &Spectrum) -> Result<Self, MarkingError> {
        Self::with_spread(r_l, day, colour, LOBE_DEG)
    }

    /// The same with beads whose lobe has fallen to a quarter at `spread_deg` (0.5 to 30).
    ///
    /// # Errors
    /// As [`RoadMarking::new`].
    pub fn with_spread(
        r_l: f64,
        day: DaytimeBrightness,
        colour: &Spectrum,
        spread_deg: f64,
    ) -> Result<Self, MarkingError> {
        let reflectance = day.reflectance();
        if !(0.0..=1.0).contains(&reflectance) {
            return Err(MarkingError::Day { reflectance });
        }
        if !(0.5..=30.0).contains(&spread_deg) {
            return Err(MarkingError::Spread { spread_deg });
        }
        let colour = photometric(colour).ok_or(MarkingError::Colour)?;
        let by_day = observer::xyz_of_reflectance(&colour, illuminant::d65())[1];
        let base = colour.scaled(reflectance / by_day);
        let lobe = MarkingLobe::new(r_l * 1e-3, &base, spread_deg)?;
        let albedo = AlbedoTable::new(|cos| lobe.albedo(cos));
        energy::check(&base, &[WeightedLobe { weight: &colour, albedo: &albedo }])?;
        Ok(Self { base, colour, lobe, albedo })
    }
}

impl SurfaceModel for RoadMarking {
    type Bsdf<'a, const N: usize> = MarkingBsdf<'a, N>;

    fn parameters(&self) -> Vec<Parameter<'_>> {
        Vec::new()
    }

    fn passage(&self) -> Passage<'_> {
        Passage::None
    }

    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> MarkingBsdf<'_, N> {
        MarkingBsdf {
            marking: self,
            base: self.base.sample(point.wavelengths),
            colour: self.colour.sample(point.wavelengths),
        }
    }

    fn check_energy(&self, _: &TextureCheck<'_>) -> Result<(), MaterialError> {
        Ok(())
    }

    fn straight_transmittance<const N: usize>(&self, _: &ShadingPoint<'_, N>, _: f32) -> Spectral<N> {
        Spectral::ZERO
    }
}

/// Error of a road marking.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MarkingError {
    /// The coefficient is below that of the marking's own colour.
    #[error("R_L is {r_l} mcd/m²/lx, but the marking's diffuse reflectance alone gives {least:.2}; give at least that")]
    Coefficient {
        /// Value given, mcd·m⁻²·lx⁻¹.
        r_l: f64,
        /// Minimum possible value, mcd·m⁻²·lx⁻¹.
        least: f64,
    },
    /// The reflectance by day is out of range.
    #[error(
        "the marking's diffuse reflectance would be {reflectance:.3}; it must be between 0 and 1; Q_d is at most 318 mcd/m²/lx"
    )]
    Day { reflectance: f64 },
    /// The spread is out of range.
    #[error("the spread is {spread_deg}°; it must be between 0.5° and 30°")]
    Spread {
        /// Value given, degrees.
        spread_deg: f64,
    },
    /// The colour is negative or dark.
    #[error(
        "the marking's colour is negative or 0 everywhere; give a spectrum of 0 or more, above 0 at some visible wavelength"
    )]
    Colour,
    /// The marking reflects more than arrives.
    #[error(transparent)]
    Energy(#[from] EnergyGain),
}

/// κ r(α)/max(cos β, cos ν).
#[derive(Clone, Copy, Debug, PartialEq)]
struct MarkingLobe {
    strength: f32,
    /// h².
    width2: f32,
}

impl MarkingLobe {
    /// The lobe that, added to `base`, gives R_L (cd·m⁻²·lx⁻¹) at the 30 m geometry.
    fn new(r_l: f64, base: &Spectrum, spread_deg: f64) -> Result<Self, MarkingError> {
        let a = illuminant::by_name("A").expect("A is in the list");
        let (lamp, viewer) = (LAMP_DEG.to_radians(), VIEWER_DEG.to_radians());
        let (cos_lamp, cos_viewer) = (maths::f64::sin(lamp), maths::f64::sin(viewer));
        let of_base = observer::xyz_of_reflectance(base, a)[1] / core::f64::consts::PI * cos_lamp;
        // A marking without beads: the rounding of its own R_L is no error.
        if !(r_l.is_finite() && r_l > of_base * 0.999) {
            return Err(MarkingError::Coefficient { r_l: r_l * 1e3, least: of_base * 1e3 });
        }
        let (h, d) = (spread_deg.to_radians(), 2.0 * maths::f64::sin(0.5 * (viewer - lamp)));
        let fallen = 1.0 + d * d / (h * h);
        let strength = (r_l - of_base).max(0.0) * fallen * fallen * cos_viewer / cos_lamp;
        Ok(Self { strength: strength as f32, width2: (h * h) as f32 })
    }

    fn fallen(self, wo: Vec3, wi: Vec3) -> f32 {
        let t = 1.0 + (wi - wo).length_squared() / self.width2;
        1.0 / (t * t)
    }

    /// f cos θᵢ at colour 1.
    fn value_cos(self, wo: Vec3, wi: Vec3) -> f32 {
        self.strength * self.fallen(wo, wi) * wi.z / wi.z.max(wo.z)
    }

    /// Fraction of samples 1 − 1/(1 + d²/h²) at the opposite direction, d = 2.
    fn last(self) -> f32 {
        1.0 - 1.0 / (1.0 + 4.0 / self.width2)
    }

    /// Samples a direction by r(α), over the whole sphere.
    fn sample(self, wo: Vec3, u: Vec2) -> Vec3 {
        let fraction = u.x * self.last();
        let k = (0.5 * self.width2 * fraction / (1.0 - fraction)).min(2.0);
        let (s, c) = sin_cos(TAU * u.y);
        let sin = (k * (2.0 - k)).max(0.0).sqrt();
        Basis::about(wo).outward(Vec3::new(sin * c, sin * s, 1.0 - k))
    }

    /// Density of [`Self::sample`], 1/sr.
    fn pdf(self, wo: Vec3, wi: Vec3) -> f32 {
        self.fallen(wo, wi) / (PI * self.width2 * self.last())
    }

    /// By the midpoint rule over the sample square of directions (half a turn).
    fn albedo(self, cos: f32) -> f64 {
        const CELLS: usize = 48;
        let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
        let cell = |i: usize| {
            let u = Vec2::new((i / CELLS) as f32 + 0.5, 0.5 * ((i % CELLS) as f32 + 0.5)) / CELLS as f32;
            let wi = self.sample(wo, u);
            if wi.z > 0.0 { f64::from(self.value_cos(wo, wi) / self.pdf(wo, wi)) } else { 0.0 }
        };
        (0..CELLS * CELLS).map(cell).sum::<f64>() / (CELLS * CELLS) as f64
    }
}

/// A road marking at one point and a path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct MarkingBsdf<'a, const N: usize> {
    marking: &'a RoadMarking,
    base: Spectral<N>,
    colour: Spectral<N>,
}

impl<const N: usize> MarkingBsdf<'_, N> {
    fn discrete_sampler(&self, wo: Vec3) -> Option<DiscreteSampler<2>> {
        DiscreteSampler::new([self.base.mean(), self.colour.mean() * self.marking.albedo.at(wo.z)])
    }

    fn value(&self, discrete_sampler: DiscreteSampler<2>, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        let lobe = self.marking.lobe;
        BsdfValue {
            value_cos: self.base * (wi.z * FRAC_1_PI) + self.colour * lobe.value_cos(wo, wi),
            pdf: discrete_sampler.probability(0) * cosine_hemisphere_pdf(wi.z)
                + discrete_sampler.probability(1) * lobe.pdf(wo, wi),
        }
    }
}

impl<const N: usize> BsdfModel<N> for MarkingBsdf<'_, N> {
    #[inline]
    fn flags(&self) -> BsdfFlags {
        BsdfFlags::LOBES
    }

    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        self.discrete_sampler(wo).map_or(BsdfValue::ZERO, |discrete_sampler| self.value(discrete_sampler, wo, wi))
    }

    fn gloss(&self, wo: Vec3) -> Gloss {
        let lobe = self.marking.lobe;
        let (width, peak) = (lobe.width2.sqrt(), self.colour.mean() * lobe.strength);
        let beads = GlossLobe { about: LobeCentre::Direction(wo), width, peak, f0: 1.0 };
        Gloss::from_diffuse(self.base.mean() * FRAC_1_PI).with(beads)
    }

    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        let discrete_sampler = self.discrete_sampler(wo)?;
        let wi =
            if discrete_sampler.sample(choice) == 0 { cosine_hemisphere(u) } else { self.marking.lobe.sample(wo, u) };
        if wi.z <= 0.0 {
            return None;
        }
        let BsdfValue { value_cos, pdf } = self.value(discrete_sampler, wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value_cos / pdf, pdf, event: Event::Scatter })
    }
}
